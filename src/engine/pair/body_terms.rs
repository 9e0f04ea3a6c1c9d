//! The pair terms of a body, and the force of each.

use glam::DVec3;

use crate::world::BodyId;

/// Largest number of pair terms on one body.
pub(super) const MAX_TERMS: usize = 8;

/// The terms of one body, and the force of each on every particle of it: row by row, one entry a term. The
/// forces are computed in every step, so no checkpoint holds them.
pub(crate) struct BodyTerms {
    pub id: BodyId,
    pub terms: Vec<usize>,
    pub forces: Vec<DVec3>,
}
