//! A disc that spins flat on a floor: friction slows it down as an even pressure does.

use super::rigid::momenta;
use super::simulation;

/// Deceleration of the spin over that by friction with an even pressure, with so many particles per radius.
fn deceleration(per_radius: f64) -> f64 {
    let (radius, friction, spin, end) = (0.1, 0.2, 20.0, 0.1);
    let mut sim = simulation(&format!(
        r#"(dimension: Three, gravity: (0, 0, -9.81),
            materials: {{"steel": NeoHookean(density: 1000, young: 1e8, poisson: 0.3)}},
            bodies: [
                (name: "disc", material: "steel", shape: Cylinder(from: (0, 0, 0), to: (0, 0, 0.05), radius: {radius:?}),
                 spacing: {:?}, formulation: Rigid(spin: (0, 0, {spin:?}))),
                (name: "floor", material: "steel", shape: Box(min: (-0.2, -0.2, -0.1), max: (0.2, 0.2, 0)), spacing: 0.05, formulation: Rigid()),
            ],
            conditions: [Fix(on: Select(body: "floor"))],
            contacts: [Contact(between: ("disc", "floor"), friction: {friction:?}, restitution: 0.3)],
            time: (end: {end:?}))"#,
        radius / per_radius,
    ));
    let before = momenta(&sim).1.z;
    sim.run(|_| true).expect("a run");
    let lost = 1.0 - momenta(&sim).1.z / before;
    // Torque mu m g 2/3 R over the inertia m R^2 / 2.
    lost * spin / end / (friction * 9.81 * 4.0 / 3.0 / radius)
}

/// The ends of a disc have points up to the rim, as its side has up to the ends.
#[test]
fn friction_slows_a_spinning_disc_as_an_even_pressure_does() {
    for per_radius in [4.0, 8.0] {
        let ratio = deceleration(per_radius);
        assert!((ratio - 1.0).abs() < 0.02, "{per_radius}: {ratio}");
    }
}
