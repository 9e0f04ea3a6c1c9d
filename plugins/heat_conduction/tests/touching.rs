//! No heat passes between bodies that touch, which a warning says where they start at different temperatures.

use meshless_engine::assembly::build;
use meshless_engine::plugin::Registry;
use meshless_engine::scene::{Source, parse};

/// Whether two blocks that touch are warned of, with this temperature at the start, K.
fn is_told(temperature: &str) -> bool {
    let text = format!(
        r#"(dimension: Two,
            materials: {{"soft": NeoHookean(density: 1000, young: 1e6, poisson: 0.3)}},
            bodies: [
                (name: "lower", material: "soft", shape: Box(min: (0, -0.4), max: (1, 0)), spacing: 0.1, formulation: TotalLagrangian),
                (name: "upper", material: "soft", shape: Box(min: (0, 0), max: (1, 0.4)), spacing: 0.1, formulation: TotalLagrangian),
            ],
            contacts: [Contact(between: ("lower", "upper"))],
            plugins: [heat_conduction(specific_heat: 500, conductivity: 30, temperature: {temperature})],
            time: (end: 1e-3))"#
    );
    let (scene, source) = parse(Source::new("touching.ron", &text)).unwrap_or_else(|e| panic!("{e}"));
    let registry = Registry::standard().with(heat_conduction::register);
    let mut sim = build(&scene, &source, &registry).unwrap_or_else(|e| panic!("{e}"));
    sim.run(|_| true).expect("a run");
    sim.warnings().iter().any(|text| text.contains("no heat passes between `lower` and `upper`"))
}

#[test]
fn bodies_that_touch_and_start_at_different_temperatures_are_warned_of() {
    assert!(is_told(r#""300 + 50*step(y)""#));
    assert!(!is_told("300"));
    assert!(!is_told(r#""300 + 50*x""#));
}
