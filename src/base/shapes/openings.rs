//! Distances through the openings of holes. Where a face of a hole coincides with one of the body it is cut
//! out of, as at the ends of a pipe or where a second hole begins, there is no material between the two: the
//! nearest material is beside the opening, on either side. At the edge of a hole the distance is that from
//! the edge, not from the nearer one of its two faces.

use glam::DVec3;

use super::difference::DifferenceRegion;
use super::region::{Region, normal};
use super::shape::Shape;

/// Maximum distance of coincident faces, over the extent of the hole.
const COMMON: f64 = 1e-9;

/// Minimum cosine of the angle between the normals of two faces that meet in an edge; opposite normals are
/// those of a thin part.
const SHARP: f64 = -0.9;

/// Step across a face that is certainly on its other side, over the extent of the hole.
const BESIDE: f64 = 1e-6;

/// Halvings of the way to where a face is as near as an opening.
const HALVINGS: usize = 6;

impl<R: Region + ?Sized> DifferenceRegion<R> {
    /// Distance of a `point` from the remaining material of the whole, if the nearest face is an opening;
    /// `of_whole` and `of_hole` are its distances from the whole and from the hole \[m\].
    pub(super) fn through_opening(&self, point: DVec3, of_whole: f64, of_hole: f64) -> Option<f64> {
        let extent = self.hole.bounds().extent().max_element();
        if (of_whole - of_hole).abs() > COMMON * extent {
            return None;
        }
        let out = normal(|x| self.whole.distance(x), point, BESIDE * extent, self.axes);
        let (foot, depth) = (point - of_whole * out, of_whole.abs());
        let in_hole = |x: DVec3| -self.hole.distance(x);
        let outside = |x: DVec3| self.whole.clearance(x);
        let is_open =
            in_hole(foot - BESIDE * extent * out) > 0.0 && outside(foot + BESIDE * extent * out) > 0.0;
        if !is_open {
            return None;
        }
        let search = OpeningSearch { reach: 0.5 * extent, step: BESIDE * extent, axes: self.axes };
        let within = search.beside(in_hole, foot, -out).distance(-out, -of_whole, depth);
        let beyond = search.beside(outside, foot, out).distance(out, of_whole, depth);
        // The opening is nearer than any face.
        Some(within.min(beyond).clamp(depth, depth.hypot(search.reach)))
    }

    /// Distance of a `point` outside of the whole by `of_whole` and inside of the hole by `in_hole` \[m\],
    /// where the edge between the two faces is nearest; `None` where one of the faces is.
    pub(super) fn distance_to_edge(&self, point: DVec3, of_whole: f64, in_hole: f64) -> Option<f64> {
        let step = BESIDE * self.hole.bounds().extent().max_element();
        let faces = [
            normal(|x| self.whole.distance(x), point, step, self.axes),
            normal(|x| -self.hole.distance(x), point, step, self.axes),
        ];
        let cos = faces[0].dot(faces[1]);
        let is_edge = cos > SHARP && in_hole > of_whole * cos && of_whole > in_hole * cos && cos < 1.0;
        is_edge.then(|| from_edge(of_whole, in_hole, cos))
    }
}

/// Search for the material beside an opening, on one side of it.
struct OpeningSearch {
    /// Longest way from the opening \[m\].
    reach: f64,
    /// Step of differences \[m\].
    step: f64,
    axes: usize,
}

/// Material beside a ray from the foot of a point on an opening.
struct MaterialBeside {
    /// Distance of the foot from the plane of the nearest face \[m\]; infinite where there is none.
    distance: f64,
    /// Normal of that face, none where the face is the end of the hole.
    normal: Option<DVec3>,
}

impl OpeningSearch {
    /// The material beside the ray from `foot` along `inward`: the face that is nearest where it is as near
    /// as the opening.
    fn beside(&self, distance: impl Fn(DVec3) -> f64, foot: DVec3, inward: DVec3) -> MaterialBeside {
        let at = |way: f64| distance(foot + way * inward);
        let is_opening = |way: f64, found: f64| found >= 0.99 * way;
        let (mut way, mut farthest) = (1e-3 * self.reach, f64::MIN_POSITIVE);
        let mut before = 0.0;
        loop {
            let found = at(way);
            farthest = farthest.max(found);
            if !is_opening(way, found) {
                break;
            }
            if way > self.reach {
                return MaterialBeside { distance: f64::INFINITY, normal: None };
            }
            before = way;
            way *= 2.0;
        }
        for _ in 0..HALVINGS {
            let middle = 0.5 * (before + way);
            let found = at(middle);
            farthest = farthest.max(found);
            *(if is_opening(middle, found) { &mut before } else { &mut way }) = middle;
        }
        let normal = normal(&distance, foot + way * inward, self.step, self.axes);
        let rise = normal.dot(inward);
        if rise.abs() > -SHARP {
            return MaterialBeside { distance: farthest, normal: None };
        }
        MaterialBeside { distance: at(way) - rise * way, normal: Some(normal) }
    }
}

impl MaterialBeside {
    /// Distance of a point from this material, which is on the side of the opening in the direction `inward`
    /// \[m\]; the point is `within` that side by so much, negative on the other one, and `depth` from the
    /// opening.
    fn distance(&self, inward: DVec3, within: f64, depth: f64) -> f64 {
        let Some(normal) = self.normal else {
            return if within > 0.0 { self.distance } else { depth.hypot(self.distance) };
        };
        let cos = -normal.dot(inward);
        let off = self.distance - cos * within;
        if -within <= off * cos { off } else { from_edge(-within, off, cos) }
    }
}

/// Distance of a point from the edge of two planes, from which its distances are `first` and `second`, and
/// whose normals have the cosine `cos`.
fn from_edge(first: f64, second: f64, cos: f64) -> f64 {
    let square = first * first + second * second - 2.0 * first * second * cos;
    (square / (1.0 - cos * cos)).sqrt()
}

impl Shape {
    /// The same set of points, with the parts of every hole that is a union cut out one by one: parts that
    /// touch open into each other.
    #[must_use]
    pub fn cut_part_by_part(&self) -> Self {
        let inner = |shape: &Self| Box::new(shape.cut_part_by_part());
        let all = |shapes: &[Self]| shapes.iter().map(Self::cut_part_by_part).collect();
        match self {
            Self::Difference(whole, hole) => {
                hole.parts().into_iter().fold(whole.cut_part_by_part(), |whole, part| {
                    Self::Difference(Box::new(whole), Box::new(part))
                })
            }
            Self::Union(shapes) => Self::Union(all(shapes)),
            Self::Intersection(shapes) => Self::Intersection(all(shapes)),
            Self::Translate { shape, by } => Self::Translate { shape: inner(shape), by: *by },
            Self::Rotate { shape, axis, angle_degrees, about } => Self::Rotate {
                shape: inner(shape),
                axis: *axis,
                angle_degrees: *angle_degrees,
                about: *about,
            },
            Self::Scale { shape, by, about } => Self::Scale { shape: inner(shape), by: *by, about: *about },
            single => single.clone(),
        }
    }

    /// Shapes whose union is this one.
    fn parts(&self) -> Vec<Self> {
        let of = |shape: &Self, moved: &dyn Fn(Box<Self>) -> Self| -> Vec<Self> {
            shape.parts().into_iter().map(|part| moved(Box::new(part))).collect()
        };
        match self {
            Self::Union(shapes) => shapes.iter().flat_map(Self::parts).collect(),
            Self::Translate { shape, by } => of(shape, &|shape| Self::Translate { shape, by: *by }),
            Self::Rotate { shape, axis, angle_degrees, about } => of(shape, &|shape| Self::Rotate {
                shape,
                axis: *axis,
                angle_degrees: *angle_degrees,
                about: *about,
            }),
            Self::Scale { shape, by, about } => {
                of(shape, &|shape| Self::Scale { shape, by: *by, about: *about })
            }
            single => vec![single.cut_part_by_part()],
        }
    }
}
