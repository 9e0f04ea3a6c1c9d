//! Moved, turned and stretched regions.

use glam::{DQuat, DVec3};

use super::region::{Aabb, Region};

/// A region moved by `by`.
pub(super) struct Translated {
    pub region: Box<dyn Region>,
    pub by: DVec3,
}

/// A region turned by `turn` about the point `about`.
pub(super) struct Rotated {
    pub region: Box<dyn Region>,
    pub turn: DQuat,
    pub about: DVec3,
}

/// A region stretched by positive factors from the point `about`; in two dimensions the factor along z is 1.
pub(super) struct Scaled {
    pub region: Box<dyn Region>,
    pub by: DVec3,
    pub about: DVec3,
    pub axes: usize,
}

impl Rotated {
    /// Where the rotation takes a point of the region.
    pub fn apply(turn: DQuat, about: DVec3, point: DVec3) -> DVec3 {
        about + turn * (point - about)
    }
}

impl Region for Translated {
    fn distance(&self, point: DVec3) -> f64 {
        self.region.distance(point - self.by)
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
}

impl Region for Rotated {
    fn distance(&self, point: DVec3) -> f64 {
        self.region.distance(Self::apply(self.turn.inverse(), self.about, point))
    }

    fn bounds(&self) -> Aabb {
        Aabb::around(self.region.bounds().corners().map(|corner| Self::apply(self.turn, self.about, corner)))
    }

    fn volume(&self) -> Option<f64> {
        self.region.volume()
    }
}

impl Region for Scaled {
    fn distance(&self, point: DVec3) -> f64 {
        // The smallest factor makes this a lower bound of the distance; the sign is exact.
        let smallest = if self.axes == 3 { self.by.min_element() } else { self.by.truncate().min_element() };
        self.region.distance(self.about + (point - self.about) / self.by) * smallest
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
