//! Nearest points of surfaces: closed forms at faces, edges, corners and inside; general properties of
//! surfaces.

use std::path::Path;

use glam::DVec3;
use proptest::prelude::*;

use super::shape;
use crate::scene::Dimension::{self, Three, Two};
use crate::shapes::Surface;

fn surface(text: &str, dimension: Dimension) -> Box<dyn Surface> {
    shape(text).surface(dimension, Path::new(""), "shape").unwrap()
}

/// Compares the signed distance, the nearest point and the normal for a query point.
fn assert_closest(surface: &dyn Surface, asked: [f64; 3], distance: f64, point: [f64; 3], normal: [f64; 3]) {
    let found = surface.closest(asked.into());
    let normal = DVec3::from(normal).normalize();
    assert!((found.signed_distance - distance).abs() < 1e-14, "{asked:?}: {found:?}");
    assert!(found.point.distance(point.into()) < 1e-14, "{asked:?}: {found:?}");
    assert!(found.normal.distance(normal) < 1e-14, "{asked:?}: {found:?}");
}

#[test]
fn of_a_box() {
    let cube = surface("Box(min: (-1, -1, -1), max: (1, 1, 1))", Three);
    let cube = cube.as_ref();
    assert_closest(cube, [0.5, 3.0, 0.2], 2.0, [0.5, 1.0, 0.2], [0.0, 1.0, 0.0]);
    assert_closest(cube, [0.5, 0.9, 0.2], -0.1, [0.5, 1.0, 0.2], [0.0, 1.0, 0.0]);
    assert_closest(cube, [-0.75, 0.5, 0.2], -0.25, [-1.0, 0.5, 0.2], [-1.0, 0.0, 0.0]);
    // An edge and a corner: from outside the normal is along the line to it, on it the mean of the faces.
    assert_closest(cube, [4.0, 5.0, 0.0], 5.0, [1.0, 1.0, 0.0], [3.0, 4.0, 0.0]);
    assert_closest(cube, [1.0, 1.0, 0.3], 0.0, [1.0, 1.0, 0.3], [1.0, 1.0, 0.0]);
    assert_closest(cube, [-2.0, 2.0, -2.0], 3f64.sqrt(), [-1.0, 1.0, -1.0], [-1.0, 1.0, -1.0]);
    assert_closest(cube, [-1.0, 1.0, -1.0], 0.0, [-1.0, 1.0, -1.0], [-1.0, 1.0, -1.0]);
    assert_closest(cube, [0.2, 0.3, -1.0], 0.0, [0.2, 0.3, -1.0], [0.0, 0.0, -1.0]);
    // The centre is equidistant from six faces: the first axis is chosen.
    assert_closest(cube, [0.0; 3], -1.0, [1.0, 0.0, 0.0], [1.0, 0.0, 0.0]);
    let rectangle = surface("Box(min: (0, 0), max: (4, 1))", Two);
    assert_closest(rectangle.as_ref(), [2.0, 0.4, 0.0], -0.4, [2.0, 0.0, 0.0], [0.0, -1.0, 0.0]);
    assert_closest(rectangle.as_ref(), [5.0, 2.0, 0.0], 2f64.sqrt(), [4.0, 1.0, 0.0], [1.0, 1.0, 0.0]);
}

#[test]
fn of_round_shapes() {
    let ball = surface("Sphere(center: (1, 0, 0), radius: 2)", Three);
    assert_closest(ball.as_ref(), [1.0, 3.0, 4.0], 3.0, [1.0, 1.2, 1.6], [0.0, 3.0, 4.0]);
    assert_closest(ball.as_ref(), [0.5, 0.0, 0.0], -1.5, [-1.0, 0.0, 0.0], [-1.0, 0.0, 0.0]);
    assert_closest(ball.as_ref(), [1.0, 0.0, 0.0], -2.0, [3.0, 0.0, 0.0], [1.0, 0.0, 0.0]);
    let ring = surface("Ring(center: (0, 0), inner: 1, outer: 2)", Two);
    assert_closest(ring.as_ref(), [0.0, 1.2, 0.0], -0.2, [0.0, 1.0, 0.0], [0.0, -1.0, 0.0]);
    assert_closest(ring.as_ref(), [0.0, 1.8, 0.0], -0.2, [0.0, 2.0, 0.0], [0.0, 1.0, 0.0]);
    assert_closest(ring.as_ref(), [0.0, -0.4, 0.0], 0.6, [0.0, -1.0, 0.0], [0.0, 1.0, 0.0]);
    let rod = surface("Cylinder(from: (0, 0, 0), to: (0, 0, 4), radius: 1)", Three);
    assert_closest(rod.as_ref(), [2.0, 0.0, 1.0], 1.0, [1.0, 0.0, 1.0], [1.0, 0.0, 0.0]);
    assert_closest(rod.as_ref(), [0.3, 0.4, 3.8], -0.2, [0.3, 0.4, 4.0], [0.0, 0.0, 1.0]);
    assert_closest(rod.as_ref(), [0.0, 4.0, 8.0], 5.0, [0.0, 1.0, 4.0], [0.0, 3.0, 4.0]);
    assert_closest(rod.as_ref(), [0.0, 1.0, 0.0], 0.0, [0.0, 1.0, 0.0], [0.0, 1.0, -1.0]);
    let tube = surface("Tube(from: (-3, 0, 0), to: (3, 0, 0), inner: 1, outer: 2)", Three);
    assert_closest(tube.as_ref(), [0.0, 0.0, 0.5], 0.5, [0.0, 0.0, 1.0], [0.0, 0.0, -1.0]);
    assert_closest(tube.as_ref(), [4.0, 0.0, 0.0], 2f64.sqrt(), tube.closest(4.0 * DVec3::X).point.into(), {
        let radial = tube.closest(4.0 * DVec3::X).point.reject_from(DVec3::X);
        (DVec3::X - radial.normalize()).into()
    });
}

#[test]
fn of_polygons_and_prisms() {
    // An L-shape with one concave corner at (1, 1), in both orientations.
    let corners =
        ["(0, 0), (2, 0), (2, 1), (1, 1), (1, 2), (0, 2)", "(0, 2), (1, 2), (1, 1), (2, 1), (2, 0), (0, 0)"];
    for corners in corners {
        let angle = surface(&format!("Polygon(points: [{corners}])"), Two);
        let angle = angle.as_ref();
        assert_closest(angle, [1.0, -0.5, 0.0], 0.5, [1.0, 0.0, 0.0], [0.0, -1.0, 0.0]);
        assert_closest(angle, [1.5, 1.25, 0.0], 0.25, [1.5, 1.0, 0.0], [0.0, 1.0, 0.0]);
        assert_closest(angle, [5.0, -4.0, 0.0], 5.0, [2.0, 0.0, 0.0], [3.0, -4.0, 0.0]);
        assert_closest(angle, [0.7, 0.6, 0.0], -0.5, [1.0, 1.0, 0.0], [3.0, 4.0, 0.0]);
        assert_closest(angle, [1.0, 1.0, 0.0], 0.0, [1.0, 1.0, 0.0], [1.0, 1.0, 0.0]);
        let prism = surface(&format!("Extrusion(polygon: [{corners}], from: -1, to: 1)"), Three);
        let prism = prism.as_ref();
        assert_closest(prism, [0.7, 0.6, 0.0], -0.5, [1.0, 1.0, 0.0], [3.0, 4.0, 0.0]);
        assert_closest(prism, [0.7, 0.6, -0.9], -0.1, [0.7, 0.6, -1.0], [0.0, 0.0, -1.0]);
        assert_closest(prism, [4.0, -2.0, 2.0], 3.0, [2.0, 0.0, 1.0], [2.0, -2.0, 1.0]);
        assert_closest(prism, [1.0, 0.0, 1.0], 0.0, [1.0, 0.0, 1.0], [0.0, -1.0, 1.0]);
    }
}

#[test]
fn of_planes_and_of_what_is_moved() {
    let ground = surface("HalfSpace(point: (0, 1), normal: (0, 5))", Two);
    assert_closest(ground.as_ref(), [7.0, 3.0, 0.0], 2.0, [7.0, 1.0, 0.0], [0.0, 1.0, 0.0]);
    assert_closest(ground.as_ref(), [7.0, -3.0, 0.0], -4.0, [7.0, 1.0, 0.0], [0.0, 1.0, 0.0]);
    assert!(!ground.bounds().is_bounded());
    let turned = surface(
        "Translate(by: (0, 0, 1), shape: Rotate(axis: (1, 0, 0), angle_degrees: 90,
            shape: Scale(by: (2, 2, 2), shape: Cylinder(from: (0, 0, 0), to: (0, 0, 4), radius: 1))))",
        Three,
    );
    // The axis extends from (0, 0, 1) to (0, -8, 1), the radius is 2.
    assert_closest(turned.as_ref(), [0.0, -5.0, 4.0], 1.0, [0.0, -5.0, 3.0], [0.0, 0.0, 1.0]);
    assert_closest(turned.as_ref(), [1.0, -0.25, 1.0], -0.25, [1.0, 0.0, 1.0], [0.0, 1.0, 0.0]);
}

#[test]
fn of_parts_that_are_apart_and_of_hollow_ones() {
    let two = surface("Union([Box(min: (0, 0), max: (1, 1)), Sphere(center: (5, 0), radius: 1)])", Two);
    assert_closest(two.as_ref(), [2.0, 0.5, 0.0], 1.0, [1.0, 0.5, 0.0], [1.0, 0.0, 0.0]);
    assert_closest(two.as_ref(), [3.0, 0.0, 0.0], 1.0, [4.0, 0.0, 0.0], [-1.0, 0.0, 0.0]);
    let hollow = surface("Difference(Box(min: (-2, -2), max: (2, 2)), Box(min: (-1, -1), max: (1, 1)))", Two);
    let hollow = hollow.as_ref();
    assert_closest(hollow, [0.5, 0.0, 0.0], 0.5, [1.0, 0.0, 0.0], [-1.0, 0.0, 0.0]);
    assert_closest(hollow, [1.25, 0.0, 0.0], -0.25, [1.0, 0.0, 0.0], [-1.0, 0.0, 0.0]);
    assert_closest(hollow, [1.75, 0.0, 0.0], -0.25, [2.0, 0.0, 0.0], [1.0, 0.0, 0.0]);
    assert_closest(hollow, [3.0, 0.0, 0.0], 1.0, [2.0, 0.0, 0.0], [1.0, 0.0, 0.0]);
}

#[test]
fn of_combinations_is_refused_where_it_is_not_known() {
    for (text, path) in [
        ("Union([Box(min: (0, 0), max: (1, 1)), Box(min: (1, 0), max: (2, 1))])", "tool"),
        ("Difference(Box(min: (0, 0), max: (1, 1)), Box(min: (0, 0), max: (0.5, 0.5)))", "tool"),
        ("Intersection([Box(min: (0, 0), max: (1, 1)), HalfSpace(point: (0, 0), normal: (1, 1))])", "tool"),
        (
            "Translate(shape: Scale(shape: Ring(center: (0, 0), inner: 0.5, outer: 1), by: (1, 2)), by: (1, 1))",
            "tool.shape",
        ),
        ("Points(file: \"particles.csv\")", "tool"),
    ] {
        let error = shape(text).surface(Two, Path::new(""), "tool").err().unwrap();
        assert_eq!(error.path, path, "{text}");
        assert!(error.kind.help().is_some_and(|help| help.contains("tool")), "{error}");
    }
}

const SPACE: [&str; 10] = [
    "Box(min: (-1, -0.5, -0.2), max: (1, 1, 0.7))",
    "Sphere(center: (0.5, 0, 0), radius: 1)",
    "Cylinder(from: (0, 0, -1), to: (0, 0.5, 0.5), radius: 1)",
    "Tube(from: (1, 0, 0), to: (-1, 0, 0), inner: 0.4, outer: 1)",
    "Shell(center: (1, 0, 0), inner: 0.4, outer: 1)",
    "Extrusion(polygon: [(-1, -1), (1, -1), (1, 1), (0, -0.5), (-1, 1)], from: -0.5, to: 0.5)",
    "HalfSpace(point: (0.1, 0.2, 0), normal: (1, 2, -2))",
    "Rotate(shape: Box(min: (0, 0, 0), max: (1, 1, 1)), axis: (1, 1, 1), angle_degrees: 45)",
    "Scale(shape: Sphere(center: (0.5, 0, 0), radius: 1), by: (0.5, 0.5, 0.5), about: (1, 1, 1))",
    "Difference(Box(min: (-1, -1, -1), max: (1, 1, 1)), Sphere(center: (0, 0, 0), radius: 0.5))",
];

proptest! {
    #[test]
    fn is_at_the_distance_that_it_says(p in [-1.5..1.5, -1.5..1.5, -1.5..1.5]) {
        let p = DVec3::from_array(p);
        for text in SPACE {
            let surface = surface(text, Three);
            let found = surface.closest(p);
            // The distance of the region is a second formula for the same quantity.
            prop_assert!((found.signed_distance - surface.distance(p)).abs() < 1e-12, "{} {:?}", text, found);
            prop_assert!((found.normal.length() - 1.0).abs() < 1e-12, "{} {:?}", text, found);
            let foot = found.point + found.signed_distance * found.normal;
            prop_assert!(foot.distance(p) < 1e-12, "{} {:?}", text, found);
            prop_assert!(surface.distance(found.point).abs() < 1e-12, "{} {:?}", text, found);
        }
    }
}
