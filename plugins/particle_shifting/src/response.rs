//! How velocity and density respond to the displacements.

use std::ops::Range;

use meshless_engine::formulations::fluid::{DensityShift, FlowCloud, NearPairs, RowPass};
use meshless_engine::glam::DVec3;
use meshless_engine::parallel::{Arithmetic, Vector, sum_over_blocks};
use meshless_engine::schedule::{Step, StepError};
use meshless_engine::world::{BodyId, Density, Mass, Removed, Velocity};

use crate::PendingDilation;
use crate::displacement::Shift;
use crate::local::Local;

/// Time in which the density follows, over h / c_0: some ten steps.
const FOLLOWS: f64 = 4.0;
/// Excess of volume that is left as it is: lattices differ by as much.
const DEAD: f64 = 0.01;
/// Rate at which the density follows the rest of the excess, over the strain rate.
const RETURN: f64 = 1.0;

/// Effect of the displacements of a neighbourhood on a particle.
#[derive(Clone, Copy, Debug, Default)]
pub struct ShiftResponse {
    /// Change of its velocity, m/s: its new place has another.
    pub velocity: DVec3,
    /// Change of volume over volume by the displacements.
    pub dilation: f64,
    /// Excess of volume as a mean over its neighbours.
    pub excess: f64,
    /// Change of what the density has yet to follow, if its neighbours share it.
    pub shared: f64,
}

/// The pass that computes the responses.
pub struct Responses<'a> {
    pub cloud: &'a FlowCloud,
    pub locals: &'a [Local],
    pub shifts: &'a [Shift],
    /// Change of volume that the density has not followed yet.
    pub pending: &'a [f64],
}

impl RowPass<4, 3> for Responses<'_> {
    type Output = ShiftResponse;

    fn among(&self) -> Range<usize> {
        self.cloud.everything()
    }

    /// Velocity; displacement; pending dilation and excess; one inside, zero elsewhere.
    #[inline(always)]
    fn reads(&self, row: usize) -> [DVec3; 4] {
        // What bounds the flow stays where it is.
        let Some(Shift { displacement, inside }) = self.shifts.get(row) else { return [DVec3::ZERO; 4] };
        let both = DVec3::new(self.pending[row], self.locals[row].excess, 0.0);
        [self.cloud.records()[row].velocity(), *displacement, both, DVec3::X * f64::from(u8::from(*inside))]
    }

    #[inline(always)]
    fn add<A: Arithmetic>(
        &self,
        near: &NearPairs<A>,
        [v_i, dx_i, own, _]: &[Vector<A>; 4],
        [v_j, dx_j, other, inside]: &[Vector<A>; 4],
        [velocity, dilation_and_excess, shared]: &mut [Vector<A>; 3],
    ) {
        dilation_and_excess.x += near.dilation(&self.cloud.kernel, *dx_i, *dx_j);
        if near.is_fluid {
            let both = *dx_i + *dx_j;
            let moved = near.volume * near.weight * 0.5 * both.dot(near.x_ij);
            *velocity = (*v_j - *v_i).mul_add(moved, *velocity);
            let filled = near.volume * near.kernel;
            shared.x += filled * (other.x - own.x);
            dilation_and_excess.y += filled * inside.x * (other.y - own.y);
        }
    }

    #[inline(always)]
    fn output(&self, i: usize, &[velocity, dilation_and_excess, shared]: &[DVec3; 3]) -> ShiftResponse {
        let is_inside = self.shifts[i].inside;
        ShiftResponse {
            velocity,
            dilation: if is_inside { dilation_and_excess.x } else { 0.0 },
            excess: if is_inside { self.locals[i].excess + dilation_and_excess.y } else { 0.0 },
            shared: shared.x,
        }
    }
}

/// Changes the velocities of a body; returns the kinetic energy that they lose, J. The changes at the new
/// places do not add up to zero momentum. Each particle therefore gives up a part in proportion to the
/// magnitude of its own change: the momentum of the body is conserved, and the energy is the same in every
/// frame.
pub fn change_velocity(step: &Step<'_>, id: BodyId, responses: &[ShiftResponse]) -> Result<f64, StepError> {
    let (view, rows) = step.world.body_view(id);
    let mut velocity = view.write::<Velocity>()?;
    let (mass, removed) = (view.read::<Mass>()?, view.read::<Removed>()?);
    let (responses, mass, removed) = (&responses[rows.clone()], &mass[rows.clone()], &removed[rows.clone()]);
    let slices = (responses, mass, removed);
    type Gains<'a> = (&'a [ShiftResponse], &'a [Mass], &'a [Removed]);
    let (gain, magnitude): (DVec3, f64) =
        sum_over_blocks(slices, &|_, (responses, mass, removed): Gains<'_>| {
            let (mut gain, mut magnitude) = (DVec3::ZERO, 0.0);
            for k in (0..mass.len()).filter(|&k| removed[k] == Removed::NO) {
                gain += mass[k].0 * responses[k].velocity;
                magnitude += mass[k].0 * responses[k].velocity.length();
            }
            (gain, magnitude)
        });
    let excess = if magnitude > 0.0 { gain / magnitude } else { DVec3::ZERO };
    let slices = (&mut velocity[rows], responses, mass, removed);
    type Rows<'a> = (&'a mut [Velocity], &'a [ShiftResponse], &'a [Mass], &'a [Removed]);
    Ok(sum_over_blocks(slices, &|_, (velocity, responses, mass, removed): Rows<'_>| {
        let mut lost = 0.0;
        for k in (0..velocity.len()).filter(|&k| removed[k] == Removed::NO) {
            let (v, change) = (velocity[k].0, responses[k].velocity);
            let change = change - change.length() * excess;
            lost -= mass[k].0 * change.dot(v + 0.5 * change);
            velocity[k].0 = v + change;
        }
        lost
    }))
}

/// Adds the changes of density that come before and after the flow of the next step.
pub fn change_density(
    step: &Step<'_>,
    cloud: &FlowCloud,
    id: BodyId,
    locals: &[Local],
    responses: &[ShiftResponse],
) -> Result<(), StepError> {
    let (view, rows) = step.world.body_view(id);
    let density = view.read::<Density>()?;
    let (mut shift, mut pending) = (view.write::<DensityShift>()?, view.write::<PendingDilation>()?);
    let dt = step.clock.dt;
    let sound_speed = cloud.state(id).map_or(0.0, |state| state.sound_speed);
    let share = 1.0 - (-dt * sound_speed / (FOLLOWS * cloud.kernel.smoothing_length())).exp();
    // In a step of the usual length neighbours take a mean: what they share does not depend on the number of
    // steps.
    let mixing = (FOLLOWS * share / 0.4).min(1.0);
    for row in rows {
        let ShiftResponse { dilation, excess, shared, .. } = responses[row];
        let due = pending[row].0 + mixing * shared + dilation;
        pending[row].0 = due * (1.0 - share);
        let beyond = excess.signum() * (excess.abs() - DEAD).max(0.0);
        let change = (RETURN * dt * locals[row].strain_rate).min(1.0) * beyond - share * due;
        shift[row].0 += density[row].0 * change / (1.0 - 0.5 * change);
    }
    Ok(())
}
