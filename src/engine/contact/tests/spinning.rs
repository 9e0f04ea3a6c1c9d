//! A disc that spins flat on a floor: friction slows it down as an even pressure does.

use super::rigid::momenta;
use super::simulation;

/// Half of the width of the body, m.
const HALF: f64 = 0.1;

/// Deceleration of a body that spins on a base with that mean distance from its axis and that squared radius
/// of gyration, over that by friction with an even pressure; so many particles over half of its width.
fn deceleration(shape: &str, mean: f64, gyration: f64, across: f64) -> f64 {
    let (friction, spin, end) = (0.2, 20.0, 0.1);
    let mut sim = simulation(&format!(
        r#"(dimension: Three, gravity: (0, 0, -9.81),
            materials: {{"steel": NeoHookean(density: 1000, young: 1e8, poisson: 0.3)}},
            bodies: [
                (name: "disc", material: "steel", shape: {shape},
                 spacing: {:?}, formulation: Rigid(spin: (0, 0, {spin:?}))),
                (name: "floor", material: "steel", shape: Box(min: (-0.2, -0.2, -0.1), max: (0.2, 0.2, 0)), spacing: 0.05, formulation: Rigid()),
            ],
            conditions: [Fix(on: Select(body: "floor"))],
            contacts: [Contact(between: ("disc", "floor"), friction: {friction:?}, restitution: 0.3)],
            time: (end: {end:?}))"#,
        HALF / across,
    ));
    let before = momenta(&sim).1.z;
    sim.run(|_| true).expect("a run");
    let lost = 1.0 - momenta(&sim).1.z / before;
    lost * spin / end / (friction * 9.81 * mean / gyration)
}

/// The ends of a disc have points up to the rim, as its side has up to the ends.
#[test]
fn friction_slows_a_spinning_disc_as_an_even_pressure_does() {
    for per_radius in [4.0, 8.0] {
        let disc = format!("Cylinder(from: (0, 0, 0), to: (0, 0, 0.05), radius: {HALF:?})");
        let ratio = deceleration(&disc, 2.0 / 3.0 * HALF, 0.5 * HALF * HALF, per_radius);
        assert!((ratio - 1.0).abs() < 0.02, "{per_radius}: {ratio}");
    }
}

/// The points of the edges of a base count little beside those of its face, which stand for its whole area.
#[test]
fn friction_slows_a_spinning_box_as_an_even_pressure_does() {
    // Mean distance from the middle of a square of half width one.
    let mean = (2f64.sqrt() + 1f64.asinh()) / 3.0 * HALF;
    let shape = format!("Box(min: (-{HALF:?}, -{HALF:?}, 0), max: ({HALF:?}, {HALF:?}, 0.05))");
    for across in [4.0, 6.0] {
        let ratio = deceleration(&shape, mean, 2.0 / 3.0 * HALF * HALF, across);
        assert!((ratio - 1.0).abs() < 0.02, "{across}: {ratio}");
    }
}
