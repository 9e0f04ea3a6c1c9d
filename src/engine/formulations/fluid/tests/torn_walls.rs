//! Walls of which a part moves against the rest.

use super::simulation;

/// A vessel whose left side is a piston: a part of the vessel, moved as `condition` says.
fn vessel(condition: &str) -> bool {
    let sim = simulation(&format!(
        r#"(dimension: Two, materials: {{"liquid": Fluid(density: 1000.0, sound_speed: 10.0)}},
            bodies: [
                (name: "liquid", material: "liquid", spacing: 0.1, formulation: Fluid(pressure: 0.0), shape: Box(min: (0, 0), max: (1, 1))),
                (name: "vessel", material: "wall", spacing: 0.1, formulation: Wall(slip: Free, suction: true),
                 shape: Difference(Box(min: (-0.4, -0.4), max: (1.4, 1.4)), Box(min: (0, 0), max: (1, 1)))),
            ],
            conditions: [{condition}], time: (end: 1.0))"#
    ));
    sim.warnings().iter().any(|warning| warning.contains("a part of the wall `vessel` moves"))
}

/// Between the parts of one body there are no edges: the piston had 0.89 of its force.
#[test]
fn a_part_of_a_wall_that_moves_against_the_rest_is_warned_of() {
    let part = r#"on: Select(body: "vessel", within: Box(min: (-0.4, 0), max: (0, 1)))"#;
    assert!(vessel(&format!(r#"Displacement({part}, value: ("0.02*smoothstep(t)", 0))"#)));
    assert!(vessel(&format!("Velocity({part}, value: (0.02, None))")));
}

#[test]
fn a_part_of_a_wall_that_moves_with_the_rest_or_bends_is_not() {
    let part = r#"on: Select(body: "vessel", within: Box(min: (-0.4, 0), max: (0, 1)))"#;
    let rest = r#"on: Select(body: "vessel", within: Difference(Box(min: (-1, -1), max: (2, 2)), Box(min: (-0.4, 0), max: (0, 1))))"#;
    assert!(!vessel(&format!("Fix({part})")));
    assert!(!vessel(r#"Velocity(on: Select(body: "vessel"), value: (0.1, 0))"#));
    assert!(!vessel(&format!("Velocity({part}, value: (0.1, 0)), Velocity({rest}, value: (0.1, 0))")));
    // A side that bulges out from where it is held.
    assert!(!vessel(&format!(r#"Displacement({part}, value: ("0.1*t*sin(pi*y)", 0))"#)));
}
