//! Impacts of rigid bodies on each other: restitution, momenta and energy.

use glam::DVec3;

use super::rigid::momenta;
use super::{centre, simulation};
use crate::rigid::RigidBodies;
use crate::simulation::Simulation;

/// A block that meets another one at 2 m/s; the upper one is turned about z by some degrees and moved along
/// x.
struct Meeting {
    dimension: &'static str,
    /// Density of the lower one over that of the upper one.
    ratio: f64,
    degrees: f64,
    moved: f64,
}

impl Meeting {
    fn scene(&self, restitution: f64) -> String {
        let Self { dimension, ratio, degrees, moved } = self;
        let is_flat = *dimension == "Two";
        let at =
            |x: f64, y: f64, z: f64| if is_flat { format!("({x}, {y})") } else { format!("({x}, {y}, {z})") };
        let body = |name: &str, shape: String, speed: f64| {
            format!(
                r#"(name: "{name}", material: "{name}", shape: {shape}, spacing: 0.02, formulation: Rigid(), velocity: {}),"#,
                at(0.0, speed, 0.0)
            )
        };
        let block = |low: [f64; 3], high: [f64; 3]| {
            let [low, high] = [low, high].map(|[x, y, z]| at(x, y, z));
            format!("Box(min: {low}, max: {high})")
        };
        let upper = block([*moved, 0.0, 0.0], [0.1 + moved, 0.06, 0.08]);
        let upper = format!(
            "Rotate(shape: {upper}, axis: (0, 0, 1), angle_degrees: {degrees:?}, about: {})",
            at(*moved, 0.0, 0.0)
        );
        format!(
            r#"(dimension: {dimension},
                materials: {{"upper": NeoHookean(density: 1000, young: 1e9, poisson: 0.3), "lower": NeoHookean(density: {}, young: 1e9, poisson: 0.3)}},
                bodies: [{}{}],
                contacts: [Contact(between: ("upper", "lower"), restitution: {restitution})],
                time: (end: 0.012))"#,
            1000.0 * ratio,
            body("lower", block([0.0, -0.061, 0.0], [0.1, -0.001, 0.08]), 1.0),
            body("upper", upper, -1.0),
        )
    }

    /// How fast the lowest point of the upper block moves against the lower one along y, m/s.
    fn speed(&self, sim: &Simulation) -> f64 {
        let bodies = sim.resources().get::<RigidBodies>();
        let [lower, upper] = &bodies[..] else { panic!("two bodies") };
        let place = if self.degrees == 0.0 {
            upper.state.center
        } else {
            upper.place(DVec3::new(self.moved, 0.0, if self.dimension == "Two" { 0.0 } else { 0.04 }))
        };
        (upper.velocity_at(place) - lower.velocity_at(place)).y
    }
}

/// Face on face, edge on face, and beside the middle; light on heavy.
#[test]
fn two_free_blocks_part_with_the_restitution_that_is_asked_for() {
    let flat = Meeting { dimension: "Two", ratio: 1.0, degrees: 0.0, moved: 0.0 };
    for meeting in [
        Meeting { ..flat },
        Meeting { ratio: 3.0, ..flat },
        Meeting { dimension: "Three", ratio: 0.5, ..flat },
        Meeting { degrees: 20.0, moved: 0.031, ..flat },
        Meeting { dimension: "Three", degrees: 50.0, moved: 0.033, ratio: 2.0 },
    ] {
        for wanted in [0.9, 0.5, 0.1] {
            let mut sim = simulation(&meeting.scene(wanted));
            sim.start().expect("a start");
            let ((p, l), before) = (momenta(&sim), meeting.speed(&sim));
            // Until they have parted: bodies that turn may meet again.
            let mut has_met = false;
            while !sim.is_finished() {
                sim.step().expect("a step");
                let touches = sim.ledger().total_named("contact") > 0.0;
                if has_met && !touches {
                    break;
                }
                has_met |= touches;
            }
            let ((q, m), after) = (momenta(&sim), meeting.speed(&sim));
            let Meeting { dimension, ratio, degrees, .. } = meeting;
            let case = format!("{dimension} {ratio} {degrees} {wanted}");
            assert!((after / -before - wanted).abs() < 0.02, "{case}: {after} of {before}");
            let size = sim.resources().get::<RigidBodies>().iter().map(|body| body.mass).sum::<f64>();
            assert!(
                (q - p).length() < 1e-12 * size && (m - l).length() < 1e-12 * size,
                "{case}: {p} {q} {l} {m}"
            );
            assert!(sim.ledger().relative_error().abs() < 5e-3, "{case}: {}", sim.ledger().relative_error());
        }
    }
}

/// A block that lands on one corner hops along a floor without friction; the points of the floor come under
/// its face at its ends.
#[test]
fn a_block_that_hops_over_the_points_of_a_floor_keeps_its_energy() {
    let mut sim = simulation(
        r#"(dimension: Two, gravity: (0, -9.81), materials: {"stone": NeoHookean(density: 1000, young: 1e7, poisson: 0.3)},
            bodies: [
                (name: "floor", material: "stone", shape: Box(min: (-0.3, -0.05), max: (0.8, 0.0)), spacing: 0.02, formulation: Rigid()),
                (name: "block", material: "stone", spacing: 0.02, formulation: Rigid(), velocity: (0.3, 0),
                 shape: Rotate(shape: Box(min: (-0.05, 0.02), max: (0.05, 0.07)), axis: (0, 0, 1), angle_degrees: 15, about: (0, 0))),
            ],
            conditions: [Fix(on: Select(body: "floor"))],
            contacts: [Contact(between: ("floor", "block"))],
            time: (end: 1.0))"#,
    );
    sim.run(|_| true).expect("a run");
    let error = sim.ledger().relative_error();
    assert!(error.abs() < 3e-3 && centre(&sim, 1).0.x > 0.2, "{error}");
}

/// `U = m g d / 2` with the drop d of its centre, however long the steps are: a dashpot does not carry
/// weight.
#[test]
fn a_block_at_rest_is_carried_by_its_springs_alone() {
    for (step, restitution) in [("5e-5", 0.1), ("1e-5", 0.1), ("5e-5", 0.5)] {
        let mut sim = simulation(&format!(
            r#"(dimension: Two, gravity: (0, -10), materials: {{"stone": NeoHookean(density: 1000, young: 1e7, poisson: 0.3)}},
                bodies: [
                    (name: "floor", material: "stone", shape: Box(min: (-0.05, -0.05), max: (0.15, 0)), spacing: 0.02, formulation: Rigid()),
                    (name: "block", material: "stone", shape: Box(min: (0, 0), max: (0.1, 0.06)), spacing: 0.02, formulation: Rigid()),
                ],
                conditions: [Fix(on: Select(body: "floor"))],
                contacts: [Contact(between: ("floor", "block"), friction: 0.3, restitution: {restitution})],
                time: (end: 0.05, step: Fixed({step})))"#
        ));
        sim.run(|_| true).expect("a run");
        let (x, v) = centre(&sim, 1);
        let ratio = sim.ledger().total_named("contact") / (0.5 * 60.0 * (0.03 - x.y));
        assert!((ratio - 1.0).abs() < 1e-4 && v.length() < 1e-6, "{step} {restitution}: {ratio} {v}");
    }
}

/// The masses of two tables that carry it are shared, and the points half a spacing inside of its ends push
/// it straight up.
#[test]
fn a_block_that_lands_on_two_tables_rebounds_straight_up() {
    let mut sim = simulation(
        r#"(dimension: Two, materials: {"stone": NeoHookean(density: 1000, young: 1e7, poisson: 0.3)},
            bodies: [
                (name: "table 1", material: "stone", shape: Box(min: (-0.05, -0.05), max: (0.04, 0)), spacing: 0.01, formulation: Rigid()),
                (name: "table 2", material: "stone", shape: Box(min: (0.06, -0.05), max: (0.15, 0)), spacing: 0.01, formulation: Rigid()),
                (name: "block", material: "stone", shape: Box(min: (0, 0.001), max: (0.1, 0.051)), spacing: 0.01, formulation: Rigid(), velocity: (0, -1)),
            ],
            conditions: [Fix(on: Select(body: "table 1")), Fix(on: Select(body: "table 2"))],
            contacts: [Contact(between: ("block", "table*"), restitution: 0.5)],
            time: (end: 0.01))"#,
    );
    sim.run(|_| true).expect("a run");
    let (_, v) = centre(&sim, 2);
    assert!((v.y - 0.5).abs() < 0.02 && v.x.abs() < 1e-6, "{v}");
}

/// Points of a face are the same on both sides of a block, wherever it is: round-off decided which face of a
/// corner the particle beside it had a point on, and the block rocked as it sprang.
#[test]
fn a_block_that_lands_flat_does_not_turn() {
    for (dimension, x, y) in [("Two", 0.0, 0.0), ("Two", 0.04, 0.0), ("Two", -0.1, 1e-7), ("Three", 0.0, 0.0)]
    {
        let at = |x: f64, y: f64| {
            if dimension == "Two" { format!("({x}, {y})") } else { format!("({x}, {y}, {x})") }
        };
        let down = if dimension == "Two" { "(0, -9.81)" } else { "(0, -9.81, 0)" };
        let mut sim = simulation(&format!(
            r#"(dimension: {dimension}, gravity: {down}, materials: {{"stone": StVenantKirchhoff(density: 1000, young: 1e8, poisson: 0.3)}},
                bodies: [
                    (name: "floor", material: "stone", shape: Box(min: {}, max: {}), spacing: 0.02, formulation: Rigid()),
                    (name: "block", material: "stone", shape: Box(min: {}, max: {}), spacing: 0.02, formulation: Rigid()),
                ],
                conditions: [Fix(on: Select(body: "floor"))],
                contacts: [Contact(between: ("block", "floor"), friction: 0.5)],
                time: (end: 3e-3))"#,
            at(-0.2, -0.1),
            at(0.4, 0.0),
            at(x, y),
            at(x + 0.2, y + 0.1),
        ));
        sim.run(|_| true).expect("a run");
        let bodies = sim.resources().get::<RigidBodies>();
        let block = bodies.iter().find(|body| body.mass < 30.0).expect("the block");
        let turned = block.state.rotation.xyz().length();
        let slipped = sim.ledger().total_named("friction");
        assert!(turned < 1e-12 && slipped.abs() < 1e-12, "{dimension} {x} {y}: {turned} {slipped}");
    }
}

/// The edge of a wedge of 60 degrees, turned by 20, falls at 8 m/s beside the right-angled ridge of a roof,
/// with overlaps of a quarter of a spacing. One of its sides is nearly parallel to the roof that it meets and
/// stands across the other one: its points come in below the ridge, at the depth of the overlap.
#[test]
fn a_wedge_that_glances_off_a_ridge_keeps_its_energy() {
    let (sin, cos) = 20.0_f64.to_radians().sin_cos();
    for beside in [0.004, 0.006, 0.008, 0.01] {
        let half = 0.5 * 30.0_f64.to_radians().tan();
        let corners = [(0.0, 0.0), (half, 0.5), (-half, 0.5)];
        let corner = |(x, y): (f64, f64)| (beside + x * cos - y * sin, 0.01 + x * sin + y * cos);
        let wedge: Vec<_> = corners.into_iter().map(corner).collect();
        let text = format!(
            r#"(dimension: Two, materials: {{"m": NeoHookean(density: 1000, young: 1e8, poisson: 0.3)}},
                bodies: [
                    (name: "wedge", material: "m", shape: Polygon(points: {wedge:?}), spacing: 0.03, velocity: (0, -8), formulation: Rigid()),
                    (name: "roof", material: "m", shape: Polygon(points: [(0, 0), (-0.2, -0.2), (0, -0.6), (0.2, -0.2)]), spacing: 0.03, formulation: Rigid()),
                ],
                conditions: [Fix(on: Select(body: "roof"))],
                contacts: [Contact(between: ("wedge", "roof"))],
                time: (end: 0.02))"#
        );
        let mut sim = simulation(&text);
        sim.run(|_| true).expect("the run ends");
        let error = sim.ledger().relative_error();
        assert!(error.abs() < 5e-3, "{beside} m beside the ridge: {error}");
    }
}
