//! A channel with a constant flux, and a suspension.

use crate::assembly::build;
use crate::plugin::Registry;
use crate::scene::{Source, parse};
use crate::simulation::Simulation;
use crate::world::{BodyId, Mass, Velocity};

fn simulation(text: &str) -> Simulation {
    let built = parse(Source::new("flow.ron", text))
        .and_then(|(scene, source)| build(&scene, &source, &Registry::standard()));
    built.unwrap_or_else(|error| panic!("{error}"))
}

/// A channel 0.1 m high between no-slip walls, with a grain in it if there is a hole for one; nu = 0.1 m2/s.
fn channel(hole: &str, grain: &str, driven: &str) -> Simulation {
    simulation(&format!(
        r#"(dimension: Two, domain: (min: (0, -1), max: (0.2, 1), periodic: [X]),
            materials: {{"oil": Fluid(density: 1000, viscosity: 100, sound_speed: 4), "iron": NeoHookean(density: 4000, young: 1e9, poisson: 0.3)}},
            bodies: [(name: "oil", material: "oil", spacing: 0.01, formulation: Fluid(pressure: 100), velocity: (0.1, 0),
                      shape: {hole}),
                     (name: "walls", material: "none", spacing: 0.01, formulation: Wall(slip: No, suction: true),
                      shape: Union([Box(min: (0, -0.04), max: (0.2, 0)), Box(min: (0, 0.1), max: (0.2, 0.14))])), {grain}],
            conditions: [MeanVelocity(bodies: [{driven}], value: (0.1, None))],
            time: (end: 0.12))"#
    ))
}

/// Mean velocity of bodies along x, m/s, and their mass, kg.
fn mean(sim: &Simulation, bodies: &[usize]) -> (f64, f64) {
    let (mut momentum, mut mass) = (0.0, 0.0);
    for &body in bodies {
        let (view, rows) = sim.world().body_view(BodyId(body));
        let (m, v) = (view.read::<Mass>().unwrap(), view.read::<Velocity>().unwrap());
        momentum += rows.clone().map(|row| m[row].0 * v[row].0.x).sum::<f64>();
        mass += rows.map(|row| m[row].0).sum::<f64>();
    }
    (momentum / mass, mass)
}

const WHOLE: &str = "Box(min: (0, 0), max: (0.2, 0.1))";

#[test]
fn a_channel_of_constant_flux_has_the_pressure_gradient_of_poiseuille() {
    let mut sim = channel(WHOLE, "", r#""oil""#);
    let work = |sim: &Simulation| sim.ledger().total_named("mean_velocity");
    let mut farthest = 0.0f64;
    sim.run(|sim| {
        farthest = farthest.max((mean(sim, &[0]).0 - 0.1).abs());
        sim.clock().time < 0.08
    })
    .unwrap();
    let (before, time) = (work(&sim), sim.clock().time);
    sim.run(|_| true).unwrap();
    let power = (work(&sim) - before) / (sim.clock().time - time);
    // The gradient is 12 mu U / H^2; its power over 0.02 m2 is that times U.
    let expected = 12.0 * 100.0 * 0.1 / 0.01 * 0.02 * 0.1;
    assert!((power / expected - 1.0).abs() < 0.03, "{power} {expected}");
    // At first the walls take hold of a fluid that moves as a block.
    assert!(farthest < 0.02 && (mean(&sim, &[0]).0 - 0.1).abs() < 1e-4, "{farthest} {:?}", mean(&sim, &[0]));
    assert!(sim.ledger().relative_error().abs() < 0.02, "{}", sim.ledger().relative_error());
}

#[test]
fn fluid_and_grains_are_driven_together() {
    let hole = "Difference(Box(min: (0, 0), max: (0.2, 0.1)), Sphere(center: (0.1, 0.05), radius: 0.02))";
    let grain = r#"(name: "grain 1", material: "iron", spacing: 0.01, formulation: Rigid(), velocity: (0.1, 0),
                    shape: Sphere(center: (0.1, 0.05), radius: 0.02))"#;
    let mut sim = channel(hole, grain, r#""oil", "grain*""#);
    sim.run(|_| true).unwrap();
    assert!((mean(&sim, &[0, 2]).0 - 0.1).abs() < 1e-3, "{:?}", mean(&sim, &[0, 2]));
    assert!(mean(&sim, &[2]).0 > 0.1, "it is in the middle, where the flow is fastest");
}

#[test]
fn a_heavy_liquid_is_driven_as_hard_as_a_light_one_beside_it() {
    let mut sim = simulation(
        r#"(dimension: Two, domain: (min: (0, -1), max: (0.2, 1), periodic: [X]),
            materials: {"water": Fluid(density: 1000, sound_speed: 10), "brine": Fluid(density: 2000, sound_speed: 10)},
            bodies: [(name: "water", material: "water", spacing: 0.01, formulation: Fluid, shape: Box(min: (0, 0.05), max: (0.2, 0.1))),
                     (name: "brine", material: "brine", spacing: 0.01, formulation: Fluid, shape: Box(min: (0, 0), max: (0.2, 0.05))),
                     (name: "walls", material: "none", spacing: 0.01, formulation: Wall(slip: Free, suction: true),
                      shape: Union([Box(min: (0, -0.04), max: (0.2, 0)), Box(min: (0, 0.1), max: (0.2, 0.14))]))],
            conditions: [MeanVelocity(bodies: ["water", "brine"], value: (0.1, None))],
            time: (end: 0.1))"#,
    );
    sim.run(|_| true).unwrap();
    // A pressure gradient accelerates each by its own density: (1000 v + 2000 v / 2) / 3000 = 0.1 m/s.
    let (water, brine) = (mean(&sim, &[0]).0, mean(&sim, &[1]).0);
    assert!((water - 0.15).abs() < 1e-3 && (brine - 0.075).abs() < 1e-3, "{water} {brine}");
}
