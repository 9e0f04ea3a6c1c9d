//! Rings: the region between two concentric circles, in two dimensions.

use std::f64::consts::PI;

use glam::DVec3;

use super::moments::Moments;
use super::region::{Aabb, Region};
use super::rings::Rings;
use super::surface::{Surface, SurfacePoint, closest_between};
use crate::linalg::Sym3;

/// The region between two concentric circles in z = 0.
pub(super) struct Ring {
    pub center: DVec3,
    pub inner: f64,
    pub outer: f64,
}

impl Region for Ring {
    fn distance(&self, point: DVec3) -> f64 {
        let r = point.distance(self.center);
        (r - self.outer).max(self.inner - r)
    }

    fn bounds(&self) -> Aabb {
        let reach = DVec3::new(self.outer, self.outer, 0.0);
        Aabb { min: self.center - reach, max: self.center + reach }
    }

    fn volume(&self) -> Option<f64> {
        Some(PI * (self.outer - self.inner) * (self.outer + self.inner))
    }

    fn walls(&self) -> Vec<(&'static str, f64)> {
        vec![("the radius", self.outer - self.inner)]
    }

    fn rings(&self) -> Option<Rings> {
        Some(Rings::Plane { center: self.center, inner: self.inner, outer: self.outer })
    }
}

impl Surface for Ring {
    fn closest(&self, point: DVec3) -> SurfacePoint {
        closest_between(self.center, self.inner, self.outer, point)
    }

    fn moments(&self) -> Option<Moments> {
        let volume = self.volume()?;
        let square = 0.25 * volume * (self.inner.powi(2) + self.outer.powi(2));
        Some(Moments {
            volume,
            center: self.center,
            second: Sym3::from_diagonal(DVec3::new(square, square, 0.0)),
        })
    }
}
