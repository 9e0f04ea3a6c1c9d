//! Rigid bodies that roll: round outlines touch like the circles that they are, however coarse the particles.

use glam::DVec3;

use super::rigid::momenta;
use super::{centre, simulation};
use crate::simulation::Simulation;

/// A body of that shape about (0, 0.1, 0) that starts on a floor with speed 1 m/s and the spin of rolling,
/// under gravity that leans by some degrees towards x.
fn rolling(dimension: &str, shape: &str, floor: &str, degrees: f64, speed: f64) -> Simulation {
    let (sine, cosine) = degrees.to_radians().sin_cos();
    simulation(&format!(
        r#"(dimension: {dimension}, gravity: ({}, {}, 0.0),
            materials: {{"steel": NeoHookean(density: 1000, young: 1e7, poisson: 0.3)}},
            bodies: [
                (name: "wheel", material: "steel", shape: {shape}, spacing: 0.02, velocity: ({speed:?}, 0, 0), formulation: Rigid(spin: (0, 0, {}))),
                (name: "floor", material: "steel", shape: {floor}, spacing: 0.02, formulation: Rigid()),
            ],
            conditions: [Fix(on: Select(body: "floor"))],
            contacts: [Contact(between: ("wheel", "floor"), friction: 0.6, restitution: 0.3)],
            time: (end: 0.5))"#,
        9.81 * sine,
        -9.81 * cosine,
        -10.0 * speed,
    ))
}

const PLANE: &str = "HalfSpace(point: (0, 0, 0), normal: (0, 1, 0))";

#[test]
fn a_ring_rolls_on_at_its_speed() {
    let ring = "Ring(center: (0, 0.1), inner: 0.06, outer: 0.1)";
    let drilled = "Difference(Sphere(center: (0, 0.1), radius: 0.1), Sphere(center: (0, 0.1), radius: 0.06))";
    for (shape, floor) in [(ring, PLANE), (drilled, PLANE), (ring, "Box(min: (-0.2, -0.1), max: (1.0, 0.0))")]
    {
        let mut sim = rolling("Two", shape, floor, 0.0, 1.0);
        sim.run(|_| true).expect("a run");
        let (x, v) = centre(&sim, 0);
        assert!(v.distance(DVec3::X) < 2e-3 && (x.x - 0.5).abs() < 1e-3, "{shape} on {floor}: {x} {v}");
    }
}

/// `x = g sin(a) t^2 / (2 (1 + k))`, with the inertia `k m R^2` about the axis.
#[test]
fn wheels_accelerate_down_a_slope_as_their_inertia_says() {
    let ends = "from: (0, 0.1, -0.05), to: (0, 0.1, 0.05)";
    let ratio = |power: i32| 0.6f64.powi(power);
    let of_shell = 0.4 * (1.0 - ratio(5)) / (1.0 - ratio(3));
    for (shape, k) in [
        (format!("Cylinder({ends}, radius: 0.1)"), 0.5),
        ("Scale(shape: Cylinder(from: (0, 0.05, -0.02), to: (0, 0.05, 0.02), radius: 0.05), by: (2, 2, 2))".to_owned(), 0.5),
        (format!("Tube({ends}, inner: 0.06, outer: 0.1)"), 0.5 * (1.0 + ratio(2))),
        ("Shell(center: (0, 0.1, 0), inner: 0.06, outer: 0.1)".to_owned(), of_shell),
    ] {
        let mut sim = rolling("Three", &shape, PLANE, 20.0, 0.0);
        sim.run(|_| true).expect("a run");
        let x = centre(&sim, 0).0.x;
        let expected = 0.5 * 9.81 * 20f64.to_radians().sin() * 0.25 / (1.0 + k);
        assert!((x / expected - 1.0).abs() < 5e-3, "{shape}: {x} {expected}");
    }
}

/// A ring that falls with its middle on the corner of a box is thrown straight back: the normal there is the
/// line to its centre, not that of a face.
#[test]
fn a_ring_that_meets_a_corner_is_pushed_along_the_line_to_its_centre() {
    let mut sim = simulation(
        r#"(dimension: Two, materials: {"steel": NeoHookean(density: 1000, young: 1e7, poisson: 0.3)},
            bodies: [
                (name: "ring", material: "steel", shape: Ring(center: (0.0, 0.101), inner: 0.06, outer: 0.1), spacing: 0.02, velocity: (0, -1, 0), formulation: Rigid()),
                (name: "edge", material: "steel", shape: Polygon(points: [(0, 0), (-0.1, -0.1), (0, -0.2), (0.1, -0.1)]), spacing: 0.02, formulation: Rigid()),
            ],
            conditions: [Fix(on: Select(body: "edge"))],
            contacts: [Contact(between: ("ring", "edge"))],
            time: (end: 0.05))"#,
    );
    sim.run(|_| true).expect("a run");
    let (_, v) = centre(&sim, 0);
    assert!(v.distance(DVec3::Y) < 5e-3, "{v}");
}

/// A cylinder that stands on its end stays where it is.
#[test]
fn a_cylinder_stands_on_its_end() {
    let standing = "Cylinder(from: (0, 0, 0), to: (0, 0.2, 0), radius: 0.05)";
    let mut sim = rolling("Three", standing, PLANE, 10.0, 0.0);
    sim.run(|_| true).expect("a run");
    // It would tip over at 26.6 degrees, and slide at 31.
    let (x, v) = centre(&sim, 0);
    assert!(x.distance(DVec3::new(0.0, 0.1, 0.0)) < 2e-3 && v.length() < 1e-2, "{x} {v}");
}

/// A ring around another one, and a box in a ring: their inner sides touch as before.
#[test]
fn what_lies_in_a_ring_touches_its_inner_side() {
    let pair = |inner: &str| {
        let mut sim = simulation(&format!(
            r#"(dimension: Two, gravity: (0, -9.81),
                materials: {{"steel": NeoHookean(density: 1000, young: 1e7, poisson: 0.3)}},
                bodies: [
                    (name: "drum", material: "steel", shape: Ring(center: (0, 0), inner: 0.2, outer: 0.25), spacing: 0.02, formulation: Rigid()),
                    (name: "inside", material: "steel", shape: {inner}, spacing: 0.02, formulation: Rigid()),
                ],
                conditions: [Fix(on: Select(body: "drum"))],
                contacts: [Contact(between: ("drum", "inside"), friction: 0.6, restitution: 0.1)],
                time: (end: 1.0))"#
        ));
        sim.run(|_| true).expect("a run");
        centre(&sim, 1)
    };
    // Surfaces that all but touch do not overlap, however near the particles are.
    let (disc, _) = pair("Sphere(center: (0, -0.0999), radius: 0.1)");
    assert!((disc.y + 0.1).abs() < 1e-3, "{disc}");
    let (ring, _) = pair("Ring(center: (0, -0.09), inner: 0.05, outer: 0.1)");
    assert!((ring.y + 0.1).abs() < 1e-3, "{ring}");
    // Corners at (+-0.05, y - 0.05) on the circle of 0.2.
    let (block, v) = pair("Box(min: (-0.05, -0.19), max: (0.05, -0.09))");
    let expected = 0.05 - (0.04f64 - 0.0025).sqrt();
    assert!((block.y - expected).abs() < 2e-3 && v.length() < 1e-2, "{block} {expected} {v}");
}

/// On the ridge of a cylinder, between two of its rims, and whichever body the contact names first.
#[test]
fn a_shell_rests_on_a_cylinder() {
    for between in [r#""shell", "cylinder""#, r#""cylinder", "shell""#] {
        let mut sim = simulation(&format!(
            r#"(dimension: Three, gravity: (0, -9.81, 0),
                materials: {{"steel": NeoHookean(density: 1000, young: 1e7, poisson: 0.3)}},
                bodies: [
                    (name: "shell", material: "steel", shape: Shell(center: (0.013, 0.15, 0), inner: 0.01, outer: 0.05), spacing: 0.02, formulation: Rigid()),
                    (name: "cylinder", material: "steel", shape: Cylinder(from: (-0.2, 0, 0), to: (0.2, 0, 0), radius: 0.1), spacing: 0.02, formulation: Rigid()),
                ],
                conditions: [Fix(on: Select(body: "cylinder"))],
                contacts: [Contact(between: ({between}), friction: 0.3, restitution: 0.1)],
                time: (end: 0.2))"#
        ));
        sim.run(|_| true).expect("a run");
        let (x, v) = centre(&sim, 0);
        assert!(x.distance(DVec3::new(0.013, 0.15, 0.0)) < 1e-4 && v.length() < 1e-3, "{between}: {x} {v}");
    }
}

/// A box and a coin that slide over the edge of a table, round or straight: as they tip, they lie in the
/// plane of a rim, of the table or of their own, by as little as they press on the table, and far behind the
/// sides of cylinders.
#[test]
fn what_slides_over_a_rim_is_not_thrown() {
    let speed = |table: &str, slider: &str| {
        let mut sim = simulation(&format!(
            r#"(dimension: Three, gravity: (0, 0, -9.81),
                materials: {{"gel": NeoHookean(density: 1000, young: 2e4, poisson: 0.3)}},
                bodies: [
                    (name: "table", material: "gel", shape: {table}, spacing: 0.03, formulation: Rigid()),
                    (name: "slider", material: "gel", shape: {slider}, spacing: 0.015, velocity: (1, 0, 0), formulation: Rigid()),
                ],
                conditions: [Fix(on: Select(body: "table"))],
                contacts: [Contact(between: ("slider", "table"))],
                time: (end: 0.2))"#
        ));
        sim.run(|_| true).expect("a run");
        assert!(sim.ledger().relative_error().abs() < 2e-3, "{} {table}", sim.ledger().relative_error());
        let (_, v) = centre(&sim, 1);
        assert!(v.z < -1.0, "{slider} on {table}: {v}");
        v.x
    };
    let round = "Cylinder(from: (0, 0, -0.06), to: (0, 0, 0), radius: 0.26)";
    let straight = "Box(min: (-0.2, -0.3, -0.06), max: (0.26, 0.3, 0))";
    let block = "Box(min: (0.17, -0.03, 0), max: (0.23, 0.03, 0.03))";
    let coin = "Cylinder(from: (0.2, 0, 0), to: (0.2, 0, 0.03), radius: 0.03)";
    for slider in [block, coin] {
        let [on_round, on_straight] = [round, straight].map(|table| speed(table, slider));
        // The same as over a straight edge: the rim falls back by 2 mm within the width of the slider.
        assert!((on_round - on_straight).abs() < 0.01, "{slider}: {on_round} {on_straight}");
        assert!((on_straight - 1.0).abs() < 0.03, "{slider}: {on_straight}");
    }
}

/// Cylinders that spin and meet a box or another one in any direction: with their edges, ends and sides.
#[test]
fn cylinders_that_meet_in_any_direction_keep_their_energy() {
    const STANDING: &str = "Cylinder(from: (0, 0, -0.03), to: (0, 0, 0.03), radius: 0.05)";
    const BOX: &str = "Box(min: (-0.05, -0.03, -0.02), max: (0.05, 0.03, 0.02))";
    /// Axis and angle by which a body is turned, its place and its angular velocity.
    type Turned = (&'static str, &'static str, f64, &'static str, &'static str);
    let hit: [[Turned; 2]; 4] = [
        [
            (STANDING, "(0.75, -0.999, 0.254)", 44.6, "(0, 0, 0)", "(4.59, 4.18, 2.9)"),
            (BOX, "(0.0856, 0.152, 0.655)", 177.0, "(0.16, -0.0171, 0.0483)", "(2.3, -0.676, 0.601)"),
        ],
        [
            (STANDING, "(-0.505, 0.998, -0.581)", 116.0, "(0, 0, 0)", "(-3.74, 2.05, -4.15)"),
            (STANDING, "(-0.616, 0.661, -0.821)", 42.2, "(0.16, -0.0273, 0.0462)", "(-0.409, -0.469, -0.05)"),
        ],
        [
            (STANDING, "(0.998, -0.473, -0.601)", 9.85, "(0, 0, 0)", "(-4.92, 4.83, 3.22)"),
            (STANDING, "(-0.269, 0.631, 0.521)", 62.9, "(0.16, -0.0176, 0.012)", "(-3.06, -4.76, 1.92)"),
        ],
        [
            (STANDING, "(0.586, -0.0936, -0.00346)", 3.45, "(0, 0, 0)", "(-3.56, -0.375, 1.72)"),
            (STANDING, "(0.094, 0.511, -0.132)", 31.7, "(0.16, -0.0461, 0.0196)", "(-0.676, -1.28, 3.52)"),
        ],
    ];
    for pair in hit {
        let body = |name: &str, velocity: f64, (shape, axis, degrees, by, spin): Turned| {
            format!(
                r#"(name: "{name}", material: "steel", shape: Translate(shape: Rotate(shape: {shape}, axis: {axis}, angle_degrees: {degrees:?}), by: {by}), spacing: 0.02, velocity: ({velocity:?}, 0, 0), formulation: Rigid(spin: {spin}))"#
            )
        };
        let mut sim = simulation(&format!(
            r#"(dimension: Three, materials: {{"steel": NeoHookean(density: 1000, young: 1e8, poisson: 0.3)}},
                bodies: [{}, {}],
                contacts: [Contact(between: ("one", "two"))],
                time: (end: 0.1))"#,
            body("one", 0.0, pair[0]),
            body("two", -2.0, pair[1]),
        ));
        sim.start().expect("a start");
        let (p, l) = momenta(&sim);
        sim.run(|_| true).expect("a run");
        let (q, m) = momenta(&sim);
        assert!((q - p).length() < 1e-12 * p.length() && (m - l).length() < 1e-11 * l.length(), "{pair:?}");
        assert!(centre(&sim, 0).1.length() > 0.2, "they meet");
        let error = sim.ledger().relative_error();
        assert!(error.abs() < 3e-3, "{pair:?}: {error}");
    }
}

#[test]
fn rings_that_meet_keep_momentum_angular_momentum_and_energy() {
    let mut sim = simulation(
        r#"(dimension: Two, materials: {"steel": NeoHookean(density: 1000, young: 1e7, poisson: 0.3)},
            bodies: [
                (name: "one", material: "steel", shape: Ring(center: (0, 0), inner: 0.06, outer: 0.1), spacing: 0.02, velocity: (1, 0, 0), formulation: Rigid(spin: (0, 0, 5))),
                (name: "two", material: "steel", shape: Ring(center: (0.25, 0.08), inner: 0.05, outer: 0.09), spacing: 0.02, formulation: Rigid()),
            ],
            contacts: [Contact(between: ("one", "two"), friction: 0.3)],
            time: (end: 0.2))"#,
    );
    sim.start().expect("a start");
    let (p, l) = momenta(&sim);
    sim.run(|_| true).expect("a run");
    let (q, m) = momenta(&sim);
    assert!((q - p).length() < 1e-12 * p.length(), "{p} {q}");
    assert!((m - l).length() < 1e-12 * l.length(), "{l} {m}");
    assert!(centre(&sim, 1).1.length() > 0.1 && sim.ledger().total_named("friction") > 0.0);
    assert!(sim.ledger().relative_error().abs() < 5e-3, "{}", sim.ledger().relative_error());
}
