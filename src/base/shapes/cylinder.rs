//! Circular cylinders with flat ends, solid (`Cylinder`) or hollow (`Tube`).

use std::f64::consts::PI;

use glam::DVec3;

use super::moments::Moments;
use super::region::{Aabb, Region, capped};
use super::rings::Rings;
use super::surface::{Facing, Surface, SurfacePoint, behind_all, circle};
use crate::linalg::Sym3;

/// A circular cylinder with flat ends; `inner` is 0 for a solid cylinder.
pub(super) struct Cylinder {
    pub from: DVec3,
    pub to: DVec3,
    pub inner: f64,
    pub outer: f64,
}

impl Region for Cylinder {
    fn distance(&self, point: DVec3) -> f64 {
        let half = 0.5 * (self.to - self.from);
        let length = half.length();
        let axis = half / length;
        let from_middle = point - self.from - half;
        let along = from_middle.dot(axis);
        let r = (from_middle - along * axis).length();
        let bore = if self.inner > 0.0 { self.inner - r } else { f64::NEG_INFINITY };
        capped((r - self.outer).max(bore), along.abs() - length)
    }

    fn bounds(&self) -> Aabb {
        let axis = (self.to - self.from).normalize();
        let reach = self.outer * (DVec3::ONE - axis * axis).max(DVec3::ZERO).map(f64::sqrt);
        Aabb { min: self.from.min(self.to) - reach, max: self.from.max(self.to) + reach }
    }

    fn volume(&self) -> Option<f64> {
        let area = PI * (self.outer - self.inner) * (self.outer + self.inner);
        Some(area * self.from.distance(self.to))
    }

    fn walls(&self) -> Vec<(&'static str, f64)> {
        let across = if self.inner > 0.0 { self.outer - self.inner } else { 2.0 * self.outer };
        vec![("the axis", self.from.distance(self.to)), ("the radius", across)]
    }

    fn rings(&self) -> Option<Rings> {
        Some(Rings::Axial { from: self.from, to: self.to, inner: self.inner, outer: self.outer })
    }
}

impl Surface for Cylinder {
    fn closest(&self, point: DVec3) -> SurfacePoint {
        let half = 0.5 * (self.to - self.from);
        let length = half.length();
        let axis = half / length;
        let from_middle = point - self.from - half;
        let along = from_middle.dot(axis);
        let arm = from_middle - along * axis;
        let radial = arm.try_normalize().unwrap_or_else(|| axis.any_orthonormal_vector());
        let mut side = Facing { normal: radial, distance: arm.length() - self.outer };
        if self.inner > 0.0 {
            side = side.outermost(Facing { normal: -radial, distance: self.inner - arm.length() });
        }
        let end = Facing { normal: if along < 0.0 { -axis } else { axis }, distance: along.abs() - length };
        behind_all(point, &[side, end])
    }

    fn edges(&self, piece: f64) -> Vec<[DVec3; 2]> {
        let axis = (self.to - self.from).normalize();
        let mut edges = Vec::new();
        for end in [self.from, self.to] {
            for radius in [self.outer, self.inner].into_iter().filter(|radius| *radius > 0.0) {
                edges.extend(circle(end, axis, radius, piece));
            }
        }
        edges
    }

    fn moments(&self) -> Option<Moments> {
        let volume = self.volume()?;
        let length = self.from.distance(self.to);
        let along = Sym3::dyad((self.to - self.from) / length);
        let across = 0.25 * (self.inner.powi(2) + self.outer.powi(2));
        let second = (Sym3::IDENTITY - along) * (volume * across) + along * (volume * length * length / 12.0);
        Some(Moments { volume, center: 0.5 * (self.from + self.to), second })
    }
}
