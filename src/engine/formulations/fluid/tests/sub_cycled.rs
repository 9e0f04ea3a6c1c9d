//! A body beside a fluid, in sub-steps.

use super::simulation;

/// Runs rubber, half a centimetre thick, under water, eight of its particles and four of the water's over the
/// thickness, with further materials, bodies and conditions until `end`, s. It takes more than `sub_steps` in
/// a step of the water, and does not ring.
fn strip_does_not_ring([materials, bodies, conditions]: [&str; 3], end: f64, sub_steps: u64) {
    let mut sim = simulation(&format!(
        r#"(dimension: Two, gravity: (0.0, -9.81), domain: (min: (0, -0.1), max: (0.01, 0.1), periodic: [X]),
            materials: {{"water": Fluid(density: 1000.0, viscosity: 1.0e-3, sound_speed: 16.6),
                        "rubber": NeoHookean(density: 1100.0, young: 7.8e6, poisson: 0.47), {materials}}},
            bodies: [
                (name: "water", material: "water", shape: Box(min: (0, 0), max: (0.01, 0.01)), spacing: 0.00125,
                 formulation: Fluid(pressure: "1000")),
                (name: "strip", material: "rubber", shape: Box(min: (0, -0.005), max: (0.01, 0)), spacing: 0.000625,
                 formulation: TotalLagrangian),
                {bodies}
                (name: "lid", material: "wall", shape: Box(min: (0, 0.01), max: (0.01, 0.015)), spacing: 0.00125,
                 formulation: Wall(suction: true)),
            ],
            conditions: [Fix(on: Select(body: "strip", within: Box(min: (-1, -0.01), max: (1, -0.0044)))), {conditions}],
            time: (end: {end:?}))"#
    ));
    sim.run(|_| true).expect("a run");
    let (short, long) = (sim.sub_steps().map_or(0, |steps| steps.1), sim.clock().step);
    assert!(short > sub_steps * long, "{short} sub-steps in {long}");
    let ledger = sim.ledger();
    let (error, kinetic) = (ledger.relative_error().abs(), ledger.total_named("kinetic"));
    assert!(error < 1e-3, "energy is off by {error}");
    assert!(kinetic < 1e-2 * ledger.total_named("compression"), "{kinetic} J of motion");
}

/// The modes of the rubber that turn half a phase in a step of the water rose tenfold in 0.01 s before they
/// were damped.
#[test]
fn a_strip_under_water_does_not_ring() {
    strip_does_not_ring(["", "", ""], 0.03, 15);
}

/// The same strip in a scene with a stiff block, far away in the dry, which takes ten times as many
/// sub-steps: the damping of the strip in each of them was that of its own, and it rang until the run ended.
#[test]
fn a_strip_under_water_does_not_ring_in_the_sub_steps_of_a_stiffer_body() {
    let block = r#"(name: "block", material: "stiff", shape: Box(min: (0, 0.05), max: (0.0025, 0.0525)), spacing: 0.000625,
                 formulation: TotalLagrangian),"#;
    let stiff = r#""stiff": NeoHookean(density: 1100.0, young: 7.8e8, poisson: 0.47)"#;
    strip_does_not_ring([stiff, block, r#"Fix(on: Select(body: "block", face: MinY))"#], 0.02, 25);
}

/// A block that conditions press together beside a fluid: its stable step falls with its stretch, known from
/// the conditions, long step by long step. With half the spacing of the fluid its damping shortens no
/// sub-steps.
#[test]
fn the_stretches_of_a_body_in_short_steps_are_refreshed_by_its_own_clock() {
    let mut sim = simulation(
        r#"(dimension: Two,
            materials: {"water": Fluid(density: 1000.0, viscosity: 1.0e-3, sound_speed: 20),
                        "rubber": NeoHookean(density: 1000.0, young: 1e7, poisson: 0.3)},
            bodies: [
                (name: "water", material: "water", shape: Box(min: (0, 0), max: (0.48, 0.48)), spacing: 0.04, formulation: Fluid),
                (name: "block", material: "rubber", shape: Box(min: (10, 0), max: (10.2, 0.2)), spacing: 0.02,
                 formulation: TotalLagrangian),
            ],
            conditions: [Velocity(on: Select(body: "block"), value: ("-20*(x - 10)", "0"))],
            time: (end: 1))"#,
    );
    sim.start().expect("a start");
    let unstretched = sim.short_limit().expect("a limit").dt;
    for _ in 0..16 {
        sim.step().expect("a step");
        let stretch = 1.0 - 20.0 * sim.clock().time;
        let factor = sim.short_limit().expect("a limit").dt / unstretched;
        // It was that of at most ten sub-steps before, which are no longer than the first.
        let late = factor - stretch;
        assert!((-1e-9..10.0 * 20.0 * unstretched).contains(&late), "{factor} at a stretch of {stretch}");
    }
    let (short, long) = (sim.sub_steps().map_or(0, |steps| steps.1), sim.clock().step);
    assert!(short > 5 * long && sim.clock().time > 0.01, "{short} sub-steps in {long}");
}

/// The same under oil three thousand times as viscous. Friction that was frozen in the steps of the oil
/// pushed on what swung there and back within three of them: it gave energy, without end.
#[test]
fn friction_with_a_strip_in_short_steps_takes_energy() {
    let mut sim = simulation(
        r#"(dimension: Two, domain: (min: (0, -0.1), max: (0.01, 0.1), periodic: [X]),
            materials: {"oil": Fluid(density: 1000.0, viscosity: 4.0, sound_speed: 16.6),
                        "rubber": NeoHookean(density: 1100.0, young: 7.8e6, poisson: 0.47)},
            bodies: [
                (name: "oil", material: "oil", shape: Box(min: (0, 0), max: (0.01, 0.01)), spacing: 0.00125,
                 formulation: Fluid(pressure: "0")),
                (name: "strip", material: "rubber", shape: Box(min: (0, -0.005), max: (0.01, 0)), spacing: 0.000625,
                 formulation: TotalLagrangian),
                (name: "lid", material: "wall", shape: Box(min: (0, 0.01), max: (0.01, 0.015)), spacing: 0.00125,
                 formulation: Wall(slip: No, suction: true)),
            ],
            conditions: [Fix(on: Select(body: "strip", within: Box(min: (-1, -0.01), max: (1, -0.0044)))),
                         InitialVelocity(on: Select(body: "strip"), value: ("20*(y + 0.005)", "0"))],
            time: (end: 0.01))"#,
    );
    sim.start().expect("a start");
    let start = sim.ledger().total_named("kinetic");
    let mut taken = 0.0;
    sim.run(|sim| {
        let now = sim.ledger().total_named("viscosity");
        assert!(now > taken - 1e-2 * start, "friction gives {} of {start} J", taken - now);
        taken = f64::max(taken, now);
        true
    })
    .expect("a run");
    let (short, long) = (sim.sub_steps().map_or(0, |steps| steps.1), sim.clock().step);
    assert!(short > 15 * long, "{short} sub-steps in {long}");
    let ledger = sim.ledger();
    assert!(taken > 0.1 * start, "{taken} of {start} J");
    assert!(ledger.relative_error().abs() < 1e-2, "energy is off by {}", ledger.relative_error());
    assert!(ledger.total_named("kinetic") < start, "{} of {start} J", ledger.total_named("kinetic"));
}

/// A disc free of stress that leaves the domain, with a fluid far away: it loses nothing but the kinetic
/// energy of what leaves. The leaving particles stopped while their neighbours drifted on for a sub-step, and
/// the strain that this made went to the damping of the sub-steps, or was lost.
#[test]
fn a_body_that_leaves_the_domain_in_sub_steps_takes_its_kinetic_energy_along_and_no_more() {
    for formulation in ["TotalLagrangian", "UpdatedLagrangian", "Eulerian"] {
        let mut sim = simulation(&format!(
            r#"(dimension: Two, domain: (min: (-1, -0.2), max: (3, 1), outside: Remove),
                materials: {{"water": Fluid(density: 1000, sound_speed: 20),
                            "rubber": NeoHookean(density: 500, young: 1e6, poisson: 0.3)}},
                bodies: [
                    (name: "water", material: "water", shape: Box(min: (2, 0), max: (2.1, 0.1)), spacing: 0.01, formulation: Fluid),
                    (name: "disc", material: "rubber", shape: Sphere(center: (0, 0), radius: 0.1), spacing: 0.01,
                     velocity: (1, -4), formulation: {formulation}),
                ],
                time: (end: 0.06))"#
        ));
        sim.start().expect("a start");
        let before = sim.ledger().total_named("kinetic");
        sim.run(|_| true).expect("a run");
        let (short, long) = (sim.sub_steps().map_or(0, |steps| steps.1), sim.clock().step);
        assert!(short > 2 * long, "{short} sub-steps in {long}");
        let ledger = sim.ledger();
        let of = |name: &str| ledger.total_named(name) / before;
        assert!((0.5..0.9).contains(&of("removed")), "{formulation}: {} is removed", of("removed"));
        let lost = 1.0 - of("removed") - of("kinetic");
        assert!(lost.abs() < 1e-9, "{formulation}: {lost} is lost");
        assert!(of("coupling_damping").abs() < 1e-9, "{formulation}: {} is damped", of("coupling_damping"));
        assert!(of("reference_update").abs() < 1e-9, "{formulation}: {}", of("reference_update"));
        assert!(ledger.relative_error().abs() < 1e-9, "{formulation}: {}", ledger.relative_error());
    }
}
