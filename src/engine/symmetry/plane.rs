//! Symmetry planes of a scene.

use super::map::Map;
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

/// The maps to the images that planes make, beginning with the one that changes nothing: each plane, and planes at right angles together.
pub fn images<'a>(planes: impl Iterator<Item = &'a MirrorPlane>) -> Vec<Map> {
    let mut all: Vec<(Map, [bool; 3])> = vec![(Map::IDENTITY, [false; 3])];
    for plane in planes {
        for (mirror, mut axes) in all.clone() {
            if !std::mem::replace(&mut axes[plane.axis], true) {
                all.push((Map::mirror(plane.axis, plane.at).after(mirror), axes));
            }
        }
    }
    all.into_iter().map(|(mirror, _)| mirror).collect()
}

impl SimBuilder<'_> {
    /// The symmetry planes of the scene.
    pub fn mirror_planes(&self) -> Vec<MirrorPlane> {
        self.extensions::<MirrorPlane>().cloned().collect()
    }
}
