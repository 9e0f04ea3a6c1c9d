//! Change of volume that plugins request in addition to that of the motion: smoothing of the density.
//!
//! F is a state of the particle, so that its volume can be changed without a motion. The work of the stress
//! in that change, including the stress of hourglass control, is not the work of a force: it is booked under
//! the name of the plugin.

use glam::DMat3;

use super::rows::EulerianRows;
use crate::column;
use crate::parallel::sum_over_blocks;
use crate::schedule::{AccountKind, Step, StepError};
use crate::world::PhaseId;

column! {
    /// Rate of the logarithm of the volume that plugins add to the trace of the velocity gradient of the next
    /// step. Plugins that work on bodies which take [`Offer::Dilatation`](crate::plugin::Offer::Dilatation)
    /// write it.
    pub struct DilatationRate(f64) = "dilatation_rate", "d", "1/s";
}

/// Account of what leaves the stored energy by it.
const ACCOUNT: &str = "density_diffusion";

/// What each particle gains by a change of the logarithm of its volume: tr(tau) V_0 over the axes of the
/// body, J, at the end of the last step. A checkpoint holds it: the next step books the mean with its own.
#[derive(Default)]
pub(super) struct Dilatation {
    before: Vec<f64>,
}

impl Dilatation {
    /// Books the change of the stored energies of the bodies by the change of volume of the last step, with
    /// the mean of the stresses before and after it. Without a step it stores the stresses only.
    pub fn book(
        &mut self,
        phase: PhaseId,
        packed: &EulerianRows,
        step: &mut Step<'_>,
    ) -> Result<(), StepError> {
        let view = step.world.phase(phase);
        if !view.has::<DilatationRate>() {
            return Ok(());
        }
        let rate = view.read::<DilatationRate>()?;
        self.before.resize(rate.len(), 0.0);
        let account = step.ledger.account(ACCOUNT, AccountKind::Dissipated);
        for body in &packed.lists.bodies {
            let rows = body.rows.clone();
            let own = (&mut self.before[rows.clone()], &rate[rows.clone()]);
            let energy = sum_over_blocks(own, &|first, (before, rate): (&mut [f64], &[DilatationRate])| {
                let mut energy = 0.0;
                for ((before, rate), row) in before.iter_mut().zip(rate).zip(rows.start + first..) {
                    let now = packed.held(row);
                    energy += 0.5 * (*before + now) * rate.0;
                    *before = now;
                }
                energy
            });
            if step.clock.dt > 0.0 {
                step.ledger.add(account, body.id, -energy * step.clock.dt);
            }
        }
        Ok(())
    }

    /// What a checkpoint holds.
    pub fn save(&self) -> Vec<u8> {
        postcard::to_stdvec(&self.before).unwrap_or_default()
    }

    /// Takes over what a checkpoint holds; `false` if it is something else.
    pub fn restore(&mut self, state: &[u8]) -> bool {
        postcard::from_bytes(state).map(|before| self.before = before).is_ok()
    }
}

impl EulerianRows {
    /// tr(tau) V_0 over the axes, with the stress that the force is computed from, J.
    fn held(&self, row: usize) -> f64 {
        let inverse = self.near.around[row].inverse_moment;
        let [x, y, z] = &self.stresses[row].columns;
        let volume = self.points[row].place.0[3];
        if volume <= 0.0 || inverse.trace() <= 0.0 {
            return 0.0;
        }
        let moment =
            if self.plane { plane_inverse(&inverse.to_matrix()) } else { inverse.inverse().to_matrix() };
        let stress = DMat3::from_cols(x.xyz(), y.xyz(), z.xyz()) * moment;
        if self.plane {
            0.5 * (stress.x_axis.x + stress.y_axis.y) * volume
        } else {
            (stress.x_axis.x + stress.y_axis.y + stress.z_axis.z) / 3.0 * volume
        }
    }
}

/// The inverse in the plane, zero across it.
fn plane_inverse(m: &DMat3) -> DMat3 {
    let inverse = glam::DMat2::from_cols(m.x_axis.truncate(), m.y_axis.truncate()).inverse();
    DMat3::from_cols(inverse.x_axis.extend(0.0), inverse.y_axis.extend(0.0), glam::DVec3::ZERO)
}

/// The part of the velocity gradient that a rate is, along the axes of the body.
#[inline(always)]
pub(super) fn gradient(rate: f64, plane: bool) -> DMat3 {
    let (along, across) = if plane { (0.5 * rate, 0.0) } else { (rate / 3.0, rate / 3.0) };
    DMat3::from_diagonal(glam::DVec3::new(along, along, across))
}
