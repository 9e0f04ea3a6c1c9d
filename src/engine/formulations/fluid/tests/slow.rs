//! Slow flows whose pressure spreads by diffusion.

use super::simulation;
use crate::rigid::RigidBodies;

/// A block that a force drives along a closed channel, half as high as the channel: its velocity at the end,
/// and whether the run says that pressure has not spread. The time of spreading,
/// `0.1 L^2 3 nu / (c^2 H^2)` with the half width H, is 1.2 s at 1 m/s and 0.015 s at 9 m/s.
fn driven_block(sound: f64) -> (f64, bool) {
    let mut sim = simulation(&format!(
        r#"(dimension: Two,
            materials: {{"oil": Fluid(density: 1000.0, sound_speed: {sound:?}, viscosity: 10.0), "block": NeoHookean(density: 1000.0, young: 1.0e6, poisson: 0.3)}},
            bodies: [
                (name: "oil", material: "oil", spacing: 0.005, formulation: Fluid,
                 shape: Difference(Box(min: (-0.2, -0.02), max: (0.2, 0.02)), Box(min: (-0.01, -0.01), max: (0.01, 0.01)))),
                (name: "block", material: "block", spacing: 0.005, formulation: Rigid(rotation: Held),
                 shape: Box(min: (-0.01, -0.01), max: (0.01, 0.01))),
                (name: "channel", material: "wall", spacing: 0.005, formulation: Wall(slip: No, suction: true),
                 shape: Difference(Box(min: (-0.215, -0.035), max: (0.215, 0.035)), Box(min: (-0.2, -0.02), max: (0.2, 0.02)))),
            ],
            conditions: [Force(on: Select(body: "block"), value: ("0.6*smoothstep(t/0.02)", None))],
            time: (end: 0.5))"#
    ));
    sim.run(|_| true).expect("a run");
    let speed = sim.resources().get::<RigidBodies>().iter().next().expect("a body").state.velocity.x;
    (speed, sim.warnings().iter().any(|text| text.contains("has not spread")))
}

#[test]
fn a_flow_that_ends_before_its_pressure_has_spread_is_warned_of() {
    let (settled, is_told) = driven_block(9.0);
    assert!(!is_told);
    // It compresses the oil ahead in the place of pushing it past itself.
    let (speed, is_told) = driven_block(1.0);
    assert!(is_told && speed > 1.5 * settled, "{speed} m/s, {settled} m/s with pressure that has spread");
}

/// A cylinder of that formulation that turns in a ring of oil twice as wide, if `motion` moves it so: what
/// friction has dissipated after `end`, s, J, and whether the run says that torques are wrong.
fn turned_cylinder(sound: f64, formulation: &str, motion: &str, end: f64) -> (f64, bool) {
    let mut sim = simulation(&format!(
        r#"(dimension: Two, materials: {{"oil": Fluid(density: 1000.0, sound_speed: {sound}, viscosity: 0.2), "wood": NeoHookean(density: 500.0, young: 1e6, poisson: 0.3)}},
            bodies: [
                (name: "oil", material: "oil", shape: Ring(center: (0, 0), inner: 0.1, outer: 0.2), spacing: 0.02, lattice: Concentric, formulation: Fluid(pressure: "0")),
                (name: "rotor", material: "wood", shape: Ring(center: (0, 0), inner: 0.02, outer: 0.1), spacing: 0.02, lattice: Concentric, formulation: {formulation}),
                (name: "ring", material: "wall", shape: Ring(center: (0, 0), inner: 0.2, outer: 0.28), spacing: 0.02, lattice: Concentric,
                 formulation: Wall(slip: No, suction: true)),
            ],
            conditions: [{motion}], time: (end: {end}))"#
    ));
    sim.run(|_| true).expect("a run");
    let is_told = sim.warnings().iter().any(|text| text.contains("corrected for rotation"));
    (sim.ledger().total_named("viscosity"), is_told)
}

const TURNS: &str = r#"RotationRate(on: Select(body: "rotor"), rate: 0.05)"#;

/// Friction has spin below 670 m/s.
#[test]
fn torques_of_friction_without_spin_are_warned_of() {
    let warns = |sound: f64, motion: &str| turned_cylinder(sound, "Rigid()", motion, 0.04).1;
    let moves = r#"Velocity(on: Select(body: "rotor"), value: ("0.005", "0.0"))"#;
    assert!(!warns(100.0, TURNS));
    assert!(warns(1000.0, TURNS));
    assert!(!warns(1000.0, moves));
    let wall = r#"Displacement(on: Select(body: "rotor"), value: ("x*(cos(0.05*t) - 1) - y*sin(0.05*t)", "x*sin(0.05*t) + y*(cos(0.05*t) - 1)"))"#;
    let warns = |sound: f64| turned_cylinder(sound, "Wall(slip: No)", wall, 0.04).1;
    assert!(!warns(100.0));
    assert!(warns(1000.0));
}

#[test]
fn friction_beside_what_turns_does_not_depend_on_the_speed_of_sound() {
    let [slow, fast] = [20.0, 140.0].map(|sound| turned_cylinder(sound, "Rigid()", TURNS, 0.2).0);
    assert!((fast / slow - 1.0).abs() < 0.02, "{fast} J, {slow} J with a slower sound");
}
