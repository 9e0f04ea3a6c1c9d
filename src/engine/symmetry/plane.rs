//! Symmetry planes of a scene.

use super::repeats::Repeat;
use crate::plugin::SimBuilder;
use crate::world::BodySet;

/// A symmetry plane of some bodies; the condition `Symmetry` adds it.
#[derive(Clone, Debug)]
pub struct MirrorPlane {
    /// Axis that the plane is normal to.
    pub axis: usize,
    /// Coordinate of the plane, m.
    pub at: f64,
    /// Bodies that end at it.
    pub bodies: BodySet,
}

impl From<&MirrorPlane> for Repeat {
    fn from(plane: &MirrorPlane) -> Self {
        Self::Mirror { axis: plane.axis, at: plane.at }
    }
}

impl SimBuilder<'_> {
    /// The symmetry planes of the scene.
    pub fn mirror_planes(&self) -> Vec<MirrorPlane> {
        self.extensions::<MirrorPlane>().cloned().collect()
    }
}
