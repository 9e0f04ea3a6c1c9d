//! Motion that takes a side off its symmetry plane is warned of, other motion is not.

use crate::assembly::build;
use crate::plugin::Registry;
use crate::scene::{Source, parse};

/// Warnings that name motion in the symmetry plane at which a bar ends.
fn warnings(condition: &str) -> usize {
    let text = format!(
        r#"(dimension: Two, materials: {{"rubber": Rubber()}},
            bodies: [(name: "bar", material: "rubber", shape: Box(min: (0, 0), max: (0.2, 0.1)), spacing: 0.02, formulation: TotalLagrangian)],
            conditions: [{condition}, Symmetry(plane: X, at: 0)], time: (end: 0.5))"#
    );
    let built = parse(Source::new("test.ron", text))
        .and_then(|(scene, source)| build(&scene, &source, &Registry::standard()));
    let sim = built.unwrap_or_else(|error| panic!("{error}"));
    sim.warnings().iter().filter(|warning| warning.contains("in the symmetry plane X = 0")).count()
}

#[test]
fn motion_off_a_symmetry_plane_is_noticed() {
    for condition in [
        r#"Displacement(on: Select(face: MinX), value: ("0.1*t", None))"#,
        r#"Displacement(on: Select(body: "bar"), value: ("-0.01*sin(20*t)", 0))"#,
        r#"Velocity(on: Select(face: MinX), value: ("0.1*t", 0))"#,
    ] {
        assert_eq!(warnings(condition), 1, "{condition}");
    }
}

#[test]
fn motion_that_keeps_a_side_in_its_symmetry_plane_is_not() {
    for condition in [
        r#"Displacement(on: Select(face: MaxX), value: ("0.1*t", None))"#,
        // The plane itself stays where it is.
        r#"Displacement(on: Select(body: "bar"), value: ("0.1*t*x", None))"#,
        r#"Velocity(on: Select(face: MinX), value: (0, "0.1"))"#,
        r#"Velocity(on: Select(face: MinX), value: (None, "0.1"))"#,
        "Fix(on: Select(face: MinX))",
    ] {
        assert_eq!(warnings(condition), 0, "{condition}");
    }
}
