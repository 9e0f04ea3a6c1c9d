//! Effects that appear only in long runs: friction springs that creep.

use super::simulation;
use crate::rigid::RigidBodies;

#[test]
fn a_block_that_sticks_on_an_incline_does_not_creep_over_200_000_steps() {
    let mut sim = simulation(
        r#"(dimension: Two, gravity: (3.0, -9.0),
            materials: {"stone": NeoHookean(density: 1000, young: 1e7, poisson: 0.3)},
            bodies: [
                (name: "slope", material: "stone", shape: Box(min: (-1, -1), max: (2, 0)), spacing: 0.5, formulation: Rigid()),
                (name: "block", material: "stone", shape: Box(min: (0, 0), max: (0.2, 0.1)), spacing: 0.05, formulation: Rigid()),
            ],
            conditions: [Fix(on: Select(body: "slope"))],
            contacts: [Contact(between: ("block", "slope"), law: Penalty(stiffness: 1e6), friction: 0.5, restitution: 0.3)],
            time: (end: 100.0))"#,
    );
    let place = |sim: &crate::simulation::Simulation| {
        let bodies = sim.resources().get::<RigidBodies>();
        let state = bodies[1].state;
        state.center
    };
    sim.run(|sim| sim.clock().step < 20_000).unwrap();
    let (before, time) = (place(&sim), sim.clock().time);
    sim.run(|sim| sim.clock().step < 220_000).unwrap();
    let creep = (place(&sim) - before).length();
    assert!(sim.clock().time > time + 1.0, "{}", sim.clock().time);
    assert!(creep < 1e-12, "{creep}");
    // It hangs in springs that are stretched by some ten micrometres.
    assert!((1e-6..1e-4).contains(&(before.x - 0.1)), "{before}");
}
