//! Bodies of a scene as contact sees them.

use crate::materials::{ElasticConstants, Law};
use crate::plugin::{BodyKind, BodyPlan};

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
