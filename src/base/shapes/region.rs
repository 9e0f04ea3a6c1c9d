//! A set of points: the checked form of every shape.

use glam::DVec3;

use super::rings::Rings;

/// An axis-aligned box, given by its corners \[m\].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Aabb {
    /// Corner with the smallest coordinates \[m\].
    pub min: DVec3,
    /// Corner with the largest coordinates \[m\].
    pub max: DVec3,
}

impl Aabb {
    /// The bounding box of `points` \[m\]; without points, an empty box at the origin.
    pub fn around(points: impl IntoIterator<Item = DVec3>) -> Self {
        let of_point = |point| Self { min: point, max: point };
        let all = points.into_iter().map(of_point).reduce(|bounds, point| bounds.union(&point));
        all.unwrap_or(of_point(DVec3::ZERO))
    }

    /// The unbounded box; in two dimensions the plane z = 0.
    pub(super) fn everything(axes: usize) -> Self {
        let far = DVec3::new(f64::INFINITY, f64::INFINITY, if axes == 3 { f64::INFINITY } else { 0.0 });
        Self { min: -far, max: far }
    }

    /// Whether all sides are finite.
    pub fn is_bounded(&self) -> bool {
        self.min.is_finite() && self.max.is_finite()
    }

    /// The box extended by `margin` \[m\] on all sides.
    pub fn grown(&self, margin: f64) -> Self {
        Self { min: self.min - margin, max: self.max + margin }
    }

    /// Lengths of the sides \[m\].
    pub fn extent(&self) -> DVec3 {
        self.max - self.min
    }

    /// The centre \[m\].
    pub fn center(&self) -> DVec3 {
        0.5 * (self.min + self.max)
    }

    /// The bounding box of both.
    pub fn union(&self, other: &Self) -> Self {
        Self { min: self.min.min(other.min), max: self.max.max(other.max) }
    }

    /// The intersection; a box of zero extent where it is empty.
    pub fn intersection(&self, other: &Self) -> Self {
        let min = self.min.max(other.min);
        Self { min, max: self.max.min(other.max).max(min) }
    }

    /// Whether the interiors of the boxes are disjoint, in the first `axes` axes.
    pub(super) fn is_apart(&self, other: &Self, axes: usize) -> bool {
        (0..axes).any(|k| self.max[k] <= other.min[k] || other.max[k] <= self.min[k])
    }

    /// Whether the boxes intersect or touch.
    pub(super) fn touches(&self, other: &Self) -> bool {
        self.min.cmple(other.max).all() && other.min.cmple(self.max).all()
    }

    /// The largest distance of a point outside from the planes of the faces that it is in front of \[m\], no
    /// more than that from the box; zero or less for one inside.
    pub(super) fn gap(&self, point: DVec3) -> f64 {
        (self.min - point).max(point - self.max).max_element()
    }

    /// The eight corners \[m\].
    pub(super) fn corners(&self) -> [DVec3; 8] {
        std::array::from_fn(|n| {
            let pick = |k: usize| if n >> k & 1 == 0 { self.min[k] } else { self.max[k] };
            DVec3::new(pick(0), pick(1), pick(2))
        })
    }
}

/// A set of points with its boundary. In two dimensions the points lie in z = 0 and a volume is an area
/// \[m²\].
pub trait Region: Send + Sync {
    /// Signed distance from `point` to the boundary \[m\], negative inside. The sign is exact, and the
    /// magnitude never exceeds the true distance (boolean combinations may underestimate it).
    fn distance(&self, point: DVec3) -> f64;

    /// The signed distance with openings, where a face of a hole coincides with one of the body it is cut out
    /// of: in front of an opening it is the distance from the material beside it. Elsewhere it equals
    /// [`Region::distance`].
    fn clearance(&self, point: DVec3) -> f64 {
        self.distance(point)
    }

    /// A box that contains the region; it is the smallest one except for rotated shapes and combinations.
    fn bounds(&self) -> Aabb;

    /// Volume \[m³\], in two dimensions area \[m²\], where it has a closed form.
    fn volume(&self) -> Option<f64>;

    /// Whether `point` is inside or on the boundary. Points closer to the boundary than 1e-9 of the diagonal
    /// of the bounding box (without one, of the distance from the origin) are on it, so that round-off has no
    /// influence.
    fn contains(&self, point: DVec3) -> bool {
        let tolerance = self.tolerance();
        self.distance(point) <= if tolerance.is_finite() { tolerance } else { 1e-9 * point.length() }
    }

    /// The distance below which a point counts as on the boundary \[m\].
    fn tolerance(&self) -> f64 {
        1e-9 * self.bounds().extent().length()
    }

    /// The box whose sides the cells of a lattice divide evenly; for a combination that of its first shape.
    fn frame(&self) -> Aabb {
        self.bounds()
    }

    /// The box that the cells of a wall of this region divide evenly, if it has box-shaped cavities that
    /// [`Region::frame`] does not fit.
    fn wall_frame(&self, _spacing: f64) -> Option<Aabb> {
        None
    }

    /// Wall thicknesses that do not follow from the bounding box, with the name of their direction \[m\].
    fn walls(&self) -> Vec<(&'static str, f64)> {
        Vec::new()
    }

    /// Interval along an axis \[m\] in which the region certainly fills the whole cross-section of a box.
    fn slab(&self, axis: usize, within: &Aabb) -> Option<[f64; 2]> {
        let mut faces = [Vec::new(), Vec::new(), Vec::new()];
        if !self.box_faces(&mut faces) || faces[0].len() != 2 {
            return None;
        }
        let fills =
            |k: usize| faces[k].is_empty() || faces[k][0] <= within.min[k] && within.max[k] <= faces[k][1];
        (0..3).all(|k| k == axis || fills(k)).then(|| [faces[axis][0], faces[axis][1]])
    }

    /// Appends the coordinates of the faces and returns true if the region consists of axis-aligned boxes
    /// alone.
    fn box_faces(&self, _faces: &mut [Vec<f64>; 3]) -> bool {
        false
    }

    /// Appends the coordinates of the faces of the cavities of this region, and returns true if all cavities
    /// consist of axis-aligned boxes.
    fn cavity_faces(&self, _faces: &mut [Vec<f64>; 3]) -> bool {
        true
    }

    /// The rings or shells of a concentric lattice, for shapes that have them.
    fn rings(&self) -> Option<Rings> {
        None
    }
}

/// Signed distance to a prism with flat ends, from the signed distances to its lateral surface and to its
/// ends \[m\].
pub(super) fn capped(side: f64, ends: f64) -> f64 {
    side.max(ends).min(0.0) + side.max(0.0).hypot(ends.max(0.0))
}

/// Direction of the gradient of a distance \[m\] at a point, by differences over `step` \[m\]: the outward
/// normal of the nearest surface, where it is that from a [`Region`].
pub fn normal(distance: impl Fn(DVec3) -> f64, point: DVec3, step: f64, axes: usize) -> DVec3 {
    let slope = |axis: DVec3| distance(point + step * axis) - distance(point - step * axis);
    DVec3::AXES[..axes].iter().map(|&axis| slope(axis) * axis).sum::<DVec3>().normalize_or_zero()
}
