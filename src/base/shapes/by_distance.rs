//! The surface of a shape whose nearest points have no closed form, by the gradient of its signed distance.
//!
//! Where the signed distance underestimates the true one, so does the distance of the nearest points. This
//! surface is meant for bodies without contact.

use glam::DVec3;

use super::region::{Aabb, Region};
use super::surface::{Surface, SurfacePoint};

/// Step of the finite difference of the gradient, over the diagonal of the bounding box.
const DIFFERENCE: f64 = 1e-7;

/// A region whose surface is given by its signed distance alone.
pub struct ByDistance(pub Box<dyn Region>);

impl Region for ByDistance {
    fn distance(&self, point: DVec3) -> f64 {
        self.0.distance(point)
    }

    fn bounds(&self) -> Aabb {
        self.0.bounds()
    }

    fn volume(&self) -> Option<f64> {
        self.0.volume()
    }
}

impl Surface for ByDistance {
    fn closest(&self, point: DVec3) -> SurfacePoint {
        let h = DIFFERENCE * self.bounds().extent().length();
        let slope = |axis: DVec3| self.distance(point + h * axis) - self.distance(point - h * axis);
        let gradient = DVec3::new(slope(DVec3::X), slope(DVec3::Y), slope(DVec3::Z));
        let normal = gradient.try_normalize().unwrap_or(DVec3::X);
        let signed_distance = self.distance(point);
        SurfacePoint { point: point - signed_distance * normal, normal, signed_distance }
    }
}
