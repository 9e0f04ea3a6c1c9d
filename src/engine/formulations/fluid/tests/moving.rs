//! Scenes and walls that move: the energies that are compared, and the warnings, are those at rest.

use glam::DVec3;

use super::{column, simulation};
use crate::simulation::Simulation;
use crate::world::Pressure;

/// Vortices in a periodic box with particles under pressure, seen by someone who moves.
fn vortices(u: f64, v: f64) -> String {
    format!(
        r#"(dimension: Two, domain: (min: (0, 0), max: (1, 1), periodic: [X, Y]),
            materials: {{"oil": Fluid(density: 1.0, sound_speed: 10.0, viscosity: 0.04)}},
            bodies: [(name: "oil", material: "oil", shape: Box(min: (0, 0), max: (1, 1)), spacing: 0.0625,
                formulation: Fluid(pressure: 2.0))],
            conditions: [InitialVelocity(on: Select(body: "oil"),
                value: ("{u} - cos(2*pi*x)*sin(2*pi*y)", "{v} + sin(2*pi*x)*cos(2*pi*y)"))],
            time: (end: 0.7), record: (every: 0.05))"#
    )
}

/// A column of water that falls in a tank, beside a log, seen by someone who moves.
fn tank(u: f64, v: f64) -> String {
    format!(
        r#"(dimension: Two, gravity: (0.0, -9.81),
            materials: {{"water": Fluid(density: 1000.0, sound_speed: 25.0),
                "wood": NeoHookean(density: 500.0, young: 1.0e6, poisson: 0.3)}},
            bodies: [
                (name: "water", material: "water", shape: Box(min: (0, 0), max: (0.2, 0.3)), spacing: 0.025,
                 formulation: Fluid, velocity: ({u}, {v})),
                (name: "log", material: "wood", shape: Box(min: (0.3, 0), max: (0.4, 0.1)), spacing: 0.025,
                 formulation: Rigid(), velocity: ({u}, {v})),
                (name: "tank", material: "wall", spacing: 0.025, formulation: Wall(), velocity: ({u}, {v}),
                 shape: Difference(Box(min: (-0.1, -0.1), max: (0.9, 0.6)), Box(min: (0, 0), max: (0.8, 1)))),
            ],
            contacts: [(between: ("log", "tank"))],
            time: (end: 0.25), record: (every: 0.05))"#
    )
}

fn ended(text: &str) -> Simulation {
    let mut sim = simulation(text);
    sim.run(|_| true).expect("a run");
    sim
}

/// The first words of every warning: the numbers in them may differ in the last digits.
fn subjects(sim: &Simulation) -> Vec<&str> {
    let mut subjects: Vec<&str> = sim.warnings().iter().map(|text| &text[..text.len().min(30)]).collect();
    subjects.sort_unstable();
    subjects
}

#[test]
fn a_periodic_flow_that_moves_as_a_whole_is_judged_like_one_at_rest() {
    let (rest, moving) = (ended(&vortices(0.0, 0.0)), ended(&vortices(3.0, -2.0)));
    assert!(subjects(&rest).iter().any(|text| text.contains("resist")), "{:?}", rest.warnings());
    assert_eq!(subjects(&rest), subjects(&moving));
    for (of_rest, of_moving) in [
        (rest.ledger().motion(), moving.ledger().motion()),
        (rest.ledger().largest(), moving.ledger().largest()),
        (rest.ledger().relative_error(), moving.ledger().relative_error()),
    ] {
        let scale = rest.ledger().largest();
        assert!((of_moving - of_rest).abs() < 1e-4 * scale, "{of_moving} instead of {of_rest}");
    }
}

#[test]
fn the_material_that_a_wall_names_has_no_influence() {
    let named =
        |name: &str| ended(&tank(4.0, 3.0).replace(r#"material: "wall""#, &format!(r#"material: "{name}""#)));
    let energies = |sim: &Simulation| {
        let ledger = sim.ledger();
        [ledger.total_named("kinetic"), ledger.total_named("gravity"), ledger.balance_error()]
    };
    let of_none = energies(&named("wall"));
    for name in ["water", "wood"] {
        assert_eq!(energies(&named(name)), of_none, "{name}");
    }
}

#[test]
fn a_tank_that_moves_with_its_water_is_judged_like_one_at_rest() {
    let (rest, moving) = (ended(&tank(0.0, 0.0)), ended(&tank(4.0, 3.0)));
    assert_eq!(subjects(&rest), subjects(&moving));
    let scale = rest.ledger().largest();
    for (of_rest, of_moving) in [
        (rest.ledger().motion(), moving.ledger().motion()),
        (scale, moving.ledger().largest()),
        (rest.ledger().turnover(), moving.ledger().turnover()),
    ] {
        assert!((of_moving - of_rest).abs() < 0.01 * scale, "{of_moving} instead of {of_rest}");
    }
}

/// Displacement of a turn about the origin at 10 rad/s.
const TURN: &str = r#"("x*(cos(10*t) - 1) - y*sin(10*t)", "x*sin(10*t) + y*(cos(10*t) - 1)")"#;

#[test]
fn a_body_in_a_tank_that_turns_is_not_in_its_wall() {
    let sim = ended(&format!(
        r#"(dimension: Two, materials: {{"water": Fluid(density: 1000.0, sound_speed: 20.0), "block": NeoHookean(density: 2000.0, young: 1.0e6, poisson: 0.3)}},
            bodies: [
                (name: "water", material: "water", shape: Ring(center: (0, 0), inner: 0.06, outer: 0.2), spacing: 0.02, lattice: Concentric, formulation: Fluid(pressure: 500)),
                (name: "block", material: "block", shape: Sphere(center: (0, 0), radius: 0.06), spacing: 0.02, lattice: Concentric, formulation: Rigid()),
                (name: "drum", material: "wall", shape: Ring(center: (0, 0), inner: 0.2, outer: 0.28), spacing: 0.02, lattice: Concentric, formulation: Wall(suction: true)),
            ],
            conditions: [Displacement(on: Select(body: "drum"), value: {TURN})], time: (end: 0.15))"#
    ));
    assert!(!sim.warnings().iter().any(|text| text.contains("is inside of")), "{:?}", sim.warnings());
}

#[test]
fn a_body_that_an_arm_turns_into_is_in_it() {
    let sim = ended(&format!(
        r#"(dimension: Two, materials: {{"water": Fluid(density: 1000.0, sound_speed: 20.0), "block": NeoHookean(density: 2000.0, young: 1.0e6, poisson: 0.3)}},
            bodies: [
                (name: "water", material: "water", shape: Box(min: (1, 1), max: (1.2, 1.2)), spacing: 0.02, formulation: Fluid()),
                (name: "block", material: "block", shape: Sphere(center: (0, 0.3), radius: 0.03), spacing: 0.01, formulation: Rigid()),
                (name: "arm", material: "wall", shape: Box(min: (0.1, -0.06), max: (0.5, 0.06)), spacing: 0.02, formulation: Wall(slip: Free)),
            ],
            conditions: [Displacement(on: Select(body: "arm"), value: {TURN})], time: (end: 0.157))"#
    ));
    assert!(sim.warnings().iter().any(|text| text.contains("is inside of `arm`")), "{:?}", sim.warnings());
}

/// Parts that are driven from the first step on do not set the frame of what is at rest.
#[test]
fn a_scene_of_which_parts_move_is_at_rest() {
    let frame = |wall: &str, conditions: &str| {
        let mut sim = simulation(&format!(
            r#"(dimension: Two, domain: (min: (0, -1), max: (0.4, 1), periodic: [X]),
                materials: {{"water": Fluid(density: 1000.0, sound_speed: 20.0, viscosity: 1.0)}},
                bodies: [
                    (name: "water", material: "water", shape: Box(min: (0, 0), max: (0.4, 0.2)), spacing: 0.02, formulation: Fluid(pressure: 100)),
                    (name: "bed", material: "wall", shape: Box(min: (0, -0.08), max: (0.4, 0)), spacing: 0.02, formulation: Wall(slip: No)),
                    {wall}
                ],
                conditions: [{conditions}], time: (end: 1.0))"#
        ));
        sim.run(|sim| sim.clock().step < 1).expect("a step");
        sim.ledger().frame()
    };
    let lid = r#"(name: "lid", material: "wall", shape: Box(min: (0, 0.2), max: (0.4, 0.28)), spacing: 0.02, formulation: Wall(slip: No)),"#;
    let along = |body: &str, speed: &str| {
        format!(r#"Velocity(on: Select(body: "{body}"), value: ("{speed}", 0.0)),"#)
    };
    assert_eq!(frame("", &along("bed", "0.05*cos(5*t)")), DVec3::ZERO);
    assert_eq!(frame(lid, &(along("bed", "-0.1") + &along("lid", "0.1"))), DVec3::ZERO);
    let all = along("bed", "0.3") + r#"InitialVelocity(on: Select(body: "water"), value: (0.3, 0.0)),"#;
    assert!(frame("", &all).distance(0.3 * DVec3::X) < 1e-12);
}

/// A tank that is accelerated, and bodies in it that follow: a last step that is much shorter than the others
/// has the same accelerations. That of walls was half of the ratio of both steps too large in it.
#[test]
fn a_short_last_step_does_not_change_the_pressure_on_accelerated_boundaries() {
    let steps = |end: f64| {
        let mut sim = simulation(&format!(
            r#"(dimension: Two, materials: {{"water": Fluid(density: 1000.0, sound_speed: 20.0),
                    "wood": NeoHookean(density: 500.0, young: 1.0e6, poisson: 0.3)}},
                bodies: [
                    (name: "water", material: "water", spacing: 0.02, formulation: Fluid(pressure: 2000),
                     shape: Difference(Box(min: (0, 0), max: (0.4, 0.2)), Box(min: (0.16, 0.08), max: (0.24, 0.12)))),
                    (name: "log", material: "wood", spacing: 0.02, formulation: Rigid(),
                     shape: Box(min: (0.16, 0.08), max: (0.24, 0.12))),
                    (name: "tank", material: "wall", spacing: 0.02, formulation: Wall(suction: true),
                     shape: Difference(Box(min: (-0.06, -0.06), max: (0.46, 0.26)), Box(min: (0, 0), max: (0.4, 0.2)))),
                ],
                conditions: [Velocity(on: Select(body: "tank"), value: ("t", 0))],
                time: (end: {end}, step: Fixed(2.0e-4)))"#
        ));
        sim.run(|_| true).expect("a run");
        column::<Pressure>(&sim, 2)
    };
    let (whole, more) = (steps(0.02), steps(0.02 + 2e-8));
    let largest = whole.iter().map(|p| p.0.abs()).fold(0.0, f64::max);
    let change = whole.iter().zip(&more).map(|(a, b)| (a.0 - b.0).abs()).fold(0.0, f64::max);
    assert!(change < 1e-2 * largest, "{change} {largest}");
}

/// A block that falls through a floor in the middle of a periodic domain, across its side, and beyond it.
#[test]
fn a_body_that_passes_through_a_wall_is_named_wherever_it_is_in_a_periodic_domain() {
    for center in [0.4, 0.8, 1.0, -7.6] {
        let water = (center + 0.35f64).rem_euclid(0.8).min(0.7);
        let mut sim = simulation(&format!(
            r#"(dimension: Two, domain: (min: (0, -1), max: (0.8, 1), periodic: [X]),
                materials: {{"water": Fluid(density: 1000.0, sound_speed: 30.0), "steel": NeoHookean(density: 7800.0, young: 1.0e7, poisson: 0.3)}},
                bodies: [
                    (name: "water", material: "water", spacing: 0.02, formulation: Fluid, shape: Box(min: ({water}, 0), max: ({}, 0.1))),
                    (name: "floor", material: "wall", spacing: 0.02, formulation: Wall(), shape: Box(min: (0, -0.08), max: (0.8, 0))),
                    (name: "block", material: "steel", spacing: 0.02, formulation: Rigid(), velocity: (0.0, -4.0),
                     shape: Box(min: ({}, 0.01), max: ({}, 0.07))),
                ], time: (end: 0.02))"#,
            water + 0.1,
            center - 0.1,
            center + 0.1
        ));
        sim.run(|_| true).expect("a run");
        let warnings = sim.warnings();
        assert!(
            warnings.iter().any(|text| text.contains("of `block` is inside of `floor`")),
            "{center}: {warnings:?}"
        );
    }
}
