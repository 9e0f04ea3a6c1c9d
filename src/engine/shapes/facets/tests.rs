//! Facets of shapes: closed, outward, of the right volume and length.

use std::collections::BTreeMap;
use std::path::Path;

use super::Facets;
use crate::shapes::Shape;
use crate::space::Dimension;

fn facets(text: &str, dimension: Dimension, length: f64) -> Option<Facets> {
    let shape: Shape = ron::from_str(text).unwrap_or_else(|e| panic!("{text}: {e}"));
    shape.facets(dimension, Path::new("."), length)
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

/// Every end (edge) belongs to two facets, which go through it in opposite directions.
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
    assert!(facets("Points(file: \"none.csv\")", Dimension::Three, 0.1).is_none());
}
