//! Polygons in the plane, and the prisms over them (`Extrusion`).

use glam::{DVec2, DVec3};

use super::error::FillErrorKind;
use super::moments::Moments;
use super::region::{Aabb, Region, capped};
use super::surface::{Facing, Surface, SurfacePoint, behind_all};
use crate::linalg::Sym3;

/// A simple polygon in the x-y plane.
pub(super) struct Polygon {
    corners: Vec<DVec2>,
}

/// A prism over a polygon between two heights.
pub(super) struct Extrusion {
    pub polygon: Polygon,
    pub from: f64,
    pub to: f64,
}

impl Polygon {
    /// Checks that all edges have a positive length and meet only at shared corners.
    pub fn new(points: &[(f64, f64)]) -> Result<Self, FillErrorKind> {
        let corners: Vec<DVec2> = points.iter().map(|&(x, y)| DVec2::new(x, y)).collect();
        let n = corners.len();
        if n < 3 {
            return Err(FillErrorKind::FewPoints(n));
        }
        for i in 0..n {
            let next = (i + 1) % n;
            if corners[i] == corners[next] {
                return Err(FillErrorKind::EqualPoints(i, next));
            }
        }
        let polygon = Self { corners };
        for i in 0..n {
            for j in i + 1..n {
                if polygon.edges_meet(i, j) {
                    return Err(FillErrorKind::Crossing(i, j));
                }
            }
        }
        Ok(polygon)
    }

    fn edge(&self, i: usize) -> (DVec2, DVec2) {
        (self.corners[i], self.corners[(i + 1) % self.corners.len()])
    }

    fn edges_meet(&self, i: usize, j: usize) -> bool {
        let n = self.corners.len();
        let ((a, b), (c, d)) = (self.edge(i), self.edge(j));
        if (i + 1) % n == j {
            return folds_back(b - a, d - c);
        }
        if (j + 1) % n == i {
            return folds_back(d - c, b - a);
        }
        let side = |p: DVec2, q: DVec2, r: DVec2| (q - p).perp_dot(r - p);
        let within = |p: DVec2, q: DVec2, r: DVec2| r.cmpge(p.min(q)).all() && r.cmple(p.max(q)).all();
        let (c_side, d_side) = (side(a, b, c), side(a, b, d));
        let (a_side, b_side) = (side(c, d, a), side(c, d, b));
        (c_side * d_side < 0.0 && a_side * b_side < 0.0)
            || (c_side == 0.0 && within(a, b, c))
            || (d_side == 0.0 && within(a, b, d))
            || (a_side == 0.0 && within(c, d, a))
            || (b_side == 0.0 && within(c, d, b))
    }

    /// Twice the signed area, positive for counter-clockwise corners.
    fn twice_area(&self) -> f64 {
        // Coordinates are relative to a corner, because far from the origin the products would cancel.
        let origin = self.corners[0];
        (0..self.corners.len())
            .map(|i| {
                let (a, b) = self.edge(i);
                (a - origin).perp_dot(b - origin)
            })
            .sum()
    }

    fn moments(&self) -> Moments {
        let origin = self.corners[0];
        let triangle = |i: usize| {
            let (a, b) = self.edge(i);
            let (a, b) = (a - origin, b - origin);
            (0.5 * a.perp_dot(b), [a.extend(0.0), b.extend(0.0), DVec3::ZERO])
        };
        Moments::of_simplices(origin.extend(0.0), 2, (0..self.corners.len()).map(triangle))
    }

    fn area(&self) -> f64 {
        0.5 * self.twice_area().abs()
    }

    fn distance(&self, point: DVec2) -> f64 {
        let mut nearest = f64::INFINITY;
        let mut inside = false;
        for i in 0..self.corners.len() {
            let (a, b) = self.edge(i);
            let edge = b - a;
            let part = ((point - a).dot(edge) / edge.length_squared()).clamp(0.0, 1.0);
            nearest = nearest.min(point.distance_squared(a + part * edge));
            if (a.y > point.y) != (b.y > point.y) && point.x < a.x + (point.y - a.y) / edge.y * edge.x {
                inside = !inside;
            }
        }
        if inside { -nearest.sqrt() } else { nearest.sqrt() }
    }

    /// The outward normal at the nearest point of the outline, and the distance along it.
    fn facing(&self, point: DVec2) -> Facing {
        let n = self.corners.len();
        let turn = if self.twice_area() > 0.0 { 1.0 } else { -1.0 };
        let normal = |i: usize| {
            let (a, b) = self.edge(i);
            -turn * (b - a).perp().normalize()
        };
        let mut nearest = (f64::INFINITY, 0, 0.0);
        for i in 0..n {
            let (a, b) = self.edge(i);
            let edge = b - a;
            let part = ((point - a).dot(edge) / edge.length_squared()).clamp(0.0, 1.0);
            let distance = point.distance_squared(a + part * edge);
            if distance < nearest.0 {
                nearest = (distance, i, part);
            }
        }
        let (_, i, part) = nearest;
        if part > 0.0 && part < 1.0 {
            let distance = (point - self.corners[i]).dot(normal(i));
            return Facing { normal: normal(i).extend(0.0), distance };
        }
        // At a corner the point is outside if it is in front of the mean of both edges.
        let corner = if part == 0.0 { i } else { (i + 1) % n };
        let mean = (normal(corner) + normal((corner + n - 1) % n)).normalize();
        let arm = point - self.corners[corner];
        let sign = if arm.dot(mean) < 0.0 { -1.0 } else { 1.0 };
        let direction = arm.try_normalize().map_or(mean, |direction| sign * direction);
        Facing { normal: direction.extend(0.0), distance: sign * arm.length() }
    }

    fn bounds(&self) -> (DVec2, DVec2) {
        let first = self.corners[0];
        self.corners.iter().fold((first, first), |(min, max), &corner| (min.min(corner), max.max(corner)))
    }
}

fn folds_back(edge: DVec2, next: DVec2) -> bool {
    edge.perp_dot(next) == 0.0 && edge.dot(next) < 0.0
}

impl Region for Polygon {
    fn distance(&self, point: DVec3) -> f64 {
        self.distance(point.truncate())
    }

    fn bounds(&self) -> Aabb {
        let (min, max) = self.bounds();
        Aabb { min: min.extend(0.0), max: max.extend(0.0) }
    }

    fn volume(&self) -> Option<f64> {
        Some(self.area())
    }
}

impl Region for Extrusion {
    fn distance(&self, point: DVec3) -> f64 {
        capped(self.polygon.distance(point.truncate()), (self.from - point.z).max(point.z - self.to))
    }

    fn bounds(&self) -> Aabb {
        let (min, max) = self.polygon.bounds();
        Aabb { min: min.extend(self.from), max: max.extend(self.to) }
    }

    fn volume(&self) -> Option<f64> {
        Some(self.polygon.area() * (self.to - self.from))
    }
}

impl Surface for Polygon {
    fn closest(&self, point: DVec3) -> SurfacePoint {
        self.facing(point.truncate()).foot(point)
    }

    fn edges(&self, _piece: f64) -> Vec<[DVec3; 2]> {
        self.corners.iter().map(|corner| [corner.extend(0.0); 2]).collect()
    }

    fn moments(&self) -> Option<Moments> {
        Some(Polygon::moments(self))
    }
}

impl Surface for Extrusion {
    fn closest(&self, point: DVec3) -> SurfacePoint {
        let side = self.polygon.facing(point.truncate());
        let top = Facing { normal: DVec3::Z, distance: point.z - self.to };
        let end = top.outermost(Facing { normal: -DVec3::Z, distance: self.from - point.z });
        behind_all(point, &[side, end])
    }

    fn edges(&self, _piece: f64) -> Vec<[DVec3; 2]> {
        let mut edges = Vec::new();
        for i in 0..self.polygon.corners.len() {
            let (a, b) = self.polygon.edge(i);
            edges.extend([self.from, self.to].map(|z| [a.extend(z), b.extend(z)]));
            edges.push([a.extend(self.from), a.extend(self.to)]);
        }
        edges
    }

    fn moments(&self) -> Option<Moments> {
        let flat = self.polygon.moments();
        let height = self.to - self.from;
        let volume = flat.volume * height;
        let upright = Sym3::from_diagonal(DVec3::Z) * (volume * height * height / 12.0);
        let center = flat.center + DVec3::Z * (0.5 * (self.from + self.to));
        Some(Moments { volume, center, second: flat.second * height + upright })
    }
}
