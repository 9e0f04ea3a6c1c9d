//! Rejected shapes, with the paths and messages of their errors.

use std::path::Path;

use super::{kind, shape, try_fill};
use crate::scene::Dimension::{self, Three, Two};
use crate::shapes::{FillErrorKind, Filling, Lattice, fill};

#[test]
fn numbers_that_cannot_be() {
    let cases: [(&str, Dimension, &str, &str); 28] = [
        (
            "Box(min: (0, 0), max: (1, 0))",
            Two,
            "shape.max",
            "the lower end of the y range must be below the upper end, found 0 and 0",
        ),
        (
            "Box(min: (0, 2, 0), max: (1, 1, 1))",
            Three,
            "shape.max",
            "the lower end of the y range must be below the upper end, found 2 and 1",
        ),
        (
            "Box(min: (0, 0), max: (1, 1))",
            Three,
            "shape.max",
            "the lower end of the z range must be below the upper end, found 0 and 0; a point with two components has z = 0",
        ),
        ("Box(min: (NaN, 0), max: (1, 1))", Two, "shape.min", "expected a finite number, found NaN"),
        ("Box(min: (0, 0), max: (1, inf))", Two, "shape.max", "expected a finite number, found inf"),
        (
            "Box(min: (0, 0, 1), max: (1, 1, 1))",
            Two,
            "shape.min",
            "z must be left out or 0 in two dimensions, found 1",
        ),
        (
            "HalfSpace(point: (0, 0), normal: (0, 0))",
            Two,
            "shape.normal",
            "the normal must not be a zero vector",
        ),
        (
            "Union([Box(min: (0, 0), max: (1, 1)), HalfSpace(point: (0, 0), normal: (0, 1))])",
            Two,
            "shape",
            "the shape is unbounded and cannot be filled with particles; cut it with others: `Intersection([Box(...), HalfSpace(...)])`",
        ),
        ("Sphere(center: (0, 0), radius: 0)", Two, "shape.radius", "must be greater than 0, found 0"),
        ("Sphere(center: (0, 0), radius: -1)", Two, "shape.radius", "must be greater than 0, found -1"),
        (
            "Ring(center: (0, 0), inner: 2, outer: 1)",
            Two,
            "shape.inner",
            "the inner radius 2 m must be less than the outer radius 1 m",
        ),
        ("Ring(center: (0, 0), inner: 0, outer: 1)", Two, "shape.inner", "must be greater than 0, found 0"),
        (
            "Cylinder(from: (1, 2, 3), to: (1, 2, 3), radius: 1)",
            Three,
            "shape.to",
            "`from` and `to` are the same point",
        ),
        (
            "Cylinder(from: (0, 0), to: (1, 0), radius: 1)",
            Two,
            "shape",
            "`Cylinder` is a shape of three dimensions only; use `Sphere` (a disc) or `Box`",
        ),
        (
            "Ring(center: (0, 0), inner: 1, outer: 2)",
            Three,
            "shape",
            "`Ring` is a shape of two dimensions only; use `Tube`",
        ),
        (
            "Tube(from: (0, 0), to: (1, 0), inner: 1, outer: 2)",
            Two,
            "shape",
            "`Tube` is a shape of three dimensions only; use `Ring`",
        ),
        (
            "Shell(center: (0, 0), inner: 1, outer: 2)",
            Two,
            "shape",
            "`Shell` is a shape of three dimensions only; use `Ring`",
        ),
        (
            "Polygon(points: [(0, 0), (1, 0), (0, 1)])",
            Three,
            "shape",
            "`Polygon` is a shape of two dimensions only; use `Extrusion`",
        ),
        (
            "Extrusion(polygon: [(0, 0), (1, 0), (0, 1)], from: 0, to: 1)",
            Two,
            "shape",
            "`Extrusion` is a shape of three dimensions only; use `Polygon`",
        ),
        (
            "Extrusion(polygon: [(0, 0), (1, 0), (0, 1)], from: 1, to: 0)",
            Three,
            "shape.to",
            "the lower end of the z range must be below the upper end, found 1 and 0",
        ),
        (
            "Polygon(points: [(0, 0), (1, 0)])",
            Two,
            "shape.points",
            "a polygon needs at least 3 points, found 2",
        ),
        (
            "Polygon(points: [(0, 0), (1, 0), (0, 1), (0, 0)])",
            Two,
            "shape.points",
            "points 3 and 0 of the polygon (counted from 0) are the same; leave one of them out; the first point is not repeated at the end",
        ),
        (
            "Polygon(points: [(0, 0), (1, 1), (1, 0), (0, 1)])",
            Two,
            "shape.points",
            "the polygon crosses or touches itself: the edges that start at points 0 and 2 (counted from 0) meet",
        ),
        ("Union([])", Two, "shape", "needs at least one shape"),
        (
            "Rotate(shape: Sphere(center: (0, 0), radius: 1), axis: (0, 0, 0), angle_degrees: 1)",
            Two,
            "shape.axis",
            "the axis must not be a zero vector",
        ),
        (
            "Rotate(shape: Sphere(center: (0, 0), radius: 1), axis: (1, 0, 0), angle_degrees: 1)",
            Two,
            "shape.axis",
            "in two dimensions the axis must be along z",
        ),
        (
            "Scale(shape: Sphere(center: (0, 0), radius: 1), by: (1, -1))",
            Two,
            "shape.by",
            "must be greater than 0, found -1",
        ),
        (
            "Difference(Sphere(center: (0, 0), radius: 1), Points(file: \"a.csv\"))",
            Two,
            "shape[1]",
            "a particle file encloses no region; it can fill a body, but not be combined with shapes, select particles, or be a rigid body or tool",
        ),
    ];
    for (text, dimension, path, message) in cases {
        let error = try_fill(text, Lattice::Regular, 0.1, dimension).unwrap_err();
        assert_eq!(error.to_string(), format!("{path}: {message}"), "{text}");
    }
}

#[test]
fn paths_lead_to_inner_shapes() {
    let bad = "Sphere(center: (0, 0), radius: 0)";
    let good = "Sphere(center: (0, 0), radius: 1)";
    for (text, path) in [
        (format!("Union([{good}, {good}, {bad}])"), "shape[0][2].radius"),
        (format!("Difference({good}, {bad})"), "shape[1].radius"),
        (format!("Translate(shape: Difference({bad}, {good}), by: (1, 1))"), "shape.shape[0].radius"),
        (format!("Intersection([Rotate(shape: {bad}, angle_degrees: 1)])"), "shape[0][0].shape.radius"),
    ] {
        assert_eq!(kind(&text, 0.1, Two).0, path);
    }
}

#[test]
fn polygons_that_touch_themselves() {
    for points in [
        "(0, 0), (2, 0), (2, 2), (1, 0), (0, 2)",
        "(0, 0), (2, 0), (1, 0), (1, 1)",
        "(0, 0), (1, 0), (2, 0)",
        "(0, 0), (4, 0), (4, 4), (2, 2), (0, 4), (2, 2)",
    ] {
        let (_, kind) = kind(&format!("Polygon(points: [{points}])"), 0.1, Two);
        assert!(matches!(kind, FillErrorKind::Crossing(..)), "{points}: {kind}");
    }
    let collinear = "Polygon(points: [(0, 0), (1, 0), (2, 0), (2, 2), (0, 2)])";
    assert!(try_fill(collinear, Lattice::Regular, 0.1, Two).is_ok());
}

#[test]
fn spacing() {
    for (spacing, message) in [
        (0.0, "must be greater than 0, found 0"),
        (-0.1, "must be greater than 0, found -0.1"),
        (f64::NAN, "expected a finite number, found NaN"),
        (f64::INFINITY, "expected a finite number, found inf"),
        (
            1e-6,
            "the body needs about 1e12 particles, more than the 1 000 000 that fit into memory; use a larger spacing",
        ),
        (
            1e-200,
            "the body needs too many particles to count, more than the 1 000 000 that fit into memory; use a larger spacing",
        ),
        (
            0.8,
            "the body must be at least 2 spacings thick along x, found 1.25; use a spacing of at most 0.5 m",
        ),
    ] {
        let error = try_fill("Box(min: (0, 0), max: (1, 1))", Lattice::Regular, spacing, Two).unwrap_err();
        assert_eq!(error.to_string(), format!("spacing: {message}"));
    }
    let far = "Union([Box(min: (0, 0), max: (0.1, 0.1)), Box(min: (1e6, 0), max: (1000000.1, 0.1))])";
    assert_eq!(try_fill(far, Lattice::Regular, 0.01, Two).unwrap().len(), 200);
    assert_eq!(try_fill(far, Lattice::Relaxed { seed: 0, iterations: 1 }, 0.01, Two).unwrap().len(), 200);
}

#[test]
fn thin_walls_are_found_where_the_box_about_the_body_is_not_thin() {
    let tank = |wall: f64| {
        format!(
            "Difference(Box(min: (-{wall}, -{wall}), max: ({}, 1)), Box(min: (0, 0), max: (1, 2)))",
            1.0 + wall
        )
    };
    assert!(try_fill(&tank(0.1), Lattice::Regular, 0.05, Two).is_ok());
    let (path, kind) = kind(&tank(0.05), 0.05, Two);
    assert_eq!(path, "spacing");
    let FillErrorKind::Thin { thickness, .. } = kind else { panic!("{kind}") };
    assert!((thickness - 0.05).abs() < 1e-8);
    for lattice in [Lattice::Hexagonal, Lattice::Relaxed { seed: 0, iterations: 1 }] {
        assert!(try_fill(&tank(0.05), lattice, 0.05, Two).is_err());
    }
    let ring = |inner: f64| format!("Ring(center: (0, 0), inner: {inner}, outer: 1)");
    assert!(try_fill(&ring(0.8), Lattice::Regular, 0.1, Two).is_ok());
    for inner in [0.88, 0.9, 0.97] {
        assert!(try_fill(&ring(inner), Lattice::Regular, 0.1, Two).is_err());
    }
    let slanted = "Cylinder(from: (0, 0, 0), to: (0.07, 0.07, 0.07), radius: 1)";
    assert!(try_fill(slanted, Lattice::Regular, 0.1, Three).is_err());
}

#[test]
fn coarse_round_bodies_and_wedges_are_not_thin() {
    for diameter in [2.0, 2.5, 3.0, 3.3, 4.0, 5.5, 7.0] {
        for lattice in [
            Lattice::Regular,
            Lattice::Hexagonal,
            Lattice::Concentric,
            Lattice::Relaxed { seed: 0, iterations: 6 },
        ] {
            let text = |center| format!("Sphere(center: {center}, radius: {})", 0.5 * diameter);
            try_fill(&text("(0, 0)"), lattice, 1.0, Two).unwrap();
            try_fill(&text("(0, 0, 0)"), lattice, 1.0, Three).unwrap();
        }
    }
    try_fill("Polygon(points: [(0, 0), (3, 0), (3, 1)])", Lattice::Regular, 0.05, Two).unwrap();
}

#[test]
fn nothing_left() {
    for text in [
        "Difference(Box(min: (0, 0), max: (1, 1)), Box(min: (-1, -1), max: (2, 2)))",
        "Intersection([Box(min: (0, 0), max: (1, 1)), Box(min: (2, 2), max: (3, 3))])",
        "Difference(Sphere(center: (0, 0), radius: 1), Sphere(center: (0, 0), radius: 1.5))",
        "Intersection([Sphere(center: (0, 0), radius: 1), Sphere(center: (5, 0), radius: 1)])",
    ] {
        let (path, kind) = kind(text, 0.1, Two);
        assert_eq!(path, "shape");
        assert!(matches!(kind, FillErrorKind::NoParticle(_)), "{text}: {kind}");
    }
}

#[test]
fn the_limit_is_kept() {
    let cube = shape("Box(min: (0, 0, 0), max: (1, 1, 1))");
    assert_eq!(
        fill(
            &cube,
            Filling {
                lattice: Lattice::Regular,
                spacing: 0.1,
                dimension: Three,
                folder: Path::new("."),
                limit: 1000,
                is_wall: false
            }
        )
        .unwrap()
        .len(),
        1000
    );
    let error = fill(
        &cube,
        Filling {
            lattice: Lattice::Regular,
            spacing: 0.1,
            dimension: Three,
            folder: Path::new("."),
            limit: 999,
            is_wall: false,
        },
    )
    .unwrap_err();
    assert!(matches!(error.kind, FillErrorKind::TooMany { limit: 999, .. }));
}

#[test]
fn endless_relaxation_is_refused() {
    let lattice = Lattice::Relaxed { seed: 0, iterations: u32::MAX };
    let error = try_fill("Sphere(center: (0, 0), radius: 1)", lattice, 0.1, Two).unwrap_err();
    assert_eq!(error.to_string(), "lattice.iterations: expected at most 1000 iterations, found 4294967295");
}

#[test]
fn a_turn_that_leaves_the_range_of_numbers_is_an_error() {
    let text = "Rotate(shape: Sphere(center: (1.7976931348623157e308, 1.7976931348623157e308, 0.0), radius: 1e16), axis: (0, 0, -1), angle_degrees: -1)";
    assert!(
        fill(
            &shape(text),
            Filling {
                lattice: Lattice::Concentric,
                spacing: 1e16,
                dimension: Three,
                folder: Path::new("."),
                limit: 300,
                is_wall: false
            }
        )
        .is_err()
    );
}

/// Numbers that result from a typing error or a wrong unit.
const ODD: [f64; 12] =
    [0.0, -1.0, 1.0, 0.5, 2.0, 1e-3, 1e-320, 1e16, -1e200, f64::MAX, f64::INFINITY, f64::NAN];

proptest::proptest! {
    #![proptest_config(proptest::prelude::ProptestConfig::with_cases(20))]
    #[test]
    fn odd_numbers_give_particles_or_an_error(n in proptest::array::uniform8(0usize..12), s in 0usize..12) {
        let v = n.map(|n| ODD[n]);
        let three = |a: usize, b: usize, c: usize| format!("({:?}, {:?}, {:?})", v[a], v[b], v[c]);
        let two = |a: usize, b: usize| format!("({:?}, {:?})", v[a], v[b]);
        let plane = [
            format!("Box(min: {}, max: {})", two(0, 1), two(2, 3)),
            format!("Sphere(center: {}, radius: {:?})", two(0, 1), v[2]),
            format!("Ring(center: {}, inner: {:?}, outer: {:?})", two(0, 1), v[2], v[3]),
            format!("Polygon(points: [{}, {}, {}, {}])", two(0, 1), two(2, 3), two(4, 5), two(6, 7)),
        ];
        let space = [
            format!("Box(min: {}, max: {})", three(0, 1, 2), three(3, 4, 5)),
            format!("Sphere(center: {}, radius: {:?})", three(0, 1, 2), v[3]),
            format!("Cylinder(from: {}, to: {}, radius: {:?})", three(0, 1, 2), three(3, 4, 5), v[6]),
            format!("Tube(from: {}, to: {}, inner: {:?}, outer: {:?})", three(0, 1, 2), three(3, 4, 5), v[6], v[7]),
            format!("Shell(center: {}, inner: {:?}, outer: {:?})", three(0, 1, 2), v[3], v[4]),
            format!("Extrusion(polygon: [{}, {}, {}], from: {:?}, to: {:?})", two(0, 1), two(2, 3), two(4, 5), v[6], v[7]),
        ];
        for (shapes, dimension) in [(&plane[..], Two), (&space[..], Three)] {
            for simple in shapes {
                for text in [
                    simple.clone(),
                    format!("Difference({simple}, Sphere(center: (0, 0), radius: 0.5))"),
                    format!("Rotate(shape: {simple}, axis: {}, angle_degrees: {:?})", three(5, 6, 7), v[4]),
                    format!("Scale(shape: {simple}, by: {})", three(5, 6, 7)),
                ] {
                    for lattice in [Lattice::Regular, Lattice::Hexagonal, Lattice::Concentric, Lattice::BodyFitted { iterations: 2 }, Lattice::Relaxed { seed: 0, iterations: 1 }] {
                        let filled = fill(&shape(&text), Filling { lattice, spacing: ODD[s], dimension, folder: Path::new("."), limit: 300, is_wall: false });
                        for site in filled.unwrap_or_default() {
                            assert!(site.position.is_finite() && site.volume > 0.0, "{text} {lattice:?} {}", ODD[s]);
                        }
                    }
                }
            }
        }
    }
}
