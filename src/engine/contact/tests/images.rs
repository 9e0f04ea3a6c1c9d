//! Contact across periodic sides and symmetry planes.

use super::{centre, momentum, simulation};
use crate::simulation::Simulation;
use crate::world::{BodyId, Position, ReferencePosition, Velocity};

#[test]
fn bodies_meet_across_a_periodic_side() {
    // Driven apart, they meet on the other side, 0.01 m away.
    let formulations = [("TotalLagrangian", 1e6), ("Rigid()", 1e7)];
    let surfaces = ["Particles", "Skin"];
    for ((formulation, stiff), surface) in formulations.into_iter().flat_map(|f| surfaces.map(|s| (f, s))) {
        let mut sim = simulation(&format!(
            r#"(dimension: Two, domain: (min: (0, -1), max: (0.2, 1), periodic: [X]),
                materials: {{"soft": NeoHookean(density: 1000, young: {stiff:e}, poisson: 0.3)}},
                bodies: [
                    (name: "left", material: "soft", shape: Box(min: (0.005, 0), max: (0.045, 0.04)), spacing: 0.01,
                     formulation: TotalLagrangian, velocity: (-1, 0)),
                    (name: "right", material: "soft", shape: Box(min: (0.155, 0), max: (0.195, 0.04)), spacing: 0.01,
                     formulation: {formulation}, velocity: (1, 0.2)),
                ],
                contacts: [Contact(between: ("left", "right"), law: Penalty(), surface: {surface}, friction: 0.2)],
                time: (end: 0.02, step: Adaptive(factor: 0.25)))"#
        ));
        assert!(
            sim.warnings().iter().all(|warning| !warning.contains("touches with")),
            "{:?}",
            sim.warnings()
        );
        sim.start().unwrap();
        let before = momentum(&sim);
        sim.run(|_| true).unwrap();
        let ((_, left), (_, right)) = (centre(&sim, 0), centre(&sim, 1));
        assert!(left.x > 0.5 && right.x < -0.5, "{formulation}: {left} {right}");
        assert!((momentum(&sim) - before).length() < 1e-12 * before.length(), "{formulation}");
        assert!(sim.ledger().relative_error().abs() < 5e-3, "{}", sim.ledger().relative_error());
    }
}

/// A strip as long as the period that slides on another one, deformable or rigid: neither has an end.
fn endless_strips(floor: &str, held: &str, friction: f64) -> Simulation {
    simulation(&format!(
        r#"(dimension: Two, gravity: (0, -10), domain: (min: (0, -1), max: (0.08, 1), periodic: [X]),
            materials: {{"soft": NeoHookean(density: 1000, young: 1e6, poisson: 0.3)}},
            bodies: [
                (name: "strip", material: "soft", shape: Box(min: (0, 0), max: (0.08, 0.04)), spacing: 0.01,
                 formulation: TotalLagrangian, velocity: (0.4, 0)),
                (name: "floor", material: "soft", shape: {floor}),
            ],
            conditions: [Fix(on: Select(body: "floor"{held}))],
            contacts: [Contact(between: ("strip", "floor"), friction: {friction}, restitution: 0.5)],
            time: (end: 0.1))"#
    ))
}

#[test]
fn strips_without_ends_slide_by_coulomb_across_periodic_sides() {
    let floors = [
        ("Box(min: (0, -0.04), max: (0.08, 0)), spacing: 0.01, formulation: TotalLagrangian", ", face: MinY"),
        ("Box(min: (0, -0.04), max: (0.08, 0)), spacing: 0.01, formulation: Rigid()", ""),
        ("HalfSpace(point: (0, 0), normal: (0, 1)), spacing: 0.01, formulation: Rigid()", ""),
    ];
    for ((floor, held), friction) in floors.into_iter().flat_map(|floor| [(floor, 0.0), (floor, 0.3)]) {
        let mut sim = endless_strips(floor, held, friction);
        sim.run(|_| true).unwrap();
        let (place, velocity) = centre(&sim, 0);
        let expected = 0.4 - friction * 10.0 * 0.1;
        assert!((velocity.x - expected).abs() < 0.004, "{floor} {friction}: {velocity}");
        assert!((place.x - 0.04 - 0.05 * (0.4 + expected)).abs() < 1e-3, "{floor} {friction}: {place}");
        // Every column of particles is as high as the others.
        let (view, rows) = sim.world().body_view(BodyId(0));
        let x = view.read::<Position>().unwrap();
        let heights: Vec<f64> = rows.map(|row| x[row].0.y).filter(|y| *y < 0.01).collect();
        let (low, high) =
            heights.iter().fold((1.0_f64, 0.0_f64), |(low, high), y| (low.min(*y), high.max(*y)));
        // With friction an undamped body chatters.
        let even = if friction == 0.0 { 1e-6 } else { 1e-4 };
        assert!(heights.len() == 8 && high - low < even, "{floor} {friction}: {low} {high}");
    }
}

/// Places and velocities of the particles of all bodies below a height in the reference, by their reference
/// places.
fn lower(sim: &Simulation, height: f64) -> Vec<[glam::DVec3; 3]> {
    let mut found = Vec::new();
    for k in 0..sim.world().bodies().len() {
        let (view, rows) = sim.world().body_view(BodyId(k));
        let (x, v) = (view.read::<Position>().unwrap(), view.read::<Velocity>().unwrap());
        let reference = view.read::<ReferencePosition>().unwrap();
        let below = rows.filter(|&row| reference[row].0.y < height);
        found.extend(below.map(|row| [reference[row].0, x[row].0, v[row].0]));
    }
    let key = |row: &[glam::DVec3; 3]| row[0].to_array().map(|c| (1e6 * c).round() as i64);
    found.sort_by_key(key);
    found
}

fn assert_same_half(whole: &Simulation, half: &Simulation, height: f64) {
    let (whole, half) = (lower(whole, height), lower(half, height));
    assert_eq!(whole.len(), half.len());
    let worst = whole.iter().zip(&half).map(|(a, b)| a[1].distance(b[1])).fold(0.0, f64::max);
    let moved = whole.iter().map(|row| row[0].distance(row[1])).fold(0.0, f64::max);
    assert!(worst < 1e-6 * moved, "{worst} of {moved}");
}

#[test]
fn half_a_fork_that_closes_on_its_own_image_is_half_of_the_whole() {
    let scene = |height: f64, conditions: &str| {
        simulation(&format!(
            r#"(dimension: Two,
            materials: {{"soft": NeoHookean(density: 1000, young: 1e6, poisson: 0.3)}},
            bodies: [(name: "fork", material: "soft", spacing: 0.01, formulation: TotalLagrangian,
                shape: Difference(Box(min: (0, 0), max: (0.2, {height})), Box(min: (0.04, 0.04), max: (0.21, 0.06))))],
            conditions: [{conditions}
                Velocity(on: Select(within: Box(min: (0.16, 0.0), max: (0.21, 0.01))), value: (None, "1.5*smoothstep(t/0.005)"))],
            contacts: [Contact(between: ("fork", "fork"), law: Penalty(), surface: Particles, restitution: 0.8)],
            time: (end: 0.012, step: Fixed(5e-6)))"#
        ))
    };
    let other = r#"Velocity(on: Select(within: Box(min: (0.16, 0.09), max: (0.21, 0.1))), value: (None, "-1.5*smoothstep(t/0.005)")),"#;
    let (mut whole, mut half) = (scene(0.1, other), scene(0.05, "Symmetry(plane: Y, at: 0.05),"));
    whole.run(|_| true).unwrap();
    half.run(|_| true).unwrap();
    assert_same_half(&whole, &half, 0.05);
    let touched = half.ledger().total_named("contact_damping");
    assert!(touched > 0.0 && half.ledger().relative_error().abs() < 5e-3, "{touched}");
    for account in ["contact", "contact_damping", "strain"] {
        let (whole, half) = (whole.ledger().total_named(account), half.ledger().total_named(account));
        assert!((0.5 * whole - half).abs() < 1e-6 * whole.abs(), "{account}: {whole} {half}");
    }
}

#[test]
fn half_of_two_blocks_that_meet_is_half_of_the_whole() {
    let scene = |top: f64, surface: &str, conditions: &str| {
        simulation(&format!(
            r#"(dimension: Two,
            materials: {{"soft": NeoHookean(density: 1000, young: 1e6, poisson: 0.3)}},
            bodies: [
                (name: "left", material: "soft", shape: Box(min: (0, 0), max: (0.05, {top})), spacing: 0.01,
                 formulation: TotalLagrangian, velocity: (1, 0)),
                (name: "right", material: "soft", shape: Box(min: (0.0505, 0), max: (0.1005, {top})), spacing: 0.01,
                 formulation: TotalLagrangian, velocity: (-1, 0)),
            ],
            conditions: [{conditions} InitialVelocity(on: Select(body: "left"), value: ("1 + 200*(y - 0.05)^2", "(0.05 - y)*20"))],
            contacts: [Contact(between: ("left", "right"), law: Penalty(), surface: {surface}, friction: 0.3)],
            time: (end: 0.008, step: Fixed(5e-6)))"#
        ))
    };
    for surface in ["Particles", "Skin"] {
        let plane = "Symmetry(plane: Y, at: 0.05),";
        let (mut whole, mut half) = (scene(0.1, surface, ""), scene(0.05, surface, plane));
        assert!(
            half.warnings().iter().all(|warning| !warning.contains("touches with")),
            "{:?}",
            half.warnings()
        );
        whole.run(|_| true).unwrap();
        half.run(|_| true).unwrap();
        assert_same_half(&whole, &half, 0.05);
        assert!(centre(&half, 0).1.x < 0.0);
    }
}

#[test]
fn a_quarter_of_a_block_between_tools_is_a_quarter_of_the_whole() {
    let scene = |dimension: &str, size: &str, plates: &str, conditions: &str| {
        simulation(&format!(
            r#"(dimension: {dimension},
            materials: {{"soft": NeoHookean(density: 1000, young: 1e6, poisson: 0.3)}},
            bodies: [
                (name: "block", material: "soft", shape: Box({size}), spacing: 0.01, formulation: TotalLagrangian),
                (name: "plate", material: "soft", shape: Box({plates}), spacing: 0.01, formulation: Rigid()),
            ],
            conditions: [{conditions} Displacement(on: Select(body: "plate"), value: (0, "0.004*smoothstep(t/0.004)", 0)),
                InitialVelocity(on: Select(body: "block"), value: (0, 0.2, 0))],
            contacts: [Contact(between: ("block", "plate"), law: Penalty())],
            time: (end: 0.004, step: Fixed(5e-6)))"#
        ))
    };
    let planes = "Symmetry(plane: X, at: 0), Symmetry(plane: Z, at: 0),";
    let plates = "min: (-0.03, -0.021, -0.03), max: (0.03, -0.001, 0.03)";
    let mut whole = scene("Three", "min: (-0.02, 0, -0.02), max: (0.02, 0.03, 0.02)", plates, "");
    let mut quarter = scene("Three", "min: (-0.02, 0, -0.02), max: (0, 0.03, 0)", plates, planes);
    whole.run(|_| true).unwrap();
    quarter.run(|_| true).unwrap();
    let of_quarter = |sim: &Simulation| -> Vec<[glam::DVec3; 3]> {
        let rows = lower(sim, 0.03).into_iter();
        rows.filter(|row| row[0].x < 0.0 && row[0].z < 0.0 && row[0].y > 0.0).collect()
    };
    let (whole, quarter) = (of_quarter(&whole), of_quarter(&quarter));
    assert_eq!(whole.len(), quarter.len());
    let worst = whole.iter().zip(&quarter).map(|(a, b)| a[1].distance(b[1])).fold(0.0, f64::max);
    let moved = whole.iter().map(|row| row[0].distance(row[1])).fold(0.0, f64::max);
    assert!(moved > 1e-3 && worst < 1e-6 * moved, "{worst} of {moved}");
}
