//! Failed particles resist with nothing: where a shock presses them on an uneven lattice, a warning says so.

use meshless_engine::assembly::build;
use meshless_engine::plugin::Registry;
use meshless_engine::scene::{Source, parse};

/// Whether a block of metal that hits a symmetry plane and fails at once is warned of.
fn told(lattice: &str, speed: f64, criterion: &str) -> bool {
    let text = format!(
        r#"(dimension: Two,
            materials: {{"m": J2(density: 2700, young: 70e9, poisson: 0.33, hardening: Perfect(yield_stress: 3e8))}},
            bodies: [(name: "b", material: "m", shape: Box(min: (0, 0), max: (0.01, 0.004)), spacing: 0.0005, lattice: {lattice},
                      formulation: TotalLagrangian, velocity: (-{speed:?}, 0), plugins: [failure(criterion: {criterion}, then: NoDeviator)])],
            conditions: [Symmetry(plane: X, at: 0), Symmetry(plane: Y, at: 0), Symmetry(plane: Y, at: 0.004)],
            time: (end: 1e-6))"#
    );
    let (scene, source) = parse(Source::new("test.ron", text)).unwrap_or_else(|error| panic!("{error}"));
    let registry = Registry::standard().with(failure::register);
    let mut sim = build(&scene, &source, &registry).unwrap_or_else(|error| panic!("{error}"));
    sim.run(|_| true).expect("a run");
    sim.warnings().iter().any(|text| text.contains("have failed and are under a pressure"))
}

#[test]
fn failed_metal_behind_a_shock_on_an_uneven_lattice_is_warned_of() {
    let (at_once, never) =
        ("JohnsonCook(d1: 1e-4, d2: 0, d3: 0, minimum_strain: 1e-4)", "JohnsonCook(d1: 9, d2: 0, d3: 0)");
    assert!(told("Hexagonal", 500.0, at_once));
    // Intact metal has hourglass control that follows the pressure, and 1.5 GPa is too little.
    assert!(!told("Hexagonal", 500.0, never));
    assert!(!told("Hexagonal", 100.0, at_once));
    assert!(!told("Regular", 500.0, at_once));
}
