//! Work of walls that is lost to the diffusion of density where a jet leaves a slot.

use meshless_engine::assembly::build;
use meshless_engine::plugin::Registry;
use meshless_engine::scene::{Source, parse};

/// A tube twelve particles wide and a piston in it, with an end plate that has a slot of that width.
fn is_warned(slot: f64) -> bool {
    let text = format!(
        r#"(dimension: Two, parameters: {{"b": 0.08, "dx": "b/6", "s": {slot}}}, domain: (min: (-1.5, -1), max: (0.3, 1), outside: Remove),
            materials: {{"water": Fluid(density: 1000.0, sound_speed: 15.0)}},
            bodies: [
                (name: "water", material: "water", shape: Box(min: ("-8*b", "-b"), max: (0, "b")), spacing: "dx", formulation: Fluid, plugins: [density_diffusion()]),
                (name: "tube", material: "wall", spacing: "dx", formulation: Wall(slip: Free),
                 shape: Difference(Difference(Box(min: ("-12*b", "-b - 4*dx"), max: ("3*dx", "b + 4*dx")), Box(min: ("-16*b", "-b"), max: (0, "b"))), Box(min: (-0.1, "-s/2"), max: (1, "s/2")))),
                (name: "piston", material: "wall", spacing: "dx", formulation: Wall(slip: Free), shape: Box(min: ("-8*b - 4*dx", "-b"), max: ("-8*b", "b"))),
            ],
            conditions: [Velocity(on: Select(body: "piston"), value: ("0.3*smoothstep(t/0.4)", 0))],
            time: (end: 1.2))"#
    );
    let (scene, source) = parse(Source::new("test.ron", text)).unwrap_or_else(|error| panic!("{error}"));
    let mut registry = Registry::standard();
    density_diffusion::register(&mut registry);
    let mut sim = build(&scene, &source, &registry).unwrap_or_else(|error| panic!("{error}"));
    sim.run(|_| true).expect("a run");
    sim.warnings().iter().any(|text| text.contains("`density_diffusion` has taken"))
}

/// Nothing but the jet takes energy: Bernoulli's pressure on the piston is the kinetic energy that leaves. A
/// sixth of it was lost at the lips, and nothing was said.
#[test]
fn a_jet_that_tears_at_the_lips_of_a_slot_is_warned_of() {
    assert!(is_warned(0.08));
    assert!(!is_warned(0.16));
}
