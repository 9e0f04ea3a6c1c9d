//! Volumes, centres, second moments and sharp edges of meshes against closed forms.

use glam::DMat3;

use super::*;
use crate::shapes::Moments;

fn moments(triangles: &Soup) -> Moments {
    solid(triangles).moments().unwrap()
}

fn assert_near(found: DMat3, expected: DMat3) {
    assert!((found - expected).abs_diff_eq(DMat3::ZERO, 1e-12), "{found} instead of {expected}");
}

#[test]
fn moments_of_a_box_are_those_of_its_sides() {
    let (min, max) = (DVec3::new(3.0, -1.0, 2.0), DVec3::new(4.0, 1.0, 5.0));
    let found = moments(&cube(min, max));
    let squares = (max - min) * (max - min);
    assert!((found.volume - 6.0).abs() < 1e-12);
    assert!(found.center.distance(0.5 * (min + max)) < 1e-12);
    assert_near(found.second.to_matrix(), DMat3::from_diagonal(squares / 12.0 * 6.0));
}

#[test]
fn moments_of_a_tetrahedron_are_those_of_its_corners() {
    // The unit tetrahedron: V = 1/6, centre 1/4, integrals of x^2 and x y from its corner 1/60 and 1/120.
    let [o, x, y, z] = [DVec3::ZERO, DVec3::X, DVec3::Y, DVec3::Z];
    let faces = [[o, y, x], [o, x, z], [o, z, y], [x, y, z]];
    let (turn, shift) =
        (DQuat::from_rotation_y(0.4) * DQuat::from_rotation_x(1.1), DVec3::new(7.0, -2.0, 0.5));
    let moved: Soup = faces.iter().map(|face| face.map(|corner| turn * corner + shift)).collect();
    let found = moments(&moved);
    assert!((found.volume - 1.0 / 6.0).abs() < 1e-13);
    assert!(found.center.distance(turn * DVec3::splat(0.25) + shift) < 1e-12);
    let (own, mixed) = (1.0 / 60.0 - 1.0 / 96.0, 1.0 / 120.0 - 1.0 / 96.0);
    let central = DMat3::from_diagonal(DVec3::splat(own - mixed))
        + DMat3::from_cols(DVec3::splat(mixed), DVec3::splat(mixed), DVec3::splat(mixed));
    let rotation = DMat3::from_quat(turn);
    assert_near(found.second.to_matrix(), rotation * central * rotation.transpose());
}

#[test]
fn moments_of_a_ball_are_approached_to_second_order() {
    let error = |n: usize| 1.0 - moments(&ball(2 * n, n)).second.trace() / (4.0 * PI / 5.0);
    assert!((error(20) / error(40) - 4.0).abs() < 0.1, "{} {}", error(20), error(40));
}

#[test]
fn sharp_edges_are_those_between_faces_at_an_angle() {
    // Twelve edges of a box, four of each length, and its eight corners; the diagonals of its faces are not
    // sharp edges.
    let edges = solid(&cube(DVec3::ZERO, DVec3::new(1.0, 2.0, 3.0))).edges(1.0);
    let mut lengths: Vec<f64> = edges.iter().map(|[a, b]| a.distance(*b)).collect();
    lengths.sort_by(f64::total_cmp);
    assert_eq!(lengths, [[0.0; 4], [0.0; 4], [1.0; 4], [2.0; 4], [3.0; 4]].concat());
    // Faces of a fine ball meet at 9 degrees.
    assert!(solid(&ball(40, 20)).edges(1.0).is_empty());
}
