//! The step of a body that flies does not depend on how fast, nor on the direction.

use meshless_engine::assembly::build;
use meshless_engine::plugin::Registry;
use meshless_engine::scene::{Source, parse};

/// Time after forty steps, s, of a block that flies undeformed with a velocity, m/s.
fn time_after_forty_steps(formulation: &str, velocity: &str) -> f64 {
    let text = format!(
        r#"(dimension: Two,
            materials: {{"m": NeoHookean(density: 1000, young: 1.0e6, poisson: 0.3)}},
            bodies: [(name: "b", material: "m", shape: Box(min: (0.03, -0.11), max: (0.17, 0.09)), spacing: 0.01,
                      formulation: {formulation}, velocity: {velocity}, plugins: [artificial_viscosity(), hourglass_control()])],
            time: (end: 10.0))"#
    );
    let (scene, source) = parse(Source::new("test.ron", text)).unwrap_or_else(|e| panic!("{e}"));
    let mut registry = Registry::standard();
    artificial_viscosity::register(&mut registry);
    hourglass_control::register(&mut registry);
    let mut sim = build(&scene, &source, &registry).unwrap_or_else(|error| panic!("{error}"));
    for _ in 0..40 {
        sim.step().expect("a step");
    }
    sim.clock().time
}

#[test]
fn rounding_does_not_shorten_the_step() {
    for formulation in ["TotalLagrangian", "UpdatedLagrangian(update: Every(5))", "Eulerian()"] {
        let at_rest = time_after_forty_steps(formulation, "(0, 0)");
        for velocity in ["(3.7, -1.3)", "(-370, 20)"] {
            let flying = time_after_forty_steps(formulation, velocity);
            assert!(
                (flying - at_rest).abs() < 1e-9 * at_rest,
                "{formulation} {velocity}: {flying} {at_rest}"
            );
        }
    }
}
