//! The velocity gradient at mid-step, and the update of the deformation gradient.
//!
//! With the Cayley map the change of F over its mean is dt L to rounding, which is what hypoelastic laws use,
//! and a rigid rotation stays one. Positions at the end of the step would give a rotating body a spurious
//! dilatation of omega^2 dt / 2.

use glam::{DMat3, DVec3};

use super::dilatation::{DilatationRate, gradient};
use super::near::MIN_SPREAD;
use super::particle::EulerianParticle;
use super::rows::{EulerianRows, PointColumns};
use super::start;
use super::within::{CHUNK, Within};
use crate::correction::MomentMatrix;
use crate::kernels::{Kernel, KernelProfile, KernelVisitor, ProfiledKernel, ScaledKernel};
use crate::parallel::{FourLanes, Lanes4, PlaneOrSpace, for_each_own_block, run_hot_in, share_rows};
use crate::schedule::{Run, Step, StepError};
use crate::solids::fit;
use crate::world::{
    DeformationGradient, PhaseId, Position, ReferencePosition, ReferenceVolume, Removed, Velocity, World,
};

/// Label of the system that makes velocity and deformation gradients.
pub(super) const RATES: &str = "eulerian_rates";

/// The system.
pub(super) struct VelocityGradients {
    pub phase: PhaseId,
}

impl Run for VelocityGradients {
    fn run(&mut self, step: &mut Step<'_>) -> Result<(), StepError> {
        let mut packed = step.resources.solid_rows_mut::<EulerianRows>(self.phase);
        let view = step.world.phase(self.phase);
        let position = view.read_near::<Position>()?;
        let reference = view.read_near::<ReferencePosition>()?;
        let (place, start): (&[DVec3], &[DVec3]) =
            (bytemuck::cast_slice(&position), bytemuck::cast_slice(&reference));
        let mut deformation = view.write::<DeformationGradient>()?;
        if step.clock.step == 0 && step.clock.dt == 0.0 {
            let volume = view.read_near::<ReferenceVolume>()?;
            start::fit_gradients(&packed, start, place, bytemuck::cast_slice(&volume), &mut deformation);
        }
        update_lists(&mut packed, place, start, step.world)?;
        if step.clock.dt > 0.0 {
            let (velocity, volume) = (view.read_near::<Velocity>()?, view.read_near::<ReferenceVolume>()?);
            let columns = PointColumns {
                position: &position,
                velocity: &velocity,
                volume: &volume,
                deformation: &deformation,
            };
            let removed = view.read_near::<Removed>()?;
            let gone = (0..removed.len()).filter(|&row| removed[row] != Removed::NO);
            packed.pack(&columns, 0.5 * step.clock.dt, gone);
            packed.lists.leave_out_elsewhere(place, start, &deformation);
            let dilatation =
                if view.has::<DilatationRate>() { Some(view.read::<DilatationRate>()?) } else { None };
            advance(&packed, &mut deformation, dilatation.as_deref(), step.clock.dt);
        }
        packed.lists.leave_out_elsewhere(place, start, &deformation);
        Ok(())
    }
}

/// Brings the lists up to date.
fn update_lists(
    packed: &mut EulerianRows,
    position: &[DVec3],
    reference: &[DVec3],
    world: &World,
) -> Result<(), StepError> {
    packed.update_lists(position, reference).map_err(|(body, error)| {
        let message = format!("neighbours of body `{}` cannot be listed: {error}", world.body(body).name);
        StepError::System { system: RATES.to_owned(), message }
    })
}

/// Advances F of all bodies by a step of `dt`, s.
fn advance(
    packed: &EulerianRows,
    deformation: &mut [DeformationGradient],
    dilatation: Option<&[DilatationRate]>,
    dt: f64,
) {
    let EulerianRows { lists, kernels, points, plane, .. } = packed;
    for (body, of) in lists.bodies.iter().zip(kernels) {
        let rows = body.rows.clone();
        let own: &mut [DMat3] = bytemuck::cast_slice_mut(&mut deformation[rows.clone()]);
        for_each_own_block(&mut *own, &mut Vec::new(), &|first, deformation: &mut [DMat3]| {
            let first = rows.start + first;
            let offsets = &lists.pairs.offsets()[first..=first + deformation.len()];
            let (kernel, support) = (of.kernel, body.support);
            let (neighbors, plane) = (lists.pairs.indices(), *plane);
            kernel.dispatch(Advance {
                kernel,
                support,
                offsets,
                neighbors,
                points,
                first,
                plane,
                dilatation,
                dt,
                deformation,
            });
        });
        share_rows(own);
    }
}

/// Advances F of a block.
struct Advance<'a> {
    kernel: Kernel,
    support: f64,
    offsets: &'a [usize],
    neighbors: &'a [u32],
    points: &'a [EulerianParticle],
    first: usize,
    plane: bool,
    /// Of all rows of the phase, if plugins change volumes.
    dilatation: Option<&'a [DilatationRate]>,
    dt: f64,
    deformation: &'a mut [DMat3],
}

impl KernelVisitor for Advance<'_> {
    type Output = ();

    fn visit<K: KernelProfile>(self, kernel: ProfiledKernel<K>) {
        let kernel = kernel.scaled(self.kernel.smoothing_length(self.support));
        run_hot_in(self.plane, AdvanceLoop { kernel, of: self });
    }
}

struct AdvanceLoop<'a, K: KernelProfile> {
    kernel: ScaledKernel<K>,
    of: Advance<'a>,
}

impl<K: KernelProfile> PlaneOrSpace for AdvanceLoop<'_, K> {
    #[inline(always)]
    fn run<A: FourLanes, const D: usize>(self, a: A) {
        let Self {
            kernel,
            of: Advance { support, offsets, neighbors, points, first, dilatation, dt, deformation, .. },
        } = self;
        let limit = support * support;
        let (mut near, mut weights) = ([0_u32; CHUNK], [0.0; CHUNK]);
        for (k, f) in deformation.iter_mut().enumerate() {
            let own = points[first + k];
            if own.place.0[3] <= 0.0 {
                continue;
            }
            let (mut moment, mut spread) = ([Lanes4::ZERO; D], [Lanes4::ZERO; D]);
            for list in neighbors[offsets[k]..offsets[k + 1]].chunks(CHUNK) {
                let within = Within { neighbors: &mut near, squares: &mut weights };
                let count = within.find(a, list, (own.place, limit), points);
                for weight in &mut weights[..count] {
                    *weight = kernel.pair_weight(weight.sqrt());
                }
                for n in 0..count {
                    let other = &points[near[n] as usize];
                    let arm = a.sub(other.place, own.place);
                    let weighted = a.scale(other.place.0[3] * weights[n], arm);
                    let passing = a.sub(other.velocity, own.velocity);
                    for axis in 0..D {
                        moment[axis] = a.scale_add(arm.0[axis], weighted, moment[axis]);
                        spread[axis] = a.scale_add(weighted.0[axis], passing, spread[axis]);
                    }
                }
            }
            let Some(inverse) = MomentMatrix::of_columns(&moment).inverse_above(MIN_SPREAD) else {
                continue;
            };
            let l = fit::<A, D>(a, &spread, &inverse);
            let mut rate = DMat3::from_cols(l[0].xyz(), l[1].xyz(), l[2].xyz());
            if let Some(dilatation) = dilatation {
                rate += gradient(dilatation[first + k].0, D == 2);
            }
            let half = rate * (0.5 * dt);
            *f = cayley(&half) * *f;
        }
    }
}

/// (I - a)^-1 (I + a).
#[inline(always)]
fn cayley(a: &DMat3) -> DMat3 {
    (DMat3::IDENTITY - *a).inverse() * (DMat3::IDENTITY + *a)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::materials::velocity_gradient_step;

    #[test]
    fn a_law_gets_the_velocity_gradient_back_from_the_change_of_f() {
        let l = DMat3::from_cols_array(&[0.1, -0.2, 0.05, 0.3, -0.15, 0.1, -0.04, 0.2, 0.12]);
        let f = DMat3::from_cols_array(&[1.2, 0.1, 0.0, -0.3, 0.9, 0.1, 0.2, 0.0, 1.1]);
        let step = velocity_gradient_step(&f, &(cayley(&(l * 0.5)) * f));
        assert!(step.abs_diff_eq(l, 1e-14), "{step}");
    }

    #[test]
    fn a_turn_stays_a_turn_however_far_it_goes() {
        let spin = DMat3::from_cols_array(&[0.0, 0.7, 0.0, -0.7, 0.0, 0.0, 0.0, 0.0, 0.0]);
        let mut f = DMat3::IDENTITY;
        (0..1000).for_each(|_| f = cayley(&spin) * f);
        assert!((f.transpose() * f).abs_diff_eq(DMat3::IDENTITY, 1e-11));
    }
}
