//! How velocity and density respond to the displacements.

use meshless_engine::formulations::fluid::{DensityShift, FlowCloud, RowPass};
use meshless_engine::glam::DVec3;
use meshless_engine::parallel::{FourLanes, Number, Vector, sum_over_blocks};
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

/// What the displacements of a neighbourhood do to a particle.
#[derive(Clone, Copy, Debug, Default)]
pub struct Response {
    /// Change of its velocity, m/s: its new place has another.
    pub velocity: DVec3,
    /// Change of volume over volume by the displacements, `sum_j V_j (dx_j - dx_i) . grad_i W` halfway along them.
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

impl RowPass for Responses<'_> {
    type Output = Response;

    #[inline(always)]
    fn row<A: FourLanes>(&self, a: A, i: usize) -> Response {
        let Self { cloud, locals, shifts, pending } = *self;
        let (records, own) = (cloud.records(), shifts[i]);
        let (v_i, pending_i) = (records[i].velocity(), pending[i]);
        let mut velocity = Vector::zero(a);
        let (mut dilation, mut excess, mut shared) = (Number::zero(a), Number::zero(a), Number::zero(a));
        for near in cloud.fours(a, i, &(0..cloud.fluid)) {
            let filled = near.volume * near.kernel;
            let other = near.vector(|j| shifts[j].displacement);
            let both = other + Vector::splat(a, own.displacement);
            let v_ij = near.vector(|j| records[j].velocity() - v_i);
            velocity = v_ij.mul_add(near.volume * near.weight * 0.5 * both.dot(near.x_ij), velocity);
            shared += filled * (near.number(|j| pending[j]) - pending_i);
            if own.inside {
                let apart = other - Vector::splat(a, own.displacement);
                let middle = apart.mul_add(Number::splat(a, 0.5), near.x_ij);
                let weight = cloud.kernel.weights(a, middle.length_squared().sqrt().lanes());
                dilation += near.volume * Number::new(a, weight) * apart.dot(middle);
                let excess_i = locals[i].excess;
                excess += filled
                    * near.number(|j| if shifts[j].inside { locals[j].excess - excess_i } else { 0.0 });
            }
        }
        if own.inside {
            for near in cloud.fours(a, i, &(cloud.fluid..cloud.everything().end)) {
                let apart = Vector::splat(a, -own.displacement);
                let middle = apart.mul_add(Number::splat(a, 0.5), near.x_ij);
                let weight = cloud.kernel.weights(a, middle.length_squared().sqrt().lanes());
                dilation += near.volume * Number::new(a, weight) * apart.dot(middle);
            }
        }
        Response {
            velocity: velocity.sum(),
            dilation: dilation.sum(),
            excess: if own.inside { locals[i].excess + excess.sum() } else { 0.0 },
            shared: shared.sum(),
        }
    }
}

/// Changes the velocities of a body; returns the kinetic energy that they lose, J.
pub fn change_velocity(step: &Step<'_>, id: BodyId, responses: &[Response]) -> Result<f64, StepError> {
    let (view, rows) = step.world.body_view(id);
    let mut velocity = view.write::<Velocity>()?;
    let (mass, removed) = (view.read::<Mass>()?, view.read::<Removed>()?);
    let slices = (&mut velocity[rows.clone()], &responses[rows.clone()], &mass[rows.clone()], &removed[rows]);
    type Rows<'a> = (&'a mut [Velocity], &'a [Response], &'a [Mass], &'a [Removed]);
    Ok(sum_over_blocks(slices, &|_, (velocity, responses, mass, removed): Rows<'_>| {
        let mut lost = 0.0;
        for k in (0..velocity.len()).filter(|&k| removed[k] == Removed::NO) {
            let (v, change) = (velocity[k].0, responses[k].velocity);
            lost -= mass[k].0 * change.dot(v + 0.5 * change);
            velocity[k].0 = v + change;
        }
        lost
    }))
}

/// Sets the changes of density that come before and after the flow of the next step.
pub fn change_density(
    step: &Step<'_>,
    cloud: &FlowCloud,
    id: BodyId,
    locals: &[Local],
    responses: &[Response],
) -> Result<(), StepError> {
    let (view, rows) = step.world.body_view(id);
    let density = view.read::<Density>()?;
    let (mut shift, mut pending) = (view.write::<DensityShift>()?, view.write::<PendingDilation>()?);
    let dt = step.clock.dt;
    let sound_speed = cloud.state(id).map_or(0.0, |state| state.sound_speed);
    let share = 1.0 - (-dt * sound_speed / (FOLLOWS * cloud.kernel.smoothing_length())).exp();
    // In a step of the usual length neighbours take a mean: what they share does not depend on the number of steps.
    let mixing = (FOLLOWS * share / 0.4).min(1.0);
    for row in rows {
        let Response { dilation, excess, shared, .. } = responses[row];
        let due = pending[row].0 + mixing * shared + dilation;
        pending[row].0 = due * (1.0 - share);
        let beyond = excess.signum() * (excess.abs() - DEAD).max(0.0);
        let change = (RETURN * dt * locals[row].strain_rate).min(1.0) * beyond - share * due;
        shift[row] = DensityShift(density[row].0 * change / (1.0 - 0.5 * change));
    }
    Ok(())
}
