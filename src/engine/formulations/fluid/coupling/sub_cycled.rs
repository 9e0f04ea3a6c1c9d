//! Damping of bodies that take sub-steps beside a fluid, against vibrations driven by its frozen force.

use crate::formulations::fluid::walls::has_suction;
use crate::materials::Law;
use crate::plugin::{BodyKind, SimBuilder};
use crate::scene::StepRule;
use crate::solids::DampedSubSteps;
use crate::world::{BodyId, BodySet};

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
/// Largest share of a body that touches nothing: the leapfrog of the sub-steps, 0.65 of the stable ones, is
/// stable up to 0.68.
const MOST: f64 = 0.65;
/// The same of others, and with steps longer than the stable ones: bonds and contacts together may take 0.9
/// of those, which leaves room for 0.22.
const MOST_IN_CONTACT: f64 = 0.2;

/// Asks for the damping of all deformable bodies of a scene with fluids, if they may take sub-steps.
pub fn damp_sub_cycled_bodies(sim: &mut SimBuilder<'_>) {
    let soft = sim.bodies().iter().filter(|body| body.kind == BodyKind::Solid);
    let soft: Vec<_> = soft.map(|body| body.id).collect();
    for id in soft {
        if let Some((needed, most)) = share_of(id, sim) {
            let damping = DampedSubSteps { share: needed.min(most) };
            sim.extend_bodies(BodySet::new([id]), "damping of its sub-steps", damping);
        }
    }
}

/// What remains of the long step beside a deformable body. The growth falls with the square of the step:
/// where the share would be too large the step is smaller.
pub fn share_of_long_step(id: BodyId, sim: &SimBuilder<'_>) -> f64 {
    share_of(id, sim).map_or(1.0, |(needed, most)| (most / needed).min(1.0).sqrt())
}

/// Share of the damping that a body needs, and the largest one; none where it takes no sub-steps.
fn share_of(id: BodyId, sim: &SimBuilder<'_>) -> Option<(f64, f64)> {
    let time = &sim.scene().time;
    if time.sub_steps <= 1 {
        return None;
    }
    let flow = sim.bodies().iter().find(|body| matches!(body.material.law, Law::Fluid(_)))?;
    let body = sim.body(id);
    let share = if has_suction(sim) { SHARE_WITH_SUCTION } else { SHARE };
    let is_long = matches!(time.step, StepRule::Adaptive { factor } if factor > 1.0);
    let has_room = !is_long && !sim.touching_pairs().names(&body.name);
    let most = if has_room { MOST } else { MOST_IN_CONTACT };
    Some((share * (flow.spacing / body.spacing).max(1.0), most))
}
