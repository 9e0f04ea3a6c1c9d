//! What contact and loads cannot do well is told: edges at sides held along their normals.

mod common;

use common::simulation;
use meshless::scene::Source;
use meshless::simulation::Simulation;

fn built(text: String) -> Simulation {
    simulation(&Source::new("scene.ron", text))
}

fn says(sim: &Simulation, part: &str) -> bool {
    sim.warnings().iter().any(|text| text.contains(part))
}

/// Whether a block that falls on a floor, which begins at `from`, m, is said to be off beside its side at
/// x = 0.
fn lands_beside_a_side(support: &str, from: f64) -> bool {
    let mut sim = built(format!(
        r#"(dimension: Two, materials: {{"m": NeoHookean(density: 1000, young: 1e8, poisson: 0.3)}},
        bodies: [
            (name: "block", material: "m", shape: Box(min: (0, 0.001), max: (0.5, 0.3)), spacing: 0.05, formulation: TotalLagrangian, velocity: (0, -2), plugins: [hourglass_control()]),
            (name: "floor", material: "m", shape: Box(min: ({from:?}, -0.1), max: (1, 0)), spacing: 0.05, formulation: Rigid()),
        ],
        conditions: [Fix(on: Select(body: "floor")), {support}],
        contacts: [Contact(between: ("block", "floor"))], time: (end: 1.5e-3))"#
    ));
    sim.run(|_| true).expect("a run");
    says(&sim, "contact on body `block` reaches its side at x = 0 m")
}

#[test]
fn contact_that_reaches_a_side_held_along_its_normal_is_warned_of() {
    let side = r#"Fix(on: Select(body: "block", face: MinX), axes: [X])"#;
    assert!(lands_beside_a_side(side, -0.2));
    // It touches elsewhere; the side is a symmetry plane; what is held does not touch.
    assert!(!lands_beside_a_side(side, 0.25));
    assert!(!lands_beside_a_side("Symmetry(plane: X, at: 0)", 0.0));
    assert!(!lands_beside_a_side(r#"Fix(on: Select(body: "block", face: MaxX), axes: [X])"#, -0.2));
}

#[test]
fn a_load_by_surface_that_reaches_a_side_held_along_its_normal_is_warned_of() {
    let warns = |support: &str, surface: &str| {
        let sim = built(format!(
            r#"(dimension: Two, materials: {{"m": NeoHookean(density: 1000, young: 1e8, poisson: 0.3)}},
            bodies: [(name: "b", material: "m", shape: Box(min: (0, 0), max: (1, 0.5)), spacing: 0.1, formulation: TotalLagrangian)],
            conditions: [{support}, Pressure(on: Select(body: "b", surface: {surface}), value: 1e3)], time: (end: 0.01))"#
        ));
        says(&sim, "the pressure on the surface of body `b` reaches its side at x = 0 m")
    };
    let side = "Fix(on: Select(face: MinX), axes: [X])";
    assert!(warns(side, "Facing(0, 1)"));
    assert!(warns(side, "Outer"));
    // The far side ends elsewhere.
    assert!(!warns(side, "Facing(1, 0)"));
    assert!(!warns("Symmetry(plane: X, at: 0)", "Facing(0, 1)"));
}
