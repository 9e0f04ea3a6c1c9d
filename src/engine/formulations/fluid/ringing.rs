//! Bodies that take short steps beside a fluid do not ring at what its frozen force feeds.

use crate::formulations::total_lagrangian::{DampedBodies, TotalLagrangian};
use crate::materials::Law;
use crate::plugin::{Formulation, SimBuilder};
use crate::world::BodySet;

/// Asks for the damping of all deformable bodies of a scene with fluids, if they may take short steps.
pub fn damp_ringing(sim: &mut SimBuilder<'_>) {
    let flows = sim.bodies().iter().any(|body| matches!(body.material.law, Law::Fluid(_)));
    let soft = sim.bodies().iter().filter(|body| body.formulation == TotalLagrangian::NAME);
    let soft: Vec<_> = soft.map(|body| body.id).collect();
    if flows && sim.scene().time.sub_steps > 1 && !soft.is_empty() {
        sim.extend(DampedBodies(BodySet::new(soft)));
    }
}
