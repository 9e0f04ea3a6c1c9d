//! Damping of bodies that take sub-steps beside a fluid, against vibrations driven by its frozen force.

use crate::materials::Law;
use crate::plugin::{BodyKind, SimBuilder};
use crate::solids::DampedSubSteps;
use crate::world::BodySet;

/// Asks for the damping of all deformable bodies of a scene with fluids, if they may take sub-steps.
pub fn damp_sub_cycled_bodies(sim: &mut SimBuilder<'_>) {
    let flows = sim.bodies().iter().any(|body| matches!(body.material.law, Law::Fluid(_)));
    let soft = sim.bodies().iter().filter(|body| body.kind == BodyKind::Solid);
    let soft: Vec<_> = soft.map(|body| body.id).collect();
    if flows && sim.scene().time.sub_steps > 1 && !soft.is_empty() {
        sim.extend_bodies(BodySet::new(soft), "damping of its sub-steps", DampedSubSteps);
    }
}
