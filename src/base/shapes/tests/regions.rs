//! Point membership, bounds and signed distance of shapes.

use std::path::Path;

use glam::DVec3;
use proptest::prelude::*;

use super::shape;
use crate::scene::Dimension::{self, Three, Two};
use crate::shapes::{Aabb, Region};

fn region(text: &str, dimension: Dimension) -> Box<dyn Region> {
    shape(text).region(dimension, Path::new(""), "shape").unwrap()
}

/// Shapes with a second, naive inside test.
type Inside = fn(DVec3) -> bool;
const PLANE: [(&str, Inside); 9] = [
    ("Intersection([HalfSpace(point: (0, 0.1), normal: (1, 1)), Box(min: (-1, -1), max: (1, 1))])", |p| {
        p.x + p.y <= 0.1 && p.x.abs() <= 1.0 && p.y.abs() <= 1.0
    }),
    ("Box(min: (-1, 0), max: (1, 0.5))", |p| p.x.abs() <= 1.0 && p.y >= 0.0 && p.y <= 0.5),
    ("Sphere(center: (0.5, 0), radius: 1)", |p| (p.x - 0.5).hypot(p.y) <= 1.0),
    ("Ring(center: (0, 0.5), inner: 0.5, outer: 1)", |p| (0.5..=1.0).contains(&p.x.hypot(p.y - 0.5))),
    ("Polygon(points: [(-1, -1), (1, -1), (1, 1), (0, 0), (-1, 1)])", |p| {
        p.x.abs() <= 1.0 && p.y >= -1.0 && p.y <= p.x.abs()
    }),
    ("Union([Box(min: (-1, -1), max: (0, 0)), Sphere(center: (0, 0), radius: 0.5)])", |p| {
        (p.x <= 0.0 && p.x >= -1.0 && p.y <= 0.0 && p.y >= -1.0) || p.x.hypot(p.y) <= 0.5
    }),
    ("Difference(Box(min: (-1, -1), max: (1, 1)), Sphere(center: (1, 1), radius: 1))", |p| {
        p.x.abs() <= 1.0 && p.y.abs() <= 1.0 && (p.x - 1.0).hypot(p.y - 1.0) >= 1.0
    }),
    ("Rotate(shape: Box(min: (0, 0), max: (1, 1)), angle_degrees: 45)", |p| {
        (0.0..=2f64.sqrt()).contains(&(p.x + p.y)) && (0.0..=2f64.sqrt()).contains(&(p.y - p.x))
    }),
    ("Scale(shape: Translate(shape: Sphere(center: (0, 0), radius: 1), by: (0.2, 0)), by: (1, 0.5))", |p| {
        (p.x - 0.2).hypot(2.0 * p.y) <= 1.0
    }),
];
const SPACE: [(&str, Inside); 6] = [
    ("Shell(center: (0.5, 0, 0), inner: 0.4, outer: 1)", |p| {
        (0.4..=1.0).contains(&p.distance(0.5 * DVec3::X))
    }),
    ("Sphere(center: (0.5, 0, 0), radius: 1)", |p| p.distance(0.5 * DVec3::X) <= 1.0),
    ("Cylinder(from: (0, 0, -1), to: (0, 0, 0.5), radius: 1)", |p| {
        p.x.hypot(p.y) <= 1.0 && p.z >= -1.0 && p.z <= 0.5
    }),
    ("Tube(from: (1, 0, 0), to: (-1, 0, 0), inner: 0.4, outer: 1)", |p| {
        p.x.abs() <= 1.0 && (0.4..=1.0).contains(&p.y.hypot(p.z))
    }),
    ("Extrusion(polygon: [(-1, -1), (1, -1), (-1, 1)], from: 0, to: 1)", |p| {
        p.x >= -1.0 && p.y >= -1.0 && p.x + p.y <= 0.0 && p.z >= 0.0 && p.z <= 1.0
    }),
    ("Intersection([Box(min: (-1, -1, -1), max: (1, 1, 1)), Sphere(center: (0, 0, 0), radius: 1.2)])", |p| {
        p.abs().max_element() <= 1.0 && p.length() <= 1.2
    }),
];

proptest! {
    #[test]
    fn contains_what_it_should(x in -1.5..1.5, y in -1.5..1.5, z in -1.5..1.5) {
        for (text, inside) in PLANE {
            let point = DVec3::new(x, y, 0.0);
            prop_assert_eq!(region(text, Two).contains(point), inside(point), "{} {}", text, point);
        }
        for (text, inside) in SPACE {
            let point = DVec3::new(x, y, z);
            prop_assert_eq!(region(text, Three).contains(point), inside(point), "{} {}", text, point);
        }
    }

    #[test]
    fn distance_is_never_more_than_the_true_one(p in [-1.5..1.5, -1.5..1.5, -1.5..1.5], q in [-1.5..1.5, -1.5..1.5, -1.5..1.5]) {
        // A distance that never exceeds the true one is Lipschitz continuous with constant 1: a step from any
        // point p changes it by at most the length of the step, and vice versa.
        let (p, q) = (DVec3::from_array(p), DVec3::from_array(q));
        for (text, _) in SPACE {
            let region = region(text, Three);
            prop_assert!((region.distance(p) - region.distance(q)).abs() <= p.distance(q) + 1e-12, "{}", text);
        }
        let (p, q) = (p * DVec3::new(1.0, 1.0, 0.0), q * DVec3::new(1.0, 1.0, 0.0));
        for (text, _) in PLANE {
            let region = region(text, Two);
            prop_assert!((region.distance(p) - region.distance(q)).abs() <= p.distance(q) + 1e-12, "{}", text);
            let bounds = region.bounds();
            if region.contains(p) {
                let slack = DVec3::splat(region.tolerance());
                prop_assert!(p.cmpge(bounds.min - slack).all() && p.cmple(bounds.max + slack).all(), "{}", text);
            }
        }
    }
}

#[test]
fn the_boundary_is_inside() {
    let wall =
        region("Difference(Box(min: (0, 0), max: (1, 1)), Box(min: (0.1, 0.1), max: (0.9, 0.9)))", Two);
    for (x, y) in [(0.0, 0.0), (1.0, 0.3), (0.1, 0.5), (0.30000000000000004 - 0.2, 0.5), (0.9, 0.9)] {
        assert!(wall.contains(DVec3::new(x, y, 0.0)), "{x} {y}");
    }
    for (x, y) in [(-1e-6, 0.0), (0.100001, 0.5), (0.5, 0.5)] {
        assert!(!wall.contains(DVec3::new(x, y, 0.0)), "{x} {y}");
    }
}

#[test]
fn bounds_are_tight() {
    let slanted = region("Cylinder(from: (0, 0, 0), to: (3, 4, 0), radius: 1)", Three).bounds();
    let expected = Aabb { min: DVec3::new(-0.8, -0.6, -1.0), max: DVec3::new(3.8, 4.6, 1.0) };
    assert!(slanted.min.distance(expected.min) < 1e-12 && slanted.max.distance(expected.max) < 1e-12);
    let turned = region("Rotate(shape: Box(min: (0, 0), max: (1, 1)), angle_degrees: 90)", Two).bounds();
    assert!(turned.min.distance(DVec3::new(-1.0, 0.0, 0.0)) < 1e-12);
}

#[test]
fn what_takes_an_end_away_moves_the_bounds() {
    let bounds = |hole: &str| {
        let ring = format!("Difference(Ring(center: (0, 0), inner: 1, outer: 2), {hole})");
        let Aabb { min, max } = region(&ring, Two).bounds();
        [min.x, min.y, max.x, max.y]
    };
    let arch = [-2.0, 0.5, 2.0, 2.0];
    assert_eq!(bounds("HalfSpace(point: (3, 0.5), normal: (0, 2))"), arch);
    assert_eq!(bounds("Box(min: (-2, -9), max: (2, 0.5))"), arch);
    assert_eq!(bounds("Box(min: (0.5, -9), max: (9, 9))"), [-2.0, -2.0, 0.5, 2.0]);
    // Part of the ring remains beside these holes, at every end.
    let whole = [-2.0, -2.0, 2.0, 2.0];
    assert_eq!(bounds("Box(min: (-1.9, -9), max: (2, 0.5))"), whole);
    assert_eq!(bounds("Box(min: (-9, -0.1), max: (9, 0.1))"), whole);
    assert_eq!(bounds("HalfSpace(point: (0, 0), normal: (1, 1))"), whole);
}

#[test]
fn volumes_of_nested_boxes_are_exact() {
    let frame = "Difference(Box(min: (0, 0, 0), max: (3, 3, 3)), Union([
        Box(min: (1, 1, -1), max: (2, 2, 4)), Box(min: (-1, 1, 1), max: (4, 2, 2)), Box(min: (1, -1, 1), max: (2, 4, 2))]))";
    // A cube of 27 without its middle and the middles of its six faces.
    let volume = region(frame, Three).volume().unwrap();
    assert!((volume - 20.0).abs() < 1e-12);
    let moved = format!("Scale(shape: Translate(shape: {frame}, by: (1, 0, 0)), by: (1, 2, 3))");
    let both = format!("Intersection([{moved}, {moved}])");
    assert!((region(&both, Three).volume().unwrap() - 120.0).abs() < 1e-10);
}

/// A hole that ends at a face of the body is open there: there is no material between the two faces.
#[test]
fn a_hole_through_a_body_has_no_lid() {
    let channel = region("Difference(Box(min: (0, -2), max: (8, 3)), Box(min: (0, 0), max: (8, 1)))", Two);
    let pipe = region(
        "Difference(Cylinder(from: (0, 0, 0), to: (6, 0, 0), radius: 2), Cylinder(from: (0, 0, 0), to: (6, 0, 0), radius: 1))",
        Three,
    );
    let turned = region(
        "Rotate(shape: Difference(Box(min: (0, -2), max: (8, 3)), Box(min: (0, 0), max: (8, 1))), angle_degrees: 30)",
        Two,
    );
    let turn = |x: f64, y: f64| {
        let (sin, cos) = 30.0_f64.to_radians().sin_cos();
        DVec3::new(x * cos - y * sin, x * sin + y * cos, 0.0)
    };
    // Before, at and behind the ends, and far from them.
    for x in [1e-4, 0.03, 0.3, 4.0, 7.97, 7.9999, 8.0001, 8.03, -0.02] {
        for y in [0.02, 0.3, 0.5, 0.9] {
            // Beyond the ends, distances are those from the edges.
            let side = f64::min(y, 1.0 - y).hypot(f64::max(0.0, f64::max(x - 8.0, -x)));
            let found = [channel.clearance(DVec3::new(x, y, 0.0)), turned.clearance(turn(x, y))];
            assert!(found.iter().all(|d| (d - side).abs() < 1e-6), "{x} {y}: {found:?} and {side}");
        }
    }
    for x in [1e-4, 0.02, 3.0, 5.99, 6.01] {
        for r in [0.0, 0.5, 0.97] {
            let found = pipe.clearance(DVec3::new(x, 0.6 * r, 0.8 * r));
            let side = f64::hypot(1.0 - r, f64::max(0.0, x - 6.0));
            assert!((found - side).abs() < 1e-6, "{x} {r}: {found}");
        }
    }
    // Distances inside the material are unchanged.
    assert_eq!(channel.clearance(DVec3::new(0.5, -1.0, 0.0)), -0.5);
}

/// A channel that runs obliquely through a box: its walls are two triangles, also where it opens.
#[test]
fn an_oblique_channel_is_open_at_its_ends() {
    let walls = shape(
        "Difference(Box(min: (0, 0), max: (1, 1)), Polygon(points: [(0, 0), (0.3, 0), (1, 0.7), (1, 1), (0.7, 1), (0, 0.3)]))",
    );
    let walls = walls.cut_part_by_part().region(Two, Path::new(""), "shape").unwrap();
    let triangles = ["(0.3, 0), (1, 0), (1, 0.7)", "(0, 0.3), (0.7, 1), (0, 1)"]
        .map(|points| region(&format!("Polygon(points: [{points}])"), Two));
    for along in [0.27, 0.28, 0.299, 0.301, 0.31, 0.33] {
        for across in [-0.04, -0.02, -0.005, -0.001, 0.001, 0.005, 0.01, 0.03] {
            for point in [(along, across), (across, along), (1.0 - along, 1.0 - across)] {
                let point = DVec3::new(point.0, point.1, 0.0);
                let right = triangles.iter().map(|wall| wall.distance(point)).fold(f64::INFINITY, f64::min);
                let found = walls.clearance(point);
                assert!(right <= 0.0 || (found - right).abs() < 1e-6, "{point}: {found} and {right}");
            }
        }
    }
}

/// A slit in the floor of a tank, in the two orders and as one hole of two parts: the distance is that from
/// the corners or sides of the slit, and it is continuous across the extensions of the sides.
#[test]
fn a_slit_in_a_floor_is_open_and_has_no_sides_above_it() {
    let (outer, tank, slit) = (
        "Box(min: (-0.2, -0.2), max: (1.2, 0.8))",
        "Box(min: (0, 0), max: (1, 2))",
        "Box(min: (0.4, -0.3), max: (0.6, 0))",
    );
    let walls = [
        format!("Difference(Difference({outer}, {tank}), {slit})"),
        format!("Difference(Difference({outer}, {slit}), {tank})"),
        format!("Difference({outer}, Union([{tank}, {slit}]))"),
        format!("Difference({outer}, Translate(shape: Union([{slit}, {tank}]), by: (0, 0)))"),
        // Holes that overlap.
        format!("Difference({outer}, Union([{tank}, Box(min: (0.4, -0.3), max: (0.6, 0.7))]))"),
    ];
    // Distance from a box of the floor beside the slit.
    let beside = |x: f64, y: f64, from: f64, to: f64| {
        f64::max(from - x, x - to).max(0.0).hypot(f64::max(-0.2 - y, y).max(0.0))
    };
    for text in walls {
        let wall = shape(&text).cut_part_by_part().region(Two, Path::new(""), "shape").unwrap();
        for x in [0.397, 0.399_999, 0.400_001, 0.402, 0.405, 0.41, 0.58, 0.599, 0.601] {
            for y in [-0.1, -0.02, -0.003, 0.001, 0.002, 0.0044, 0.02, 0.3] {
                let found = wall.clearance(DVec3::new(x, y, 0.0));
                let right = beside(x, y, -0.2, 0.4).min(beside(x, y, 0.6, 1.2));
                assert!(right == 0.0 || (found - right).abs() < 1e-8, "{text} {x} {y}: {found} and {right}");
            }
        }
    }
}
