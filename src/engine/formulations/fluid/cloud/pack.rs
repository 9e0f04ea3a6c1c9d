//! Packing of the cloud from the columns, in every step.

use std::ops::Range;

use glam::DVec3;

use super::flow_cloud::FlowCloud;
use crate::formulations::fluid::lanes::FlowParticle;
use crate::formulations::fluid::lists::blocks::{Packed, Units, pack_states};
use crate::formulations::fluid::lists::{DisplacementBounds, Growing};
use crate::parallel::{FourLanes, HotLoop, Lanes4, run_hot, sum_over_blocks};
use crate::world::{
    Density, Mass, MissingColumn, Position, Pressure, ReferenceVolume, Removed, Velocity, World,
};

impl FlowCloud {
    /// Packs positions, volumes and velocities; fluids with their pressure, boundaries without. Says how far the particles have moved since
    /// they were packed before.
    pub(in crate::formulations::fluid) fn pack(
        &mut self,
        world: &World,
    ) -> Result<DisplacementBounds, MissingColumn> {
        let mut moved = DisplacementBounds::NONE;
        let mut blocks = self.blocks.as_mut();
        if let Some(blocks) = &mut blocks {
            blocks.packed.resize(self.records.len(), Packed::default());
        }
        self.is_still.clear();
        for group in &self.groups {
            let (view, rows) = (world.phase(group.phase), group.rows.clone());
            let (x, v, removed) =
                (view.read::<Position>()?, view.read::<Velocity>()?, view.read::<Removed>()?);
            let common = (
                &mut self.records[group.cloud.clone()],
                &x[rows.clone()],
                &v[rows.clone()],
                &removed[rows.clone()],
            );
            let (units, packed) = match &mut blocks {
                Some(blocks) => (Some(&blocks.units), Some(&mut blocks.packed[group.cloud.clone()])),
                None => (None, None),
            };
            let of_group = if group.fluid().is_some() {
                let (density, mass) = (view.read::<Density>()?, view.read::<Mass>()?);
                let pressure = view.read::<Pressure>()?;
                let fluid = (&mass[rows.clone()], &density[rows.clone()], &pressure[rows]);
                sum_over_blocks((common, fluid, packed), &|_, (common, fluid, packed): WithPacked<_>| {
                    run_hot(PackFluid(common, fluid, packed, units))
                })
            } else {
                let volume = view.read::<ReferenceVolume>()?;
                let volume = &volume[rows];
                sum_over_blocks((common, volume, packed), &|_, (common, volume, packed): WithPacked<_>| {
                    run_hot(PackBoundary(common, volume, packed, units))
                })
            };
            self.is_still.push(of_group.is_zero());
            moved = moved.with(of_group);
        }
        Ok(moved)
    }

    /// Packs volumes, velocities and pressures of these rows for sums in single precision, once they are those of the end of the step.
    pub(in crate::formulations::fluid) fn pack_states(&mut self, rows: Range<usize>) {
        if let Some(blocks) = &mut self.blocks {
            pack_states(&mut blocks.packed[rows.clone()], &self.records[rows]);
        }
    }

    /// Writes down where the particles are, m.
    pub(in crate::formulations::fluid) fn read_positions(&self, positions: &mut Vec<DVec3>) {
        positions.resize(self.records.len(), DVec3::ZERO);
        sum_over_blocks((&mut positions[..], &self.records[..]), &|_,
                                                                   (to, from): (
            &mut [DVec3],
            &[FlowParticle],
        )| {
            to.iter_mut().zip(from).for_each(|(to, from)| *to = from.position());
        });
    }
}

type Common<'a> = (&'a mut [FlowParticle], &'a [Position], &'a [Velocity], &'a [Removed]);
type Fluids<'a> = (&'a [Mass], &'a [Density], &'a [Pressure]);
/// Records, what their volumes and pressures are made of, and what blocks know of the same particles.
type WithPacked<'a, T> = (Common<'a>, T, Option<&'a mut [Packed]>);

struct PackFluid<'a>(Common<'a>, Fluids<'a>, Option<&'a mut [Packed]>, Option<&'a Units>);

impl HotLoop for PackFluid<'_> {
    type Output = DisplacementBounds;

    #[inline(always)]
    fn run<A: FourLanes>(self, a: A) -> DisplacementBounds {
        let Self((records, x, v, removed), (mass, density, pressure), packed, units) = self;
        let mut moved = Growing::new();
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
        let mut moved = Growing::new();
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
fn write<A: FourLanes>(a: A, record: &mut FlowParticle, place: Lanes4, moved: &mut Growing) {
    moved.add(a, a.minus(place, record.place));
    record.place = place;
}
