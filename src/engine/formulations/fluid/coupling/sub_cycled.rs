//! Damping of bodies that take sub-steps beside a fluid, against vibrations driven by its frozen force.

use crate::formulations::fluid::walls::has_suction;
use crate::materials::Law;
use crate::plugin::{BodyKind, SimBuilder};
use crate::solids::DampedSubSteps;
use crate::world::BodySet;

/// Share of the damping of bodies with the spacing of the fluid. A strip of rubber, four particles of the
/// water beside it thick and two of its own to each, rings with 0.02 and is quiet with 0.05 in its sub-steps.
///
/// Modes that swing to and fro in two steps of the fluid grow the fastest, by the stiffness of the fluid over
/// the mass of the body, per mode. The damping acts in each sub-step by what has changed in it, so that a
/// body of finer particles, in more sub-steps, needs a larger share: what it needs is a time. A sheet with
/// two particles of the water to its thickness, four and eight of its own, grows with 0.1 and not with 0.2;
/// with suction it grows with 0.2, eight across with 0.4 too, and not with 0.4 and 0.8.
const SHARE: f64 = 0.1;
/// The same where bodies have suction. Their rate of compression counts both the particles of the body and
/// the adjoint of its pressure, which doubles the stiffness of the fluid beside it: modes that swing to and
/// fro in two steps of the fluid, such as the breathing of a sheet between two layers of water, grow with 0.1
/// for some moduli. With 0.2 none grew, at 2.2 to 40 MPa in steps of 4.5 %.
const SHARE_WITH_SUCTION: f64 = 0.2;
/// Largest share. Bonds and contacts together may take sub-steps of 0.9 of the stable ones, which leaves room
/// for a share of 0.22; a body that would need more has shorter long steps.
const MOST: f64 = SHARE_WITH_SUCTION;

/// Asks for the damping of all deformable bodies of a scene with fluids, if they may take sub-steps.
pub fn damp_sub_cycled_bodies(sim: &mut SimBuilder<'_>) {
    let soft = sim.bodies().iter().filter(|body| body.kind == BodyKind::Solid);
    let soft: Vec<_> = soft.map(|body| (body.id, body.spacing)).collect();
    for (id, spacing) in soft {
        if let Some(share) = needed_share(spacing, sim) {
            let damping = DampedSubSteps { share: share.min(MOST) };
            sim.extend_bodies(BodySet::new([id]), "damping of its sub-steps", damping);
        }
    }
}

/// What remains of the long step beside a deformable body of that spacing, m. The growth falls with the
/// square of the step: where the share would be too large the step is smaller.
pub fn share_of_long_step(spacing: f64, sim: &SimBuilder<'_>) -> f64 {
    needed_share(spacing, sim).map_or(1.0, |share| (MOST / share).min(1.0).sqrt())
}

/// Share of the damping that a body of that spacing, m, needs; none where it takes no sub-steps.
fn needed_share(spacing: f64, sim: &SimBuilder<'_>) -> Option<f64> {
    if sim.scene().time.sub_steps <= 1 {
        return None;
    }
    let flow = sim.bodies().iter().find(|body| matches!(body.material.law, Law::Fluid(_)))?;
    let share = if has_suction(sim) { SHARE_WITH_SUCTION } else { SHARE };
    Some(share * (flow.spacing / spacing).max(1.0))
}
