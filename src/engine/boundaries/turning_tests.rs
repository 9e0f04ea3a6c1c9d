//! Velocities that are meant as a rotation cause a warning, others do not.

use crate::assembly::build;
use crate::plugin::Registry;
use crate::scene::{Source, parse};

/// Warnings that name lines on which particles of a drum or a bar move, within 0.5 s.
fn warnings(on: &str, value: &str) -> usize {
    let text = format!(
        r#"(dimension: Two, materials: {{"oil": Fluid(density: 900.0, sound_speed: 10.0, viscosity: 1.0), "rubber": Rubber()}},
            bodies: [
                (name: "oil", material: "oil", shape: Sphere(center: (0, 0), radius: 0.2), spacing: 0.02, lattice: Concentric, formulation: Fluid),
                (name: "drum", material: "wall", shape: Ring(center: (0, 0), inner: 0.2, outer: 0.26), spacing: 0.02, lattice: Concentric,
                 formulation: Wall(slip: No)),
                (name: "bar", material: "rubber", shape: Box(min: (0.5, 0), max: (0.7, 0.1)), spacing: 0.02, formulation: TotalLagrangian),
            ],
            conditions: [Velocity(on: {on}, value: {value})], time: (end: 0.5))"#
    );
    let built = parse(Source::new("test.ron", text))
        .and_then(|(scene, source)| build(&scene, &source, &Registry::standard()));
    let sim = built.unwrap_or_else(|error| panic!("{error}"));
    sim.warnings().iter().filter(|warning| warning.contains("straight lines")).count()
}

#[test]
fn a_rotation_by_velocity_is_noticed() {
    let drum = r#"Select(body: "drum")"#;
    let end = r#"Select(body: "bar", within: Box(min: (0.6, -1), max: (1, 1)))"#;
    assert_eq!(warnings(drum, r#"("-2*y", "2*x")"#), 1);
    assert_eq!(warnings(end, r#"("-3*(y - 0.05)", "3*(x - 0.6)")"#), 1);
    // To and fro by 0.3 rad.
    assert_eq!(warnings(drum, r#"("-3*y*cos(10*t)", "3*x*cos(10*t)")"#), 1);
}

#[test]
fn other_velocities_are_not() {
    let drum = r#"Select(body: "drum")"#;
    let end = r#"Select(body: "bar", within: Box(min: (0.6, -1), max: (1, 1)))"#;
    for (on, value) in [
        // 0.1 rad, a shear, a stretch, a wave, and a rotation along circles.
        (drum, r#"("-0.2*y", "0.2*x")"#),
        (drum, r#"("2*y", 0)"#),
        (end, r#"("2*(x - 0.6)", "-2*y")"#),
        (drum, r#"(0, "sin(30*x - 20*t)")"#),
        (drum, r#"("-2*(x*sin(2*t) + y*cos(2*t))", "2*(x*cos(2*t) - y*sin(2*t))")"#),
        (drum, r#"("2", "-1")"#),
    ] {
        assert_eq!(warnings(on, value), 0, "{value}");
    }
}
