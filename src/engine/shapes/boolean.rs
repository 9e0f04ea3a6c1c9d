//! Boolean combinations of regions: union, intersection, difference.

use glam::DVec3;

use super::region::{Aabb, Region};

type Part = Box<dyn Region>;

/// Cells that the faces of boxes may make before the volume is integrated numerically.
const MAX_BOX_CELLS: usize = 200_000;

/// What is in any of the parts.
pub(super) struct Union {
    pub parts: Vec<Part>,
    pub axes: usize,
}

/// What is in all of the parts.
pub(super) struct Intersection {
    pub parts: Vec<Part>,
    pub axes: usize,
}

/// What is in the first part, but not inside the second.
pub(super) struct Difference {
    pub whole: Part,
    pub hole: Part,
    pub axes: usize,
}

impl Region for Union {
    fn distance(&self, point: DVec3) -> f64 {
        self.parts.iter().map(|part| part.distance(point)).fold(f64::INFINITY, f64::min)
    }

    fn bounds(&self) -> Aabb {
        let first = self.parts[0].bounds();
        self.parts.iter().fold(first, |bounds, part| bounds.union(&part.bounds()))
    }

    fn volume(&self) -> Option<f64> {
        let bounds: Vec<Aabb> = self.parts.iter().map(|part| part.bounds()).collect();
        let apart =
            (0..bounds.len()).all(|i| bounds[..i].iter().all(|other| other.is_apart(&bounds[i], self.axes)));
        if apart {
            self.parts.iter().map(|part| part.volume()).sum()
        } else {
            volume_of_boxes(self, self.axes)
        }
    }

    fn frame(&self) -> Aabb {
        self.parts[0].frame()
    }

    fn box_faces(&self, faces: &mut [Vec<f64>; 3]) -> bool {
        self.parts.iter().all(|part| part.box_faces(faces))
    }
}

impl Region for Intersection {
    fn distance(&self, point: DVec3) -> f64 {
        self.parts.iter().map(|part| part.distance(point)).fold(f64::NEG_INFINITY, f64::max)
    }

    fn bounds(&self) -> Aabb {
        let first = self.parts[0].bounds();
        self.parts.iter().fold(first, |bounds, part| bounds.intersection(&part.bounds()))
    }

    fn volume(&self) -> Option<f64> {
        if self.parts.len() == 1 { self.parts[0].volume() } else { volume_of_boxes(self, self.axes) }
    }

    fn frame(&self) -> Aabb {
        self.parts[0].frame()
    }

    fn box_faces(&self, faces: &mut [Vec<f64>; 3]) -> bool {
        self.parts.iter().all(|part| part.box_faces(faces))
    }
}

impl Region for Difference {
    fn distance(&self, point: DVec3) -> f64 {
        self.whole.distance(point).max(-self.hole.distance(point))
    }

    fn bounds(&self) -> Aabb {
        self.whole.bounds()
    }

    fn volume(&self) -> Option<f64> {
        let hole = self.hole.bounds();
        if self.whole.bounds().is_apart(&hole, self.axes) {
            return self.whole.volume();
        }
        if holds(self.whole.as_ref(), &hole, self.axes) {
            return Some(self.whole.volume()? - self.hole.volume()?);
        }
        volume_of_boxes(self, self.axes)
    }

    fn frame(&self) -> Aabb {
        self.whole.frame()
    }

    fn box_faces(&self, faces: &mut [Vec<f64>; 3]) -> bool {
        self.whole.box_faces(faces) && self.hole.box_faces(faces)
    }
}

/// Whether `region` is known to hold all of `part`: it is a single box that does, or a ball about `part` is inside.
fn holds(region: &dyn Region, part: &Aabb, axes: usize) -> bool {
    let mut faces = [Vec::new(), Vec::new(), Vec::new()];
    if region.box_faces(&mut faces) && faces[0].len() == 2 {
        return (0..axes).all(|k| faces[k][0] <= part.min[k] && part.max[k] <= faces[k][1]);
    }
    region.distance(part.center()) <= -0.5 * part.extent().length()
}

/// Volume of a region made of boxes along the axes: all their faces cut space into cells that are in or out as a whole.
fn volume_of_boxes(region: &dyn Region, axes: usize) -> Option<f64> {
    let mut faces = [Vec::new(), Vec::new(), Vec::new()];
    if !region.box_faces(&mut faces) {
        return None;
    }
    for coordinates in &mut faces {
        coordinates.sort_by(f64::total_cmp);
        coordinates.dedup();
    }
    if axes == 2 {
        faces[2] = vec![-0.5, 0.5];
    }
    if faces.iter().map(|coordinates| coordinates.len()).product::<usize>() > MAX_BOX_CELLS {
        return None;
    }
    let mut volume = 0.0;
    for x in faces[0].windows(2) {
        for y in faces[1].windows(2) {
            for z in faces[2].windows(2) {
                let center = 0.5 * DVec3::new(x[0] + x[1], y[0] + y[1], z[0] + z[1]);
                if region.distance(center) < 0.0 {
                    volume += (x[1] - x[0]) * (y[1] - y[0]) * (z[1] - z[0]);
                }
            }
        }
    }
    Some(volume)
}
