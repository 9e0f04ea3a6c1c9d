//! Water that has left its vessel and falls on.

use super::{column, simulation};
use crate::world::{Position, Velocity};

/// A drop of 16 particles beside a shelf, which it falls past for 1.2 s, to 11.8 m/s.
fn drop(domain: &str) -> String {
    format!(
        r#"(dimension: Two, gravity: (0.0, -9.81), {domain}
            materials: {{"water": Fluid(density: 1000.0, sound_speed: 10.0)}},
            bodies: [
                (name: "water", material: "water", shape: Box(min: (0.8, 0), max: (1, 0.2)), spacing: 0.05, formulation: Fluid()),
                (name: "shelf", material: "wall", shape: Box(min: (0, 0), max: (0.4, 0.2)), spacing: 0.05, formulation: Wall()),
            ],
            time: (end: 1.2))"#
    )
}

#[test]
fn a_drop_that_falls_past_all_walls_is_named_and_falls_on() {
    let mut sim = simulation(&drop(""));
    sim.run(|_| true).expect("a run");
    let way = 0.5 * 9.81 * 1.2 * 1.2;
    let heights = column::<Position>(&sim, 0).into_iter().map(|position| position.0.y);
    assert!((heights.sum::<f64>() / 16.0 - 0.1 + way).abs() < 1e-3 * way);
    let of = |part: &str| sim.warnings().iter().filter(|text| text.contains(part)).count();
    assert_eq!([of("past all walls and bodies: 16 of its particles"), of("Mach number")], [1, 0]);
}

#[test]
fn what_a_domain_takes_out_is_not_missing() {
    let mut sim = simulation(&drop("domain: (min: (-1, -1), max: (2, 1), outside: Remove),"));
    sim.run(|_| true).expect("a run");
    assert!(!sim.warnings().iter().any(|text| text.contains("past all walls")), "{:?}", sim.warnings());
}

/// A body that falls itself is no floor.
#[test]
fn what_falls_beside_a_free_body_is_named_if_there_is_a_wall() {
    let is_named = |wall: &str| {
        let mut sim = simulation(&format!(
            r#"(dimension: Two, gravity: (0.0, -9.81),
                materials: {{"water": Fluid(density: 1000.0, sound_speed: 20.0), "wood": NeoHookean(density: 500.0, young: 1.0e6, poisson: 0.3)}},
                bodies: [
                    (name: "water", material: "water", shape: Box(min: (0.8, 0), max: (1, 0.2)), spacing: 0.05, formulation: Fluid()),
                    (name: "ball", material: "wood", shape: Sphere(center: (2, -0.3), radius: 0.1), spacing: 0.05, formulation: Rigid()),
                    {wall}
                ],
                time: (end: 0.4))"#
        ));
        sim.run(|_| true).expect("a run");
        sim.warnings().iter().any(|text| text.contains("past all walls and bodies"))
    };
    assert!(!is_named(""));
    assert!(is_named(
        r#"(name: "shelf", material: "wall", shape: Box(min: (0, 0), max: (0.4, 0.2)), spacing: 0.05, formulation: Wall())"#
    ));
}

/// A container falls with its water, which it pushed off at 0.1 sqrt(g h), 10 deep, when its pressure was
/// that of a wall at rest, and at 0.06 when its water started with the pressure of water at rest.
#[test]
fn a_container_in_free_fall_keeps_its_water() {
    let mut sim = simulation(
        r#"(dimension: Two, gravity: (0.0, -9.81),
            materials: {"water": Fluid(density: 1000.0, sound_speed: 20.0), "iron": NeoHookean(density: 2000.0, young: 1.0e7, poisson: 0.3)},
            bodies: [
                (name: "water", material: "water", shape: Box(min: (0, 0), max: (0.4, 0.2)), spacing: 0.02, formulation: Fluid),
                (name: "box", material: "iron", shape: Difference(Box(min: (-0.08, -0.08), max: (0.48, 0.3)), Box(min: (0, 0), max: (0.4, 1))),
                 spacing: 0.02, formulation: Rigid()),
            ],
            time: (end: 0.1))"#,
    );
    sim.run(|_| true).expect("a run");
    let fall = |body: usize| {
        let velocities = column::<Velocity>(&sim, body);
        velocities.iter().map(|velocity| velocity.0.y).sum::<f64>() / velocities.len() as f64
    };
    // Both fall at g t.
    for body in 0..2 {
        assert!((fall(body) + 0.981).abs() < 0.01 * (9.81_f64 * 0.2).sqrt(), "{body}: {}", fall(body));
    }
    assert!(!sim.warnings().iter().any(|text| text.contains("in tension")), "{:?}", sim.warnings());
}

#[test]
fn a_drop_that_splashes_and_leaves_the_domain_had_a_free_surface() {
    let mut sim = simulation(
        r#"(dimension: Two, gravity: (0.0, -9.81), domain: (min: (-0.5, -0.3), max: (0.5, 0.5), outside: Remove),
            materials: {"water": Fluid(density: 1000.0, sound_speed: 40.0), "steel": NeoHookean(density: 2000.0, young: 1e7, poisson: 0.3)},
            bodies: [
                (name: "water", material: "water", shape: Box(min: (-0.05, 0), max: (0.05, 0.1)), spacing: 0.01, velocity: (0, -3), formulation: Fluid),
                (name: "sphere", material: "steel", shape: Sphere(center: (0.02, -0.15), radius: 0.05), spacing: 0.01, lattice: Regular, formulation: Rigid()),
            ],
            conditions: [Fix(on: Select(body: "sphere"))],
            time: (end: 1.0))"#,
    );
    sim.run(|_| true).expect("a run");
    let told = |part: &str| sim.warnings().iter().any(|text| text.contains(part));
    assert!(
        told("all particles of `water` have been removed") && !told("without a free surface"),
        "{:?}",
        sim.warnings()
    );
}
