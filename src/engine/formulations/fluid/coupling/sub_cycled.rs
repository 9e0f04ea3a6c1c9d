//! Damping of bodies that take sub-steps beside a fluid, against vibrations driven by its frozen force.

use crate::formulations::fluid::walls::has_suction;
use crate::materials::Law;
use crate::plugin::{BodyKind, SimBuilder};
use crate::solids::DampedSubSteps;
use crate::world::BodySet;

/// Share of the damping. A strip of rubber, four particles of the water beside it thick, rings with 0.02 and
/// is quiet with 0.05.
const SHARE: f64 = 0.1;
/// The same where bodies have suction. Their rate of compression counts both the particles of the body and
/// the adjoint of its pressure, which doubles the stiffness of the fluid beside it: modes that swing to and
/// fro in two steps of the fluid, such as the breathing of a sheet between two layers of water, grow with 0.1
/// for some moduli. With 0.2 none grew, at 2.2 to 40 MPa in steps of 4.5 %.
const SHARE_WITH_SUCTION: f64 = 0.2;

/// Asks for the damping of all deformable bodies of a scene with fluids, if they may take sub-steps.
pub fn damp_sub_cycled_bodies(sim: &mut SimBuilder<'_>) {
    let flows = sim.bodies().iter().any(|body| matches!(body.material.law, Law::Fluid(_)));
    let soft = sim.bodies().iter().filter(|body| body.kind == BodyKind::Solid);
    let soft: Vec<_> = soft.map(|body| body.id).collect();
    if flows && sim.scene().time.sub_steps > 1 && !soft.is_empty() {
        let share = if has_suction(sim) { SHARE_WITH_SUCTION } else { SHARE };
        sim.extend_bodies(BodySet::new(soft), "damping of its sub-steps", DampedSubSteps { share });
    }
}
