//! A body between the scene and the world: its particles are placed, its columns not yet made.

use std::ops::Range;

use crate::materials::Material;
use crate::scene::Vec3;
use crate::shapes::{Aabb, Site};
use crate::world::{BodyId, PhaseId};

/// A body whose particles are placed.
#[derive(Clone)]
pub struct BodyPlan {
    /// Index in the scene.
    pub id: BodyId,
    /// Name in the scene.
    pub name: String,
    /// Phase of its formulation.
    pub phase: PhaseId,
    /// Name of its formulation.
    pub formulation: &'static str,
    /// Rows in the phase.
    pub rows: Range<usize>,
    /// Distance of neighbouring particles, m.
    pub spacing: f64,
    /// Name of its material in the scene.
    pub material_name: String,
    /// Material.
    pub material: Material,
    /// Places and volumes of the particles, in row order.
    pub sites: Vec<Site>,
    /// Box around its shape, m.
    pub bounds: Aabb,
    /// Velocity at the start, m/s.
    pub velocity: Option<Vec3>,
}
