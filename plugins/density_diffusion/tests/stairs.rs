//! Motion that is lost to the diffusion of density where walls form stairs.

use meshless_engine::assembly::build;
use meshless_engine::plugin::Registry;
use meshless_engine::scene::{Source, parse};

/// Walls whose particles form stairs shake what turns past them: three quarters of its energy were lost, and
/// nothing was said.
#[test]
fn a_liquid_that_loses_its_motion_to_stairs_is_warned_of() {
    let drum = |lattice: &str| {
        let text = format!(
            r#"(dimension: Two, materials: {{"liquid": Fluid(density: 1000.0, sound_speed: 10.0)}},
            bodies: [
                (name: "liquid", material: "liquid", spacing: 0.0125, lattice: {lattice}, shape: Sphere(center: (0, 0), radius: 0.1),
                 formulation: Fluid(pressure: "500*25*(x*x + y*y)"), plugins: [density_diffusion()]),
                (name: "drum", material: "wall", spacing: 0.0125, lattice: {lattice}, shape: Ring(center: (0, 0), inner: 0.1, outer: 0.15), formulation: Wall(slip: Free, suction: true)),
            ],
            conditions: [InitialVelocity(on: Select(body: "liquid"), value: ("-5*y", "5*x"))],
            time: (end: 1.5))"#
        );
        let (scene, source) = parse(Source::new("test.ron", text)).unwrap_or_else(|error| panic!("{error}"));
        let mut registry = Registry::standard();
        density_diffusion::register(&mut registry);
        let mut sim = build(&scene, &source, &registry).unwrap_or_else(|error| panic!("{error}"));
        sim.run(|_| true).expect("a run");
        sim.warnings().iter().any(|text| text.contains("has been lost to"))
    };
    assert!(drum("Regular"));
    assert!(!drum("Concentric"));
}
