//! Bodies of a scene as contact sees them.

use crate::materials::{ElasticConstants, Law};
use crate::plugin::{BodyKind, BodyPlan, SimBuilder};
use crate::world::BodyId;

/// The body of that name.
pub(super) fn find<'s>(sim: &'s SimBuilder<'_>, name: &str) -> &'s BodyPlan {
    let k = sim.bodies().iter().position(|body| body.name == name);
    // Names of bodies are checked with the scene.
    sim.body(BodyId(k.unwrap_or(0)))
}

pub(super) fn is_rigid(body: &BodyPlan) -> bool {
    body.kind == BodyKind::Rigid
}

/// The elastic constants of a body; none where nothing deforms it.
pub(super) fn elastic_of(body: &BodyPlan) -> Option<&ElasticConstants> {
    match &body.material.law {
        Law::Solid(law) => Some(law.elastic()),
        Law::Fluid(_) | Law::Nothing => None,
    }
}
