//! What contact and loads cannot do well is told: edges at sides held along their normals, chatter.

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

/// Whether a block is said to chatter that slides down a slope, by so many degrees steeper than that at which
/// friction holds it, for .6 s.
fn chatters_on_a_slope(excess: f64, plugins: &str) -> bool {
    let angle = 0.3f64.atan() + excess.to_radians();
    let (along, down) = (9.81 * angle.sin(), 9.81 * angle.cos());
    let mut sim = built(format!(
        r#"(dimension: Two, gravity: ({along:?}, -{down:?}), materials: {{"m": NeoHookean(density: 1000, young: 1e6, poisson: 0.3)}},
        bodies: [
            (name: "floor", material: "m", shape: Box(min: (-1, -0.2), max: (4, 0)), spacing: 0.05, formulation: Rigid()),
            (name: "block", material: "m", shape: Box(min: (0, 0), max: (0.4, 0.4)), spacing: 0.025, formulation: TotalLagrangian(), plugins: [{plugins}]),
        ],
        conditions: [Fix(on: Select(body: "floor"))],
        contacts: [(between: ("block", "floor"), friction: 0.3)], time: (end: 0.6))"#
    ));
    sim.run(|_| true).expect("a run");
    says(&sim, "bodies `block` and `floor` chatter: until ")
}

#[test]
fn a_block_that_chatters_as_it_slides_is_warned_of() {
    assert!(chatters_on_a_slope(0.5, "hourglass_control()"));
    assert!(!chatters_on_a_slope(0.5, "hourglass_control(), artificial_viscosity()"));
    // All of it slides all the time.
    assert!(!chatters_on_a_slope(13.3, "hourglass_control()"));
}

/// Points of a body that rolls stick once in each turn.
#[test]
fn a_body_that_rolls_or_bounces_does_not_chatter() {
    let says_of = |height: f64, velocity: &str, end: f64| {
        let mut sim = built(format!(
            r#"(dimension: Two, gravity: (0, -9.81), materials: {{"m": NeoHookean(density: 1000, young: 1e6, poisson: 0.3)}},
            bodies: [
                (name: "floor", material: "m", shape: Box(min: (-1, -0.2), max: (4, 0)), spacing: 0.05, formulation: Rigid()),
                (name: "disc", material: "m", shape: Sphere(center: (0, {height}), radius: 0.1), spacing: 0.0125, lattice: Concentric, formulation: TotalLagrangian(), plugins: [hourglass_control()]),
            ],
            conditions: [Fix(on: Select(body: "floor")), InitialVelocity(on: Select(body: "disc"), value: {velocity})],
            contacts: [(between: ("disc", "floor"), friction: 0.3)], time: (end: {end:?}))"#
        ));
        sim.run(|_| true).expect("a run");
        says(&sim, "chatter")
    };
    assert!(!says_of(0.1, r#"("1 + 10*(y - 0.1)", "-10*x")"#, 0.3));
    assert!(!says_of(0.12, r#"(1, -1)"#, 1.0));
}

/// A rigid disc without a dashpot that rolls from rest under a sudden weight bounces on its spring, and slips
/// for a moment each time that it is nearly unloaded. It rolls with two thirds of the acceleration along the
/// floor all the same.
#[test]
fn a_rigid_disc_that_bounces_as_it_rolls_does_not_chatter() {
    let mut sim = built(
        r#"(dimension: Two, gravity: (3, -9), materials: {"m": NeoHookean(density: 1000, young: 1e8, poisson: 0.3)},
        bodies: [
            (name: "floor", material: "m", shape: HalfSpace(point: (0, 0), normal: (0, 1)), spacing: 0.01, formulation: Rigid()),
            (name: "disc", material: "m", shape: Sphere(center: (0, 0.1), radius: 0.1), spacing: 0.01, formulation: Rigid()),
        ],
        conditions: [Fix(on: Select(body: "floor"))],
        contacts: [(between: ("disc", "floor"), friction: 0.5)], time: (end: 0.3))"#
            .to_owned(),
    );
    sim.run(|_| true).expect("a run");
    assert!(!says(&sim, "chatter"), "{:?}", sim.warnings());
}

/// A rigid disc between the particles of a block that has been drawn to twice its size.
#[test]
fn a_body_among_debris_is_not_inside_of_what_has_failed() {
    let warned = |failure: &str| {
        let mut sim = built(format!(
            r#"(dimension: Two, materials: {{"m": NeoHookean(density: 1000, young: 1e6, poisson: 0.3)}},
            bodies: [
                (name: "block", material: "m", shape: Box(min: (0, 0), max: (0.6, 0.6)), spacing: 0.1, formulation: TotalLagrangian, plugins: [{failure}]),
                (name: "disc", material: "m", shape: Sphere(center: (0.8, 0.8), radius: 0.05), spacing: 0.02, formulation: Rigid()),
            ],
            conditions: [InitialDisplacement(on: Select(body: "block"), value: ("x", "y"))],
            contacts: [Contact(between: ("block", "disc"))], time: (end: 2e-6), record: (every: 1e-6))"#
        ));
        sim.run(|_| true).expect("a run");
        says(&sim, "of `disc` is inside of `block`")
    };
    assert!(warned(""));
    assert!(!warned("failure(criterion: MaximumPrincipalStrain(limit: 0.5), then: NoTension)"));
}
