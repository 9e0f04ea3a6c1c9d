//! The internal force, with gravity: the adjoint of the velocity gradient at the same places.

use glam::DVec3;

use super::dilatation::Dilatation;
use super::rows::EulerianRows;
use crate::parallel::{FourLanes, Lanes4, PlaneOrSpace, for_each_own_block, run_hot_in, share_rows_of};
use crate::schedule::{Run, Step, StepError};
use crate::world::{Force, Mass, PhaseId};

/// The system of the pass.
pub(super) struct EulerianForce {
    pub phase: PhaseId,
    /// Acceleration of gravity, m/s2.
    pub gravity: DVec3,
    /// What changes of volume do without a motion: the stresses are complete here, with those of loads on the
    /// surface.
    pub dilatation: Dilatation,
}

impl Run for EulerianForce {
    fn run(&mut self, step: &mut Step<'_>) -> Result<(), StepError> {
        let view = step.world.phase(self.phase);
        let packed = step.resources.solid_rows::<EulerianRows>(self.phase);
        let mass = view.read::<Mass>()?;
        let mut force = view.write_own::<Force>()?;
        write_own(&packed, &mass, self.gravity, &mut force);
        self.dilatation.book(self.phase, &packed, step)
    }

    fn save(&self) -> Vec<u8> {
        self.dilatation.save()
    }

    fn restore(&mut self, state: &[u8]) -> bool {
        self.dilatation.restore(state)
    }
}

/// Writes the force of the stresses that are there on the particles of all ranks, N, without gravity.
pub(super) fn write(packed: &EulerianRows, mass: &[Mass], force: &mut [Force]) {
    write_own(packed, mass, DVec3::ZERO, force);
    share_rows_of(force, packed.lists.bodies.iter().map(|body| body.rows.clone()));
}

/// Writes the force of the stresses that are there, and of gravity, on the particles that this rank computes,
/// N.
fn write_own(packed: &EulerianRows, mass: &[Mass], gravity: DVec3, force: &mut [Force]) {
    for rows in packed.lists.bodies.iter().map(|body| body.rows.clone()) {
        let start = rows.start;
        let of_body = (&mut force[rows.clone()], &mass[rows]);
        for_each_own_block(of_body, &mut Vec::new(), &|first, (force, mass): (&mut [Force], &[Mass])| {
            let first = start + first;
            run_hot_in(packed.plane, EulerianForceRows { packed, first, force: &mut *force });
            for (k, (force, mass)) in force.iter_mut().zip(mass).enumerate() {
                // Nothing acts on a removed particle, not even gravity.
                if packed.points[first + k].place.0[3] > 0.0 {
                    force.0 += gravity * mass.0;
                }
            }
        });
    }
}

struct EulerianForceRows<'a> {
    packed: &'a EulerianRows,
    first: usize,
    force: &'a mut [Force],
}

impl PlaneOrSpace for EulerianForceRows<'_> {
    #[inline(always)]
    fn run<A: FourLanes, const D: usize>(self, a: A) {
        let EulerianRows { lists, near, points, stresses, control, .. } = self.packed;
        for (k, force) in self.force.iter_mut().enumerate() {
            let i = self.first + k;
            let (place, own, around) = (points[i].place, &stresses[i], &near.around[i]);
            let (neighbors, weights) = near.row(lists.pairs.offsets()[i], i);
            let mut sum = Lanes4::ZERO;
            for n in 0..neighbors.len() {
                let j = neighbors[n] as usize;
                let other = &stresses[j];
                let arm = a.sub(points[j].place, place);
                let mut traction = a.scale(arm.0[0], other.columns[0]);
                for axis in 1..D {
                    traction = a.scale_add(arm.0[axis], other.columns[axis], traction);
                }
                sum = a.scale_add(weights[n] * other.traction.0[3], traction, sum);
            }
            let volume = place.0[3];
            let of_volume = if volume > 0.0 { own.traction.0[3] / volume } else { 0.0 };
            let first = around.first_moment * of_volume;
            for axis in 0..D {
                sum = a.scale_add(first[axis], own.columns[axis], sum);
            }
            *force = Force(sum.xyz() * own.traction.0[3] + control.force[i].xyz());
        }
    }
}
