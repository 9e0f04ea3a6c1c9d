//! Translated, rotated and scaled regions.

use glam::{DQuat, DVec3};

use super::moments::Moments;
use super::region::{Aabb, Region};
use super::rings::Rings;
use super::surface::{Surface, SurfacePoint};

/// A region translated by `by`.
pub(super) struct Translated<R: ?Sized> {
    pub region: Box<R>,
    pub by: DVec3,
}

/// A region rotated by `turn` about the point `about`.
pub(super) struct Rotated<R: ?Sized> {
    pub region: Box<R>,
    pub turn: DQuat,
    pub about: DVec3,
}

/// A region scaled by positive factors from the point `about`; in two dimensions the factor along z is 1.
pub(super) struct Scaled<R: ?Sized> {
    pub region: Box<R>,
    pub by: DVec3,
    pub about: DVec3,
    pub axes: usize,
}

/// The image of a point under a rotation about the point `about`.
pub(super) fn turned(turn: DQuat, about: DVec3, point: DVec3) -> DVec3 {
    about + turn * (point - about)
}

impl<R: Region + ?Sized> Region for Translated<R> {
    fn distance(&self, point: DVec3) -> f64 {
        self.region.distance(point - self.by)
    }

    fn clearance(&self, point: DVec3) -> f64 {
        self.region.clearance(point - self.by)
    }

    fn bounds(&self) -> Aabb {
        let Aabb { min, max } = self.region.bounds();
        Aabb { min: min + self.by, max: max + self.by }
    }

    fn volume(&self) -> Option<f64> {
        self.region.volume()
    }

    fn frame(&self) -> Aabb {
        let Aabb { min, max } = self.region.frame();
        Aabb { min: min + self.by, max: max + self.by }
    }

    fn box_faces(&self, faces: &mut [Vec<f64>; 3]) -> bool {
        let start = [0, 1, 2].map(|k| faces[k].len());
        let made_of_boxes = self.region.box_faces(faces);
        for k in 0..3 {
            faces[k][start[k]..].iter_mut().for_each(|face| *face += self.by[k]);
        }
        made_of_boxes
    }

    fn rings(&self) -> Option<Rings> {
        Some(self.region.rings()?.moved(|x| x + self.by))
    }
}

impl<R: Region + ?Sized> Region for Rotated<R> {
    fn distance(&self, point: DVec3) -> f64 {
        self.region.distance(turned(self.turn.inverse(), self.about, point))
    }

    fn clearance(&self, point: DVec3) -> f64 {
        self.region.clearance(turned(self.turn.inverse(), self.about, point))
    }

    fn bounds(&self) -> Aabb {
        let inner = self.region.bounds();
        if !inner.is_bounded() {
            return Aabb::everything(if inner.extent().z > 0.0 { 3 } else { 2 });
        }
        Aabb::around(inner.corners().map(|corner| turned(self.turn, self.about, corner)))
    }

    fn volume(&self) -> Option<f64> {
        self.region.volume()
    }

    fn rings(&self) -> Option<Rings> {
        Some(self.region.rings()?.moved(|x| turned(self.turn, self.about, x)))
    }
}

impl<R: ?Sized> Scaled<R> {
    /// The point before the scaling.
    fn before(&self, point: DVec3) -> DVec3 {
        self.about + (point - self.about) / self.by
    }

    /// The smallest factor. A distance times it is a lower bound of the distance after the scaling; the sign
    /// is exact.
    fn smallest(&self) -> f64 {
        if self.axes == 3 { self.by.min_element() } else { self.by.truncate().min_element() }
    }
}

impl<R: Region + ?Sized> Region for Scaled<R> {
    fn distance(&self, point: DVec3) -> f64 {
        self.region.distance(self.before(point)) * self.smallest()
    }

    fn clearance(&self, point: DVec3) -> f64 {
        self.region.clearance(self.before(point)) * self.smallest()
    }

    fn bounds(&self) -> Aabb {
        let Aabb { min, max } = self.region.bounds();
        Aabb {
            min: self.about + self.by * (min - self.about),
            max: self.about + self.by * (max - self.about),
        }
    }

    fn volume(&self) -> Option<f64> {
        Some(self.region.volume()? * self.by.element_product())
    }

    fn frame(&self) -> Aabb {
        let Aabb { min, max } = self.region.frame();
        Aabb {
            min: self.about + self.by * (min - self.about),
            max: self.about + self.by * (max - self.about),
        }
    }

    fn box_faces(&self, faces: &mut [Vec<f64>; 3]) -> bool {
        let start = [0, 1, 2].map(|k| faces[k].len());
        let made_of_boxes = self.region.box_faces(faces);
        for k in 0..3 {
            let (by, about) = (self.by[k], self.about[k]);
            faces[k][start[k]..].iter_mut().for_each(|face| *face = about + by * (*face - about));
        }
        made_of_boxes
    }
}

impl<R: Surface + ?Sized> Surface for Translated<R> {
    fn closest(&self, point: DVec3) -> SurfacePoint {
        let found = self.region.closest(point - self.by);
        SurfacePoint { point: found.point + self.by, ..found }
    }

    fn edges(&self, piece: f64) -> Vec<[DVec3; 2]> {
        let edges = self.region.edges(piece).into_iter();
        edges.map(|edge| edge.map(|end| end + self.by)).collect()
    }

    fn moments(&self) -> Option<Moments> {
        Some(self.region.moments()?.translated(self.by))
    }
}

impl<R: Surface + ?Sized> Surface for Rotated<R> {
    fn closest(&self, point: DVec3) -> SurfacePoint {
        let found = self.region.closest(turned(self.turn.inverse(), self.about, point));
        let (point, normal) = (turned(self.turn, self.about, found.point), self.turn * found.normal);
        SurfacePoint { point, normal, ..found }
    }

    fn edges(&self, piece: f64) -> Vec<[DVec3; 2]> {
        let edges = self.region.edges(piece).into_iter();
        edges.map(|edge| edge.map(|end| turned(self.turn, self.about, end))).collect()
    }

    fn moments(&self) -> Option<Moments> {
        Some(self.region.moments()?.rotated(self.turn, self.about))
    }
}

/// Only valid for uniform scaling, which alone preserves nearest points.
impl<R: Surface + ?Sized> Surface for Scaled<R> {
    fn closest(&self, point: DVec3) -> SurfacePoint {
        let found = self.region.closest(self.about + (point - self.about) / self.by);
        SurfacePoint {
            point: self.about + self.by * (found.point - self.about),
            normal: found.normal,
            signed_distance: self.by.x * found.signed_distance,
        }
    }

    fn edges(&self, piece: f64) -> Vec<[DVec3; 2]> {
        let edges = self.region.edges(piece / self.by.x).into_iter();
        edges.map(|edge| edge.map(|end| self.about + self.by * (end - self.about))).collect()
    }

    fn moments(&self) -> Option<Moments> {
        Some(self.region.moments()?.scaled(self.by.x, self.axes, self.about))
    }
}
