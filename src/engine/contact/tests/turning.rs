//! What sticks to a body that turns about the normal of the contact turns with it.

use glam::DVec3;

use super::simulation;
use crate::simulation::Simulation;
use crate::world::{BodyId, Mass, Position};

/// Angular velocity, 1/s.
const SPIN: f64 = 4.0;

/// A soft block that stands on a turntable, 0.2 m beside its axis, and starts with its velocity: friction of
/// 0.6 holds it where 0.33 would do.
fn turntable(block: &str, surface: &str, turns: f64) -> Simulation {
    simulation(&format!(
        r#"(dimension: Three, gravity: (0, 0, -9.81),
            materials: {{"gel": NeoHookean(density: 1000, young: 2e4, poisson: 0.3)}},
            bodies: [
                (name: "table", material: "gel", shape: Cylinder(from: (0, 0, -0.06), to: (0, 0, 0), radius: 0.26), spacing: 0.03, formulation: Rigid()),
                (name: "block", material: "gel", shape: Box(min: (0.17, -0.03, 0), max: (0.23, 0.03, 0.03)), spacing: 0.015, formulation: {block}),
            ],
            conditions: [Fix(on: Select(body: "table")), RotationRate(on: Select(body: "table"), rate: {SPIN}), InitialVelocity(on: Select(body: "block"), value: ("-{SPIN}*y", "{SPIN}*x", 0.0))],
            contacts: [(between: ("block", "table"), friction: 0.6, restitution: 0.2, surface: {surface})],
            time: (end: {:?}))"#,
        turns * 2.0 * std::f64::consts::PI / SPIN,
    ))
}

fn middle(sim: &Simulation) -> DVec3 {
    let (view, rows) = sim.world().body_view(BodyId(1));
    let (mass, position) = (view.read::<Mass>().unwrap(), view.read::<Position>().unwrap());
    let sum = rows.clone().map(|row| mass[row].0 * position[row].0).sum::<DVec3>();
    sum / rows.map(|row| mass[row].0).sum::<f64>()
}

/// A spring that kept its direction in space would let the block creep by its stretch in every radian, and
/// one that followed the velocities of the mid-step at the places of the end by `omega dt / 2` of the way.
#[test]
fn a_block_that_sticks_to_a_turntable_does_not_creep() {
    for (block, surface) in
        [("Rigid()", "Skin"), ("TotalLagrangian()", "Skin"), ("TotalLagrangian()", "Particles")]
    {
        // After half a turn the block has settled.
        let [mut first, mut last] = [0.5, 4.5].map(|turns| turntable(block, surface, turns));
        let [from, to] = [&mut first, &mut last].map(|sim| {
            sim.run(|_| true).expect("a run");
            middle(sim)
        });
        assert!(from.distance(to) < 1e-4, "{block} {surface}: {from} {to}");
        // Nothing slides: there is no heat of friction, of a kinetic energy of 35 mJ.
        let [before, after] = [&first, &last].map(|sim| sim.ledger().total_named("friction"));
        assert!((after - before).abs() < 1e-4, "{block} {surface}: {before} J {after} J");
    }
}
