//! The surface of a shape, for contact with a tool.

use std::f64::consts::TAU;

use glam::DVec3;

use super::moments::Moments;
use super::region::Region;

/// The nearest point of a surface to a query point.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SurfacePoint {
    /// The nearest point of the surface \[m\].
    pub point: DVec3,
    /// n, unit normal of the surface there, outward \[-\]. At edges and corners it is along the line from
    /// `point` to the query point (reversed from inside); for a query point on them, it is the mean of the
    /// adjacent normals.
    pub normal: DVec3,
    /// Signed distance of the query point, negative inside \[m\].
    pub signed_distance: f64,
}

/// A region with an exact nearest point of its surface. In two dimensions all points have z = 0.
pub trait Surface: Region {
    /// The point of the surface that is nearest to `point`. Among equidistant points the choice is
    /// deterministic.
    fn closest(&self, point: DVec3) -> SurfacePoint;

    /// Sharp edges: straight ones by their two ends, curved ones in pieces not much longer than `piece`
    /// \[m\]. Two-dimensional corners and tips are pieces of zero length. Smooth surfaces have none.
    fn edges(&self, _piece: f64) -> Vec<[DVec3; 2]> {
        Vec::new()
    }

    /// Volume, centre and second moments, where they have a closed form.
    fn moments(&self) -> Option<Moments> {
        None
    }
}

/// A circle in pieces not much longer than `piece`, about a unit vector `axis` \[m\].
pub(super) fn circle(center: DVec3, axis: DVec3, radius: f64, piece: f64) -> Vec<[DVec3; 2]> {
    let (u, v) = axis.any_orthonormal_pair();
    let parts = (TAU * radius / piece).ceil().max(8.0) as usize;
    let at = |k: usize| {
        let angle = TAU * (k % parts) as f64 / parts as f64;
        center + radius * (angle.cos() * u + angle.sin() * v)
    };
    (0..parts).map(|k| [at(k), at(k + 1)]).collect()
}

/// The nearest point to `point` on two concentric circles or spheres.
pub(super) fn closest_between(center: DVec3, inner: f64, outer: f64, point: DVec3) -> SurfacePoint {
    let arm = point - center;
    let radial = arm.try_normalize().unwrap_or(DVec3::X);
    let outside = Facing { normal: radial, distance: arm.length() - outer };
    outside.outermost(Facing { normal: -radial, distance: inner - arm.length() }).foot(point)
}

/// A face at a signed distance along its outward normal.
#[derive(Clone, Copy)]
pub(super) struct Facing {
    pub normal: DVec3,
    pub distance: f64,
}

impl Facing {
    /// The nearer one of two faces, for a point behind both.
    #[inline]
    pub fn outermost(self, other: Self) -> Self {
        if other.distance > self.distance { other } else { self }
    }

    /// The foot of `point` on this face.
    #[inline]
    pub fn foot(self, point: DVec3) -> SurfacePoint {
        SurfacePoint {
            point: point - self.distance * self.normal,
            normal: self.normal,
            signed_distance: self.distance,
        }
    }
}

/// The nearest surface point of the intersection of half-spaces behind `faces` with orthogonal normals. It is
/// on the nearest face for a point inside, and on the face, edge or corner of all faces in front of which a
/// point outside is.
#[inline]
pub(super) fn behind_all(point: DVec3, faces: &[Facing]) -> SurfacePoint {
    let in_front = faces.iter().filter(|face| face.distance > 0.0);
    let out: DVec3 = in_front.map(|face| face.distance * face.normal).sum();
    let distance = out.length();
    if distance > 0.0 {
        return SurfacePoint { point: point - out, normal: out / distance, signed_distance: distance };
    }
    let on: DVec3 = faces.iter().filter(|face| face.distance == 0.0).map(|face| face.normal).sum();
    if on != DVec3::ZERO {
        return SurfacePoint { point, normal: on.normalize(), signed_distance: 0.0 };
    }
    faces[1..].iter().fold(faces[0], |nearest, &face| nearest.outermost(face)).foot(point)
}
