//! Walls that hold every particle, and give no energy.

use super::tests::{column, simulation};
use crate::world::Position;

#[test]
fn a_splash_stays_in_its_tank_and_gets_no_energy_from_walls() {
    // 128 particles, few of them with neighbours on all sides, without anything that damps.
    let mut sim = simulation(
        r#"(dimension: Three, gravity: (0.0, 0.0, -9.81), materials: {"water": Fluid(density: 1000.0, sound_speed: 28.0)},
            bodies: [
                (name: "water", material: "water", shape: Box(min: (0, 0, 0), max: (0.2, 0.2, 0.4)), spacing: 0.05, formulation: Fluid),
                (name: "tank", material: "wall", spacing: 0.05, formulation: Wall(),
                 shape: Difference(Box(min: (-0.15, -0.15, -0.15), max: (0.75, 0.35, 0.8)), Box(min: (0, 0, 0), max: (0.6, 0.2, 1)))),
            ],
            time: (end: 1.2))"#,
    );
    sim.run(|sim| {
        let depth = |x: &Position| (-x.0).max_element().max(x.0.x - 0.6).max(x.0.y - 0.2);
        let deepest = column::<Position>(sim, 0).iter().map(depth).fold(f64::NEG_INFINITY, f64::max);
        assert!(deepest < 0.5 * 0.05, "{deepest} m at {} s", sim.clock().time);
        true
    })
    .expect("a run");
    let ledger = sim.ledger();
    assert!(ledger.total_named("wall_pressure") > -0.05 * ledger.largest(), "{ledger:?}");
    assert!(ledger.relative_error().abs() < 1e-2, "{}", ledger.relative_error());
}
