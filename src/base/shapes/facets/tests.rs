//! Facets of shapes: closed, outward, of the right volume and length.

use std::collections::BTreeMap;
use std::path::Path;

use super::Facets;
use crate::shapes::Shape;
use crate::space::Dimension;

fn facets(text: &str, dimension: Dimension, length: f64) -> Option<Facets> {
    let shape: Shape = ron::from_str(text).unwrap_or_else(|e| panic!("{text}: {e}"));
    shape.facets(dimension, Path::new(concat!(env!("CARGO_MANIFEST_DIR"), "/../..")), length)
}

/// Volume by the divergence theorem, of x . n / axes over the facets.
fn volume(mesh: &Facets) -> f64 {
    let axes = mesh.axes as f64;
    let part = |facet: usize| {
        let (normal, measure) = mesh.normal_and_measure(facet);
        mesh.ends(facet)[0].dot(normal) * measure / axes
    };
    (0..mesh.corners.len()).map(part).sum()
}

/// Every end point (edge) belongs to two facets, with opposite orientations.
fn is_closed(mesh: &Facets) -> bool {
    let mut ends: BTreeMap<[u32; 2], i32> = BTreeMap::new();
    for &[a, b, c] in &mesh.corners {
        if mesh.axes == 2 {
            *ends.entry([a, a]).or_default() += 1;
            *ends.entry([b, b]).or_default() -= 1;
        } else {
            for [p, q] in [[a, b], [b, c], [c, a]] {
                *ends.entry([p.min(q), p.max(q)]).or_default() += if p < q { 1 } else { -1 };
            }
        }
    }
    ends.values().all(|sum| *sum == 0)
}

fn check(text: &str, dimension: Dimension, expected: f64, tolerance: f64) {
    let length = 0.05;
    let mesh = facets(text, dimension, length).unwrap_or_else(|| panic!("no facets of {text}"));
    assert!(is_closed(&mesh), "{text}");
    let found = volume(&mesh);
    assert!((found / expected - 1.0).abs() < tolerance, "{text}: {found} instead of {expected}");
    for facet in 0..mesh.corners.len() {
        let [a, b, c] = mesh.ends(facet);
        let longest = a.distance(b).max(if mesh.axes == 2 { 0.0 } else { b.distance(c).max(c.distance(a)) });
        assert!(longest < 2.0 * length, "{text}: {longest}");
    }
}

#[test]
fn outlines_close_around_the_area_of_their_shapes() {
    use std::f64::consts::PI;
    let two = |text: &str, expected: f64, tolerance: f64| check(text, Dimension::Two, expected, tolerance);
    two("Box(min: (0, 0), max: (1, 0.5))", 0.5, 1e-12);
    two("Polygon(points: [(0, 0), (0, 1), (1, 1), (0.5, 0.7)])", 0.4, 1e-12);
    two("Sphere(center: (0.2, 0.1), radius: 0.5)", 0.25 * PI, 1e-12);
    two("Ring(center: (0.2, 0.1), inner: 0.3, outer: 0.5)", 0.16 * PI, 1e-12);
    two(
        "Rotate(shape: Translate(shape: Box(min: (0, 0), max: (1, 0.5)), by: (1, 2)), angle_degrees: 30)",
        0.5,
        1e-12,
    );
    two("Scale(shape: Sphere(center: (0, 0), radius: 0.5), by: (2, 1))", 0.5 * PI, 1e-12);
}

#[test]
fn outlines_of_combinations_close_around_their_area() {
    use std::f64::consts::PI;
    let two = |text: &str, expected: f64, tolerance: f64| check(text, Dimension::Two, expected, tolerance);
    two(
        "Difference(Box(min: (0, 0), max: (1, 1)), Sphere(center: (0.5, 0.5), radius: 0.2))",
        1.0 - 0.04 * PI,
        1e-9,
    );
    two(
        "Difference(Box(min: (0, 0), max: (1, 1)), Sphere(center: (0, 0), radius: 0.5))",
        1.0 - PI / 16.0,
        1e-3,
    );
    two("Union([Box(min: (0, 0), max: (1, 1)), Box(min: (0.5, 0.5), max: (2, 0.75))])", 1.25, 1e-9);
    two("Union([Box(min: (0, 0), max: (1, 1)), Box(min: (1, 0), max: (2, 1))])", 2.0, 1e-9);
    two(
        "Intersection([HalfSpace(point: (0.5, 0.1), normal: (1, 1)), Box(min: (0, 0), max: (1, 1))])",
        0.18,
        1e-3,
    );
}

#[test]
fn outlines_that_go_over_into_each_other_close_around_their_area() {
    use std::f64::consts::PI;
    let two = |text: &str, expected: f64, tolerance: f64| check(text, Dimension::Two, expected, tolerance);
    let stadium = "Union([Box(min: (0, 0), max: (1, 0.5)), Sphere(center: (0, 0.25), radius: 0.25), Sphere(center: (1, 0.25), radius: 0.25)])";
    two(stadium, 0.5 + PI / 16.0, 2e-3);
    two(&format!("Difference(Box(min: (-1, -1), max: (2, 1)), {stadium})"), 5.5 - PI / 16.0, 2e-3);
    let belt = "Intersection([Ring(center: (0, 0), inner: 0.8, outer: 1.0), Box(min: (-1, 0), max: (1, 1))])";
    two(
        &format!("Union([{belt}, Box(min: (0.8, -1), max: (1, 0)), Box(min: (-1, -1), max: (-0.8, 0))])"),
        0.18 * PI + 0.4,
        2e-3,
    );
    // A rounded corner.
    two(
        "Difference(Box(min: (0, 0), max: (1, 1)), Difference(Box(min: (0.8, 0.8), max: (1.1, 1.1)), Sphere(center: (0.8, 0.8), radius: 0.2)))",
        1.0 - 0.04 * (1.0 - 0.25 * PI),
        2e-3,
    );
}

/// The grid planes of 5 cells are at the odd tenths of the length, and the common face of the boxes is on one
/// of them.
#[test]
fn parts_that_meet_on_a_plane_of_the_grid_are_one() {
    let boxes = "Union([Box(min: (0, 0, 0), max: (0.125, 0.2, 0.2)), Box(min: (0.125, 0, 0), max: (0.25, 0.2, 0.2))])";
    check(boxes, Dimension::Three, 0.01, 1e-5);
    let hole = "Difference(Box(min: (0, 0, 0), max: (0.25, 0.25, 0.25)), Union([Box(min: (0.05, 0.05, -1), max: (0.125, 0.2, 1)), Box(min: (0.125, 0.05, -1), max: (0.2, 0.2, 1))]))";
    check(hole, Dimension::Three, 0.01, 1e-5);
}

#[test]
fn surfaces_close_around_the_volume_of_their_shapes() {
    use std::f64::consts::PI;
    let three =
        |text: &str, expected: f64, tolerance: f64| check(text, Dimension::Three, expected, tolerance);
    three("Box(min: (0, 0, 0), max: (1, 0.5, 0.3))", 0.15, 1e-12);
    three("Sphere(center: (0.2, 0.1, 0), radius: 0.5)", PI / 6.0, 1e-12);
    three("Cylinder(from: (0, 0, 0), to: (0, 1, 0), radius: 0.3)", 0.09 * PI, 1e-12);
    three("Tube(from: (0, 0, 0), to: (0, 1, 1), inner: 0.2, outer: 0.3)", 0.05 * PI * 2f64.sqrt(), 1e-12);
    three("Extrusion(polygon: [(0, 0), (0, 1), (1, 1), (0.5, 0.7)], from: 0, to: 0.4)", 0.16, 1e-12);
    three(
        "Rotate(shape: Box(min: (0, 0, 0), max: (1, 1, 1)), axis: (1, 1, 0), angle_degrees: 30)",
        1.0,
        1e-12,
    );
    three(
        "Difference(Sphere(center: (0, 0, 0), radius: 0.5), Sphere(center: (0, 0, 0), radius: 0.25))",
        7.0 / 48.0 * PI,
        1e-12,
    );
    three("Shell(center: (0.2, 0.1, 0), inner: 0.25, outer: 0.5)", 7.0 / 48.0 * PI, 1e-12);
    three(
        "Difference(Cylinder(from: (0, 0, 0), to: (0, 1, 0), radius: 0.5), Cylinder(from: (0, 0, 0), to: (0, 1, 0), radius: 0.25))",
        0.1875 * PI,
        1e-12,
    );
    assert!(facets("Points(file: \"none.csv\")", Dimension::Three, 0.1).is_none());
}

#[test]
fn contoured_surfaces_of_combinations_close_around_their_volume() {
    use std::f64::consts::PI;
    let three =
        |text: &str, expected: f64, tolerance: f64| check(text, Dimension::Three, expected, tolerance);
    three(
        "Difference(Box(min: (0, 0, 0), max: (1, 1, 0.3)), Cylinder(from: (0.5, 0.5, -1), to: (0.5, 0.5, 1), radius: 0.2))",
        0.3 * (1.0 - 0.04 * PI),
        3e-3,
    );
    three(
        "Union([Box(min: (0, 0, 0), max: (1, 1, 0.5)), Box(min: (0.2, 0.2, 0.5), max: (0.6, 0.6, 1))])",
        0.58,
        1e-3,
    );
    three(
        "Intersection([Sphere(center: (0, 0, 0), radius: 0.5), HalfSpace(point: (0, 0, 0), normal: (1, 2, 2))])",
        PI / 12.0,
        1e-2,
    );
    three(
        "Rotate(shape: Difference(Box(min: (0, 0, 0), max: (1, 1, 1)), Box(min: (0.5, 0.5, -1), max: (2, 2, 2))), axis: (1, 1, 0), angle_degrees: 20)",
        0.75,
        1e-3,
    );
}

#[test]
fn contoured_facets_lie_on_the_faces_and_the_bore() {
    let text = "Difference(Box(min: (0, 0, 0), max: (1, 1, 0.3)), Cylinder(from: (0.5, 0.5, -1), to: (0.5, 0.5, 1), radius: 0.2))";
    let mesh = facets(text, Dimension::Three, 0.05).unwrap();
    let (mut bore, mut top) = (0.0, 0.0);
    for facet in 0..mesh.corners.len() {
        let (normal, area) = mesh.normal_and_measure(facet);
        let center = mesh.center(facet);
        let arm = (center - glam::DVec3::new(0.5, 0.5, center.z)).length();
        if normal.z > 0.99 && center.z > 0.29 {
            top += area;
        } else if normal.z.abs() < 0.1 && arm < 0.25 {
            bore += area;
        }
    }
    let exact_bore = 0.4 * std::f64::consts::PI * 0.3;
    let exact_top = 1.0 - 0.04 * std::f64::consts::PI;
    assert!((bore / exact_bore - 1.0).abs() < 0.01, "{bore} {exact_bore}");
    assert!((top / exact_top - 1.0).abs() < 0.01, "{top} {exact_top}");
}

#[test]
fn fans_of_long_triangles_leave_no_slivers() {
    // A turned part, the ends of which are fans of 24 triangles about 12 mm long.
    let mesh = facets("Mesh(file: \"assets/meshes/buffer.stl\", scale: 0.001)", Dimension::Three, 1e-3)
        .expect("a surface");
    assert!(is_closed(&mesh));
    let coarse = facets("Mesh(file: \"assets/meshes/buffer.stl\", scale: 0.001)", Dimension::Three, 6e-3)
        .expect("a surface");
    assert!((volume(&mesh) / volume(&coarse) - 1.0).abs() < 1e-6);
    let (mut area, mut at_end) = (0.0, 0);
    for facet in 0..mesh.corners.len() {
        let [a, b, c] = mesh.ends(facet);
        let longest = a.distance(b).max(b.distance(c)).max(c.distance(a));
        assert!(longest < 1.2001e-3, "{longest}");
        let (normal, measure) = mesh.normal_and_measure(facet);
        if normal.z > 0.999 && a.z > 0.0199 {
            area += measure;
            at_end += 1;
        }
    }
    // A grid of halved squares has two.
    let each = f64::from(at_end) * 1e-6 / area;
    assert!(at_end > 0 && each < 4.0, "{each} triangles for every square of the length");
}
