//! A vertex of a skin in a step, and how it acts on a particle.

use glam::{DMat3, DVec3};

use super::scale::Scale;

/// A vertex of the patch in this step.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Vertex {
    /// Where it is, m.
    pub place: DVec3,
    /// Its velocity at mid-step, m/s.
    pub velocity: DVec3,
    /// Deformation gradient, and its rate at mid-step, 1/s; if asked for.
    pub gradient: DMat3,
    pub rate: DMat3,
    /// Inverse mass of the layer of particles there under a traction along each axis, m2/kg; if requested.
    pub mobility: DVec3,
    /// Whether all that carries it is there.
    pub is_there: bool,
    /// Scale of its shares, if they follow the deformation.
    pub(super) scale: Scale,
}

/// A vertex by which a force reaches a particle.
#[derive(Clone, Copy, Debug)]
pub(super) struct End {
    pub arm: DVec3,
    pub weight: f64,
    pub particle: u32,
    /// Number of the vertex in the patch.
    pub vertex: u32,
    /// Number of the map by which the particle is an image.
    pub map: u32,
}
