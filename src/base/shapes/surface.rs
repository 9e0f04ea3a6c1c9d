//! The surface of a shape, as contact with a tool needs it.

use std::f64::consts::TAU;

use glam::DVec3;

use super::moments::Moments;
use super::region::Region;

/// The point of a surface that is nearest to a given one.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SurfacePoint {
    /// The nearest point of the surface \[m\].
    pub point: DVec3,
    /// n, unit normal of the surface there, outward \[-\]. At edges and corners it is along the line from
    /// `point` to the point asked for (against it from inside); for a point on them, the mean of the normals
    /// that meet there.
    pub normal: DVec3,
    /// Distance from the point asked for, negative inside \[m\].
    pub signed_distance: f64,
}

/// A region that knows the nearest point of its surface exactly. In two dimensions everything lies in z = 0.
pub trait Surface: Region {
    /// The point of the surface that is nearest to `point`. Of several equally near ones the choice is fixed:
    /// the same `point` always has the same answer.
    fn closest(&self, point: DVec3) -> SurfacePoint;

    /// Sharp edges, straight ones by their two ends, round ones in pieces not much longer than `piece` \[m\];
    /// corners of two dimensions and tips are pieces without length. Smooth surfaces have none.
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

/// The point nearest to `point` of the surface between two concentric circles or spheres.
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
    /// The nearer one of two faces of which a point inside is behind both.
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

/// The nearest point of what lies behind all `faces`, whose normals are at right angles to each other: inside
/// that of the nearest face, outside that of the edge or corner of all faces that the point is in front of.
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
