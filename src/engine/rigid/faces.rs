//! The faces of a surface that a particle beside a corner or an edge is equally near to.
//!
//! Round-off decides to which of them the nearest point of the surface belongs. With that one alone, a body
//! had points on one side of a corner or on the other, and a block that landed flat on a floor began to rock;
//! in a plate of one layer each particle had a point either above or below.

use glam::{DQuat, DVec3};

use crate::shapes::{Surface, SurfacePoint};
use crate::space::Dimension;

/// Cosine of the angle between normals from which on they belong to one face.
const SAME: f64 = 0.9;
/// How far beside the particle another face counts as equally near, over the spacing.
const ASIDE: f64 = 1e-3;
/// Distance from a face within which a particle is of its outermost layer, over the spacing.
pub(super) const NEAR: f64 = 0.75;
/// Distance of a foot from the surface up to which its face is flat, over the spacing.
const FLAT: f64 = 1e-6;

/// Finds the faces near particles.
pub(super) struct NearestFaces<'a> {
    surface: &'a dyn Surface,
    spacing: f64,
    /// Ways to places beside a particle, each of which is nearest to one face: in none of them two faces of a
    /// corner are alike.
    beside: Vec<DVec3>,
    /// More of them, so that each face of a sharp corner has some inside of the body that are nearest to it.
    around: Vec<DVec3>,
}

impl<'a> NearestFaces<'a> {
    /// Of a surface about particles of that spacing, m.
    pub fn new(surface: &'a dyn Surface, spacing: f64, dimension: Dimension) -> Self {
        let skew = match dimension {
            Dimension::Two => DQuat::from_rotation_z(0.3),
            Dimension::Three => DQuat::from_euler(glam::EulerRot::XYZ, 0.3, 0.2, 0.5),
        };
        let ways = |count: i8| {
            let axis = move || -count..=count;
            let last = if dimension == Dimension::Two { 0..=0 } else { axis() };
            let plane = axis().flat_map(move |x| axis().map(move |y| (x, y)));
            let all = plane
                .flat_map(move |(x, y)| last.clone().map(move |z| DVec3::from([x, y, z].map(f64::from))));
            all.filter_map(DVec3::try_normalize).map(|way| ASIDE * spacing * (skew * way)).collect()
        };
        let around = ways(if dimension == Dimension::Two { 8 } else { 3 });
        Self { surface, spacing, beside: ways(1), around }
    }

    /// The foot of a place on every face that it is nearest to, from the nearest point of the surface.
    pub fn of(&self, place: DVec3, nearest: SurfacePoint) -> Vec<SurfacePoint> {
        let mut faces = vec![nearest];
        for &way in &self.beside {
            let near = self.surface.closest(place + way);
            if faces.iter().all(|face| face.normal.dot(near.normal) < SAME) {
                let along = way - way.dot(near.normal) * near.normal;
                faces.push(SurfacePoint { point: near.point - along, ..near });
            }
        }
        faces
    }

    /// The outward normals of the faces that end at a point of an edge or a corner, of four at most, zero
    /// where there are fewer.
    pub fn ending_at(&self, point: DVec3) -> [DVec3; 4] {
        let (mut normals, mut count) = ([DVec3::ZERO; 4], 0);
        for &way in &self.around {
            let near = self.surface.closest(point + way);
            // Outside, the edge itself may be nearest.
            let is_new = normals.iter().all(|normal| normal.dot(near.normal) < SAME);
            if near.signed_distance < 0.0 && is_new && count < normals.len() {
                normals[count] = near.normal;
                count += 1;
            }
        }
        normals
    }

    /// The foot of a place on the flat face beyond the edge of the one that it is nearest to, if the place is
    /// in the outermost layer of both, but nearer to one. Beside the round side of a disc the flat ends would
    /// else have no points in their outermost half spacing.
    pub fn across(&self, place: DVec3, nearest: SurfacePoint) -> Option<SurfacePoint> {
        let Self { surface, spacing, .. } = *self;
        let aside = spacing * nearest.normal;
        let face = surface.closest(place - aside);
        let point = face.point + aside - aside.dot(face.normal) * face.normal;
        let distance = place.distance(point);
        let is_nearer_to_one = distance - nearest.signed_distance.abs() > 2.0 * ASIDE * spacing;
        let is_other = face.normal.dot(nearest.normal) < SAME;
        let is_there = || surface.closest(point).signed_distance.abs() < FLAT * spacing;
        (distance < NEAR * spacing && is_nearer_to_one && is_other && is_there())
            .then_some(SurfacePoint { point, ..face })
    }
}

#[cfg(test)]
mod tests {
    use std::path::Path;

    use super::*;
    use crate::shapes::Shape;

    #[test]
    fn the_faces_that_end_at_edges_and_corners_are_found() {
        let shape: Shape = ron::from_str("Box(min: (0, 0, 0), max: (0.2, 0.1, 0.1))").expect("a shape");
        let surface = shape.surface(Dimension::Three, Path::new("."), "shape").expect("a surface");
        let faces = NearestFaces::new(&*surface, 0.01, Dimension::Three);
        for (x, y, z) in [(0.0, 0.0, 0.0), (0.2, 0.0, 0.1), (0.0, 0.1, 0.0), (0.2, 0.1, 0.1), (0.1, 0.1, 0.0)]
        {
            let outward = |at: f64, end: f64| {
                if at == 0.0 {
                    -1.0
                } else if at == end {
                    1.0
                } else {
                    0.0
                }
            };
            let sides =
                [(DVec3::X, outward(x, 0.2)), (DVec3::Y, outward(y, 0.1)), (DVec3::Z, outward(z, 0.1))];
            let found = faces.ending_at(DVec3::new(x, y, z));
            let expected: Vec<DVec3> =
                sides.into_iter().filter(|(_, side)| *side != 0.0).map(|(axis, side)| axis * side).collect();
            assert!(expected.iter().all(|normal| found.contains(normal)), "{x} {y} {z}: {found:?}");
            assert_eq!(found.iter().filter(|normal| **normal != DVec3::ZERO).count(), expected.len());
        }
    }

    #[test]
    fn a_place_beside_a_corner_is_near_to_all_its_faces() {
        let block = "Box(min: (0, 0, 0), max: (0.1, 0.1, 0.01))";
        for (degrees, axis) in [(0.0, "(0, 0, 1)"), (45.0, "(0, 0, 1)"), (37.0, "(1, 2, 3)")] {
            let text =
                format!("Rotate(shape: {block}, axis: {axis}, angle_degrees: {degrees:?}, about: (0, 0, 0))");
            let shape: Shape = ron::from_str(&text).expect("a shape");
            let surface = shape.surface(Dimension::Three, Path::new("."), "shape").expect("a surface");
            let axis = ron::from_str::<(f64, f64, f64)>(axis).expect("an axis");
            let turn = DQuat::from_axis_angle(DVec3::from(axis).normalize(), f64::to_radians(degrees));
            let faces = NearestFaces::new(&*surface, 0.01, Dimension::Three);
            for (place, count) in [((0.005, 0.005), 4), ((0.005, 0.035), 3), ((0.035, 0.045), 2)] {
                let place = DVec3::new(place.0, place.1, 0.005);
                let found = faces.of(turn * place, surface.closest(turn * place));
                assert_eq!(found.len(), count, "{degrees} {place}");
                for face in found {
                    let normal = turn.inverse() * face.normal;
                    let foot = turn.inverse() * face.point - (place + 0.005 * normal);
                    assert!(
                        normal.abs().max_element() > 1.0 - 1e-12 && foot.length() < 1e-12,
                        "{place} {foot}"
                    );
                }
            }
        }
    }
}
