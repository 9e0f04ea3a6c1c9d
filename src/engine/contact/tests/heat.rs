//! Friction heat: the energy booked as friction warms the sides by their shares.

use super::simulation;
use crate::simulation::Simulation;
use crate::world::{BodyId, Mass, Temperature};

const SPECIFIC_HEAT: f64 = 450.0;

/// A block that slides on `floor` at 2 m/s under its weight, with a contact `between`.
fn sliding(floor: &str, between: &str, surface: &str) -> Simulation {
    simulation(&format!(
        r#"(dimension: Two, gravity: (0, -2e3),
            materials: {{"metal": J2(density: 8000, young: 1e8, poisson: 0.3, hardening: Linear(yield_stress: 1e9, modulus: 0),
                                     heating: (specific_heat: {SPECIFIC_HEAT}, temperature: 300))}},
            bodies: [(name: "block", material: "metal", shape: Box(min: (0, 0.0001), max: (0.02, 0.0101)), spacing: 0.001,
                      formulation: TotalLagrangian(), velocity: (2, 0)),
                     (name: "floor", material: "metal", shape: Box(min: (-0.02, -0.004), max: (0.06, 0)), spacing: 0.001, formulation: {floor})],
            conditions: [Fix(on: Select(body: "floor"))],
            contacts: [Contact(between: {between}, law: Penalty(), friction: 0.3, restitution: 0.8, friction_heat: 0.7, surface: {surface})],
            time: (end: 2e-3))"#
    ))
}

/// Heat that a body has taken up, J.
fn heat(sim: &Simulation, body: usize) -> f64 {
    let (view, rows) = sim.world().body_view(BodyId(body));
    let (mass, temperature) = (view.read::<Mass>().unwrap(), view.read::<Temperature>().unwrap());
    rows.map(|row| mass[row].0 * SPECIFIC_HEAT * (temperature[row].0 - 300.0)).sum()
}

#[test]
fn friction_warms_both_sides_by_their_shares() {
    for (floor, between, share, of_floor) in [
        ("Rigid()", r#"("block", "floor")"#, 0.7, 0.0),
        ("Rigid()", r#"("floor", "block")"#, 0.3, 0.0),
        ("TotalLagrangian()", r#"("block", "floor")"#, 0.7, 0.3),
    ] {
        for surface in ["Particles", "Skin"] {
            let mut sim = sliding(floor, between, surface);
            assert!(
                sim.warnings().iter().all(|warning| !warning.contains("touches with")),
                "{:?}",
                sim.warnings()
            );
            sim.run(|_| true).unwrap();
            let friction = sim.ledger().total_named("friction");
            assert!(friction > 0.3, "{floor} {between}: {friction}");
            let found = heat(&sim, 0) / friction;
            assert!((found - share).abs() < 0.01 * share, "{floor} {between}: {found}");
            if of_floor > 0.0 {
                let found = heat(&sim, 1) / friction;
                assert!((found - of_floor).abs() < 0.01 * of_floor, "{floor} {between}: {found}");
            }
        }
    }
}

/// A contact of families warms the pairs that can be warmed, and is no error for the others.
#[test]
fn a_family_may_have_members_without_a_specific_heat() {
    let mut sim = simulation(&format!(
        r#"(dimension: Two, gravity: (0, -2e3),
            materials: {{"metal": J2(density: 8000, young: 1e8, poisson: 0.3, hardening: Linear(yield_stress: 1e9, modulus: 0),
                                     heating: (specific_heat: {SPECIFIC_HEAT}, temperature: 300)),
                         "rubber": NeoHookean(density: 1000, young: 1e8, poisson: 0.3)}},
            bodies: [(name: "block", material: "metal", shape: Box(min: (0, 0.0001), max: (0.02, 0.0101)), spacing: 0.001,
                      formulation: TotalLagrangian(), velocity: (2, 0)),
                     (name: "floor", material: "rubber", shape: Box(min: (-0.02, -0.004), max: (0.06, 0)), spacing: 0.001, formulation: Rigid()),
                     (name: "side", material: "rubber", shape: Box(min: (0.07, 0), max: (0.08, 0.01)), spacing: 0.001, formulation: TotalLagrangian())],
            conditions: [Fix(on: Select(body: "floor"))],
            contacts: [Contact(between: ("*", "*"), friction: 0.3, restitution: 0.8, friction_heat: 0.5)],
            time: (end: 1e-3))"#
    ));
    sim.run(|_| true).unwrap();
    let friction = sim.ledger().total_named("friction");
    assert!(friction > 0.1 && (heat(&sim, 0) / friction - 0.5).abs() < 0.01, "{friction}");
}
