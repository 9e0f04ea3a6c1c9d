//! Packing of the cloud from the columns, in every step.

use std::ops::Range;

use glam::DVec3;

use super::flow_cloud::FlowCloud;
use super::group::Group;
use crate::formulations::fluid::lanes::FlowParticle;
use crate::formulations::fluid::lists::blocks::{Packed, Units, pack_states};
use crate::formulations::fluid::lists::{BoundsBuilder, DisplacementBounds};
use crate::parallel::{
    FourLanes, HotLoop, Lanes4, others_rows, run_hot, sum_over_blocks, sum_over_own_blocks,
};
use crate::ranks::has_several;
use crate::world::{
    Density, Mass, MissingColumn, PhaseView, Position, Pressure, ReferenceVolume, Removed, Velocity, World,
};

impl FlowCloud {
    /// Packs positions, volumes and velocities; fluids with their pressure, boundaries without. Says how far
    /// the particles have moved since they were packed before. Of fluids, every rank packs its own.
    pub(in crate::formulations::fluid) fn pack(
        &mut self,
        world: &World,
    ) -> Result<DisplacementBounds, MissingColumn> {
        let is_local = self.is_local();
        let Self { groups, records, is_still, blocks, .. } = self;
        let mut moved = DisplacementBounds::NONE;
        is_still.clear();
        for group in groups.iter() {
            let (units, packed) = match blocks {
                Some(blocks) => (Some(&blocks.units), Some(&mut blocks.packed[group.cloud.clone()])),
                None => (None, None),
            };
            let of_group = GroupRows { group, records: &mut records[group.cloud.clone()], packed, units };
            let of_group = match group.fluid() {
                Some(_) => of_group.pack_fluid(&world.phase(group.phase))?,
                None => of_group.pack_boundary(&world.phase(group.phase), is_local)?,
            };
            is_still.push(of_group.is_zero());
            moved = moved.with(of_group);
        }
        Ok(moved)
    }

    /// Packs volumes, velocities and pressures of these rows for sums in single precision, once they are
    /// those of the end of the step.
    pub(in crate::formulations::fluid) fn pack_states(&mut self, rows: Range<usize>) {
        if let Some(blocks) = &mut self.blocks {
            pack_states(&mut blocks.packed[rows.clone()], &self.records[rows]);
        }
    }

    /// Writes down where the particles are, m.
    pub(in crate::formulations::fluid) fn read_positions(
        &self,
        world: &World,
        positions: &mut Vec<DVec3>,
    ) -> Result<(), MissingColumn> {
        positions.resize(self.records.len(), DVec3::ZERO);
        for group in &self.groups {
            let column = world.phase(group.phase).read::<Position>()?;
            let rows = (&mut positions[group.cloud.clone()], &column[group.rows.clone()]);
            sum_over_blocks(rows, &|_, (to, from): (&mut [DVec3], &[Position])| {
                to.iter_mut().zip(from).for_each(|(to, from)| *to = from.0);
            });
        }
        Ok(())
    }
}

/// The records of a group, and their sources.
struct GroupRows<'a> {
    group: &'a Group,
    records: &'a mut [FlowParticle],
    packed: Option<&'a mut [Packed]>,
    units: Option<&'a Units>,
}

impl GroupRows<'_> {
    /// Packs the rows of this rank.
    fn pack_fluid(self, view: &PhaseView<'_>) -> Result<DisplacementBounds, MissingColumn> {
        let Self { group, records, packed, units } = self;
        let rows = group.rows.clone();
        let (x, v) = (view.read_own::<Position>()?, view.read_own::<Velocity>()?);
        let (density, mass) = (view.read_own::<Density>()?, view.read_own::<Mass>()?);
        let (pressure, removed) = (view.read_own::<Pressure>()?, view.read_own::<Removed>()?);
        let common = (records, &x[rows.clone()], &v[rows.clone()], &removed[rows.clone()]);
        let fluid = (&mass[rows.clone()], &density[rows.clone()], &pressure[rows]);
        let slices: WithPacked<'_, Fluids<'_>> = (common, fluid, packed);
        Ok(sum_over_own_blocks(slices, &|_, (common, fluid, packed): WithPacked<'_, Fluids<'_>>| {
            run_hot(PackFluid(common, fluid, packed, units))
        }))
    }

    /// Packs the rows of this rank; those of the others too where the boundary has moved, or where all ranks
    /// need all of them.
    fn pack_boundary(
        mut self,
        view: &PhaseView<'_>,
        is_local: bool,
    ) -> Result<DisplacementBounds, MissingColumn> {
        let moved = {
            let (x, v) = (view.read_own::<Position>()?, view.read_own::<Velocity>()?);
            let (volume, removed) = (view.read_own::<ReferenceVolume>()?, view.read_own::<Removed>()?);
            let own = self.boundary_rows(&x, &v, &removed, &volume, 0..self.group.cloud.len());
            let units = own.3;
            sum_over_own_blocks((own.0, own.1, own.2), &|_, (common, volume, packed): WithVolume<'_>| {
                run_hot(PackBoundary(common, volume, packed, units))
            })
        };
        if has_several() && !(is_local && moved.is_zero()) {
            let (x, v) = (view.read::<Position>()?, view.read::<Velocity>()?);
            let (volume, removed) = (view.read::<ReferenceVolume>()?, view.read::<Removed>()?);
            for part in others_rows(&(0..self.group.cloud.len())) {
                let (common, volume, packed, units) = self.boundary_rows(&x, &v, &removed, &volume, part);
                sum_over_blocks((common, volume, packed), &|_, (common, volume, packed): WithVolume<'_>| {
                    run_hot(PackBoundary(common, volume, packed, units))
                });
            }
        }
        Ok(moved)
    }

    /// Some rows of a boundary, counted from its first.
    #[allow(clippy::type_complexity)]
    fn boundary_rows<'r>(
        &'r mut self,
        x: &'r [Position],
        v: &'r [Velocity],
        removed: &'r [Removed],
        volume: &'r [ReferenceVolume],
        part: Range<usize>,
    ) -> (Common<'r>, &'r [ReferenceVolume], Option<&'r mut [Packed]>, Option<&'r Units>) {
        let first = self.group.rows.start;
        let rows = first + part.start..first + part.end;
        let common =
            (&mut self.records[part.clone()], &x[rows.clone()], &v[rows.clone()], &removed[rows.clone()]);
        let packed = self.packed.as_mut().map(|packed| &mut packed[part]);
        (common, &volume[rows], packed, self.units)
    }
}

type Common<'a> = (&'a mut [FlowParticle], &'a [Position], &'a [Velocity], &'a [Removed]);
type Fluids<'a> = (&'a [Mass], &'a [Density], &'a [Pressure]);
/// Records, the sources of their volumes and pressures, and the records of blocks for the same particles.
type WithPacked<'a, T> = (Common<'a>, T, Option<&'a mut [Packed]>);
type WithVolume<'a> = WithPacked<'a, &'a [ReferenceVolume]>;

struct PackFluid<'a>(Common<'a>, Fluids<'a>, Option<&'a mut [Packed]>, Option<&'a Units>);

impl HotLoop for PackFluid<'_> {
    type Output = DisplacementBounds;

    #[inline(always)]
    fn run<A: FourLanes>(self, a: A) -> DisplacementBounds {
        let Self((records, x, v, removed), (mass, density, pressure), packed, units) = self;
        let mut moved = BoundsBuilder::new();
        for (k, record) in records.iter_mut().enumerate() {
            let volume = if removed[k] == Removed::NO { mass[k].0 / density[k].0 } else { 0.0 };
            write(a, record, Lanes4::new(x[k].0, volume), &mut moved);
            record.motion = Lanes4::new(v[k].0, pressure[k].0);
        }
        pack_block(packed, records, units);
        moved.end()
    }
}

struct PackBoundary<'a>(Common<'a>, &'a [ReferenceVolume], Option<&'a mut [Packed]>, Option<&'a Units>);

impl HotLoop for PackBoundary<'_> {
    type Output = DisplacementBounds;

    #[inline(always)]
    fn run<A: FourLanes>(self, a: A) -> DisplacementBounds {
        let Self((records, x, v, removed), volume, packed, units) = self;
        let mut moved = BoundsBuilder::new();
        for (k, record) in records.iter_mut().enumerate() {
            let volume = if removed[k] == Removed::NO { volume[k].0 } else { 0.0 };
            write(a, record, Lanes4::new(x[k].0, volume), &mut moved);
            record.motion = Lanes4::new(v[k].0, 0.0);
        }
        pack_block(packed, records, units);
        moved.end()
    }
}

/// Packs a block for sums in single precision, while its records are in the cache.
#[inline(always)]
fn pack_block(packed: Option<&mut [Packed]>, records: &[FlowParticle], units: Option<&Units>) {
    if let (Some(packed), Some(units)) = (packed, units) {
        packed.iter_mut().zip(records).for_each(|(packed, record)| packed.take(record, units));
    }
}

/// Writes the place of a particle, and adds to `moved` how far it is from where it was.
#[inline(always)]
fn write<A: FourLanes>(a: A, record: &mut FlowParticle, place: Lanes4, moved: &mut BoundsBuilder) {
    moved.add(a, a.sub(place, record.place));
    record.place = place;
}
