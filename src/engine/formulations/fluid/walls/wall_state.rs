//! The system that gives walls the pressure of the fluid beside them, and the velocity that a sticking fluid
//! sees.

use glam::DVec3;

use super::own_motion::SeenMotions;
use super::wall::PreviousVelocity;
use super::wall_blocks::WallBlocks;
use super::wall_pressure::{FluidBeside, WallPressure};
use crate::formulations::fluid::cloud::{BoundarySurface, FlowCloud, Group, Role};
use crate::formulations::fluid::lanes::FlowParticle;
use crate::parallel::{Lanes4, for_each_block, for_each_own_block, own_rows};
use crate::rigid::{RigidAcceleration, RigidBodies};
use crate::schedule::{Run, Step, StepError};
use crate::world::Pressure;

/// Sets pressure and velocity of walls in the packed rows, and their pressure column.
pub struct WallState {
    /// Acceleration of gravity, m/s2.
    pub gravity: DVec3,
    pub beside: Vec<FluidBeside>,
    pub motions: SeenMotions,
}

type MovedRows<'a> = (&'a mut [FlowParticle], &'a [FluidBeside]);
type Rows<'a> = (&'a mut [FlowParticle], &'a mut [Pressure], &'a mut [PreviousVelocity], &'a [FluidBeside]);

impl Run for WallState {
    fn run(&mut self, step: &mut Step<'_>) -> Result<(), StepError> {
        let mut cloud = step.resources.get_mut::<FlowCloud>();
        self.beside.resize(cloud.records.len() - cloud.fluid, FluidBeside::default());
        let mut blocks = cloud.blocks.take();
        let mut near = std::mem::take(&mut cloud.near_boundary);
        match blocks.as_mut().filter(|blocks| !blocks.hides) {
            Some(blocks) => WallBlocks { cloud: &cloud }.run(blocks, &mut self.beside),
            None => WallPressure { cloud: &cloud }.run(&mut self.beside, &mut near),
        }
        (cloud.near_boundary, cloud.blocks) = (near, blocks);
        let first = cloud.fluid;
        for group in cloud.groups.iter().filter(|group| group.sticks()) {
            // A fluid that moves with its wall has no friction, whether both rotate like one rigid body or
            // are sheared alike.
            let beside = &mut self.beside[group.cloud.start - first..group.cloud.end - first];
            cloud.for_each_gradient(group, beside, |fluid, gradient| {
                fluid.velocity -= gradient * fluid.offset
            });
        }
        let is_local = cloud.is_local();
        let elapsed = self.motions.elapsed(&step.clock);
        if let Some(bodies) = step.resources.try_get::<RigidBodies>() {
            self.motions.follow(&bodies, elapsed);
        }
        let FlowCloud { groups, records, fluid, pressure_factor, .. } = &mut *cloud;
        for group in groups {
            let Role::Boundary(surface) = &group.role else { continue };
            let beside = &self.beside[group.cloud.start - *fluid..group.cloud.end - *fluid];
            let boundary = BoundaryStep { surface, gravity: self.gravity, factor: *pressure_factor, elapsed };
            if surface.moved {
                let known = self.motions.of(group.body);
                let rows = (&mut records[group.cloud.clone()], beside);
                for_each_block(rows, &mut Vec::new(), &|_, rows| boundary.apply_to_solid(known, rows));
                continue;
            }
            let view = step.world.phase(group.phase);
            let write_pressure =
                || if is_local { view.write_own::<Pressure>() } else { view.write::<Pressure>() };
            let mut pressure = write_pressure()?;
            let mut previous = if is_local {
                view.write_own::<PreviousVelocity>()?
            } else {
                view.write::<PreviousVelocity>()?
            };
            let rows = group.rows.clone();
            let slices: Rows<'_> =
                (&mut records[group.cloud.clone()], &mut pressure[rows.clone()], &mut previous[rows], beside);
            let body = |_, rows: Rows<'_>| boundary.apply(rows);
            match is_local {
                true => for_each_own_block(slices, &mut Vec::new(), &body),
                false => for_each_block(slices, &mut Vec::new(), &body),
            }
        }
        pack(&mut cloud);
        Ok(())
    }

    fn save(&self) -> Vec<u8> {
        self.motions.save()
    }

    fn restore(&mut self, state: &[u8]) -> bool {
        self.motions.restore(state)
    }
}

/// Packs the states of boundaries, and gets those of other ranks.
fn pack(cloud: &mut FlowCloud) {
    if !cloud.is_local() {
        return cloud.pack_states(cloud.fluid..cloud.records.len());
    }
    for n in 0..cloud.groups.len() {
        let Group { cloud: rows, role, .. } = &cloud.groups[n];
        let own = own_rows(rows);
        if matches!(role, Role::Boundary(_)) {
            cloud.pack_states(own);
        }
    }
    cloud.share_boundaries();
}

/// A step of the particles of a boundary.
struct BoundaryStep<'a> {
    surface: &'a BoundarySurface,
    gravity: DVec3,
    /// What multiplies pressures in sums over pairs.
    factor: f64,
    /// Time since the velocities in the step before, s.
    elapsed: f64,
}

impl BoundaryStep<'_> {
    fn apply(&self, (records, pressure, previous, beside): Rows<'_>) {
        let Self { surface, gravity, factor, elapsed } = *self;
        for (k, record) in records.iter_mut().enumerate() {
            let v = record.velocity();
            let acceleration = if elapsed > 0.0 { (v - previous[k].0) / elapsed } else { DVec3::ZERO };
            previous[k] = PreviousVelocity(v);
            let fluid = &beside[k];
            let mut p = fluid.pressure - factor * (gravity - acceleration).dot(fluid.moment);
            if !surface.suction {
                p = p.max(0.0);
            }
            pressure[k] = Pressure(p / factor);
            // Halfway between this velocity and that of the fluid lies the velocity of the surface.
            let seen = if surface.no_slip { v + 2.0 * surface.velocity - fluid.velocity } else { v };
            record.motion = Lanes4::new(seen, p);
        }
    }

    /// The acceleration of a deformable body that the fluid moves is left out: it would act on itself one
    /// step later, as a mass that is added explicitly, and a light body would not stand it. The resulting
    /// error falls with the spacing. That of a rigid body is `known`, from the steps before (`own_motion`).
    fn apply_to_solid(&self, known: Option<RigidAcceleration>, (records, beside): MovedRows<'_>) {
        let Self { surface, gravity, factor, .. } = *self;
        for (record, fluid) in records.iter_mut().zip(beside) {
            let v = record.velocity();
            let acceleration = known.map_or(DVec3::ZERO, |known| known.at(record.position()));
            let mut p = fluid.pressure - factor * (gravity - acceleration).dot(fluid.moment);
            if !surface.suction {
                p = p.max(0.0);
            }
            let seen = if surface.no_slip { v - fluid.velocity } else { v };
            record.motion = Lanes4::new(seen, p);
        }
    }
}
