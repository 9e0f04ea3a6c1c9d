//! A soft beam, two particles of the fluid thick, bends in a driven channel: nothing enters it, and friction
//! only takes energy.

mod common;

use common::simulation;
use meshless::scene::Source;

const SCENE: &str = r#"Scene(dimension: Two,
    domain: (min: (0.0, -0.06), max: (0.4, 0.16), periodic: [X]),
    materials: {"oil": Fluid(density: 1000.0, sound_speed: 4.0, viscosity: 1.0), "rubber": NeoHookean(density: 1200.0, young: 40000.0, poisson: 0.4)},
    bodies: [
        Body(name: "oil", material: "oil", shape: Difference(Box(min: (0.0, 0.0), max: (0.4, 0.1)), Box(min: (0.15, 0.0), max: (0.16, 0.05))), spacing: 0.005,
             formulation: Fluid, plugins: [density_diffusion()]),
        Body(name: "beam", material: "rubber", shape: Box(min: (0.15, -0.02), max: (0.16, 0.05)), spacing: 0.0025, formulation: TotalLagrangian,
             plugins: [hourglass_control()]),
        Body(name: "lower", material: "wall", shape: Difference(Box(min: (0.0, -0.02), max: (0.4, 0.0)), Box(min: (0.15, -0.04), max: (0.16, 1.0))),
             spacing: 0.005, formulation: Wall(slip: No, suction: true)),
        Body(name: "upper", material: "wall", shape: Box(min: (0.0, 0.1), max: (0.4, 0.12)), spacing: 0.005, formulation: Wall(slip: No, suction: true)),
    ],
    conditions: [Fix(on: Select(body: "beam", within: Box(min: (-1, -1), max: (1, 0.0)))), BodyForce(on: Select(body: "oil"), value: ("0.6*smoothstep(t/0.3)", 0.0))],
    time: (end: 0.75),
)"#;

#[test]
fn no_oil_enters_the_beam_and_friction_takes_energy() {
    let mut sim = simulation(&Source::new("beam.ron", SCENE));
    let mut least = f64::INFINITY;
    sim.run(|sim| {
        least = least.min(sim.ledger().total_named("viscosity"));
        true
    })
    .expect("a run");
    assert!(!sim.warnings().iter().any(|warning| warning.contains("is inside of")), "{:?}", sim.warnings());
    let [taken, drive] = ["viscosity", "body_force"].map(|name| sim.ledger().total_named(name));
    assert!(least > -1e-6 * drive && taken > 0.1 * drive, "{least} {taken} of {drive}");
}
