//! Friction and rotation: no spontaneous rotation, and no friction in a rigid rotation.

use super::{column, double, simulation};
use crate::simulation::Simulation;
use crate::world::{Mass, Position, Velocity};

/// Angular momentum of some bodies about the origin, kg m2/s.
fn angular_momentum(sim: &Simulation, bodies: usize) -> f64 {
    let of = |body| {
        let (x, v) = (column::<Position>(sim, body), column::<Velocity>(sim, body));
        let m = column::<Mass>(sim, body);
        (0..x.len()).map(|k| m[k].0 * x[k].0.cross(v[k].0).z).sum::<f64>()
    };
    (0..bodies).map(of).sum()
}

#[test]
fn a_square_of_oil_that_spins_freely_keeps_its_angular_momentum() {
    let mut sim = double(
        r#"(dimension: Two, materials: {"oil": Fluid(density: 1000.0, sound_speed: 20.0, viscosity: 20.0)},
            bodies: [(name: "oil", material: "oil", shape: Box(min: (-0.5, -0.5), max: (0.5, 0.5)), spacing: 0.05, formulation: Fluid)],
            conditions: [InitialVelocity(on: Select(body: "oil"), value: ("-y", "x"))],
            time: (end: 1.0))"#,
    );
    sim.start().expect("a start");
    let before = angular_momentum(&sim, 1);
    sim.run(|_| true).expect("a run");
    let after = angular_momentum(&sim, 1);
    assert!((after - before).abs() < 1e-11 * before, "{before} {after}");
    assert!(sim.ledger().total_named("viscosity") >= 0.0);
}

/// Oil between a body that spins and nothing: a drop with a core.
fn drop_with_core(core: &str, start: &str) -> Simulation {
    double(&format!(
        r#"(dimension: Two, materials: {{"oil": Fluid(density: 1000.0, sound_speed: 10.0, viscosity: 30.0),
                "rubber": NeoHookean(density: 1500.0, young: 2.0e5, poisson: 0.3)}},
            bodies: [
                (name: "oil", material: "oil", shape: Ring(center: (0, 0), inner: 0.2, outer: 0.5), spacing: 0.04,
                 formulation: Fluid(pressure: "0")),
                (name: "core", material: "rubber", shape: Sphere(center: (0, 0), radius: 0.2), spacing: 0.04, formulation: {core}),
            ],
            conditions: [{start}],
            time: (end: 0.2, sub_steps: 1))"#
    ))
}

/// Angular momentum and rate of a core that is a rigid disc: with the inertia of the disc, not of its
/// particles as points.
fn of_disc(sim: &Simulation) -> f64 {
    let (x, m) = (column::<Position>(sim, 1), column::<Mass>(sim, 1));
    let points: f64 = (0..x.len()).map(|k| m[k].0 * x[k].0.length_squared()).sum();
    let momentum = angular_momentum(sim, 2) - angular_momentum(sim, 1);
    let mass: f64 = m.iter().map(|m| m.0).sum();
    momentum / points * 0.5 * mass * 0.2 * 0.2
}

/// Angular momentum of a core that deforms.
fn of_particles(sim: &Simulation) -> f64 {
    angular_momentum(sim, 2) - angular_momentum(sim, 1)
}

#[test]
fn oil_and_what_spins_in_it_keep_their_angular_momentum() {
    type OfCore = fn(&Simulation) -> f64;
    let turning = r#"InitialVelocity(on: Select(body: "core"), value: ("-3*y", "3*x"))"#;
    let cores: [(&str, &str, OfCore); 2] =
        [("Rigid(spin: (0, 0, 3))", "", of_disc), ("TotalLagrangian", turning, of_particles)];
    for (core, start, of_core) in cores {
        let mut sim = drop_with_core(core, start);
        sim.start().expect("a start");
        let (before, of_core_before) = (of_core(&sim) + angular_momentum(&sim, 1), of_core(&sim));
        sim.run(|_| true).expect("a run");
        let (after, of_core_after) = (of_core(&sim) + angular_momentum(&sim, 1), of_core(&sim));
        assert!((after - before).abs() < 1e-9 * before, "{core}: {before} {after}");
        assert!(of_core_after < 0.8 * of_core_before, "{core}: {of_core_before} {of_core_after}");
        assert!(sim.ledger().relative_error().abs() < 5e-3, "{}", sim.ledger().relative_error());
    }
}

#[test]
fn oil_that_turns_with_its_walls_feels_no_friction() {
    let turn = r#"("x*(cos(2*t) - 1) - y*sin(2*t)", "x*sin(2*t) + y*(cos(2*t) - 1)")"#;
    let mut sim = simulation(&format!(
        r#"(dimension: Two, materials: {{"oil": Fluid(density: 1000.0, sound_speed: 20.0, viscosity: 50.0)}},
            bodies: [
                (name: "oil", material: "oil", shape: Ring(center: (0, 0), inner: 0.5, outer: 1.0), spacing: 0.05,
                 formulation: Fluid(pressure: "0")),
                (name: "walls", material: "wall", spacing: 0.05, formulation: Wall(slip: No, suction: true),
                 shape: Union([Ring(center: (0, 0), inner: 0.3, outer: 0.5), Ring(center: (0, 0), inner: 1.0, outer: 1.2)])),
            ],
            conditions: [InitialVelocity(on: Select(body: "oil"), value: ("-2*y", "2*x")),
                         Displacement(on: Select(body: "walls"), value: {turn})],
            time: (end: 1.0))"#
    ));
    sim.run(|sim| sim.clock().step < 10).expect("a run");
    // Friction that feels the rotation makes 0.6 of mu (2 omega)^2 in all of the oil; there is some of the
    // first half step, in which the walls are not yet in motion, and of the first acoustic wave.
    let sheared = 50.0 * 4.0 * 4.0 * std::f64::consts::PI * 0.75 * sim.clock().time;
    let heat = sim.ledger().total_named("viscosity");
    assert!(heat.abs() < 0.1 * sheared, "{heat} of {sheared} J");
}
