//! A soft block under a shear flow: friction acts at its surface, not at the particles below it.

use glam::DVec3;

use super::{column, simulation};
use crate::world::{Position, ReferencePosition};

/// Oil, 1 m deep, between a lid that slides and a block of rubber, whose lower side is held.
fn sheared_block(across: usize) -> String {
    let dx = 1.0 / across as f64;
    let (length, lid) = (8.0 * dx, 1.0 + 4.0 * dx);
    format!(
        r#"(dimension: Two, domain: (min: (0.0, -2.0), max: ({length}, 3.0), periodic: [X]),
            materials: {{"oil": Fluid(density: 1.0, sound_speed: 5.0, viscosity: 1.0),
                        "rubber": NeoHookean(density: 1.0, young: 26.0, poisson: 0.3)}},
            bodies: [
                (name: "oil", material: "oil", shape: Box(min: (0.0, 0.0), max: ({length}, 1.0)), spacing: {dx}, formulation: Fluid),
                (name: "block", material: "rubber", shape: Box(min: (0.0, -1.0), max: ({length}, 0.0)), spacing: {dx},
                 formulation: TotalLagrangian),
                (name: "lid", material: "wall", shape: Box(min: (0.0, 1.0), max: ({length}, {lid})), spacing: {dx},
                 formulation: Wall(slip: No, suction: true)),
            ],
            conditions: [
                Velocity(on: Select(body: "lid"), value: ("0.1", "0")),
                Fix(on: Select(body: "block", face: MinY)),
            ],
            time: (end: 3.0))"#
    )
}

#[test]
fn couette_flow_shears_a_soft_block_up_to_its_surface() {
    for across in [10, 20] {
        let dx = 1.0 / across as f64;
        let mut sim = simulation(&sheared_block(across));
        sim.run(|_| true).expect("a run");
        let moved: Vec<(f64, DVec3)> = column::<ReferencePosition>(&sim, 1)
            .iter()
            .zip(column::<Position>(&sim, 1))
            .map(|(reference, now)| (reference.0.y, now.0 - reference.0))
            .collect();
        let row = |k: usize| {
            let y = -(k as f64 + 0.5) * dx;
            let of_row: Vec<f64> =
                moved.iter().filter(|(at, _)| (at - y).abs() < 0.1 * dx).map(|(_, u)| u.x).collect();
            of_row.iter().sum::<f64>() / of_row.len() as f64
        };
        // The shear stress is mu U / h = 0.1 Pa, G 10 Pa.
        let expected = 0.01 * 4.0 * dx;
        let sheared = row(0) - row(4);
        assert!(
            (sheared / expected - 1.0).abs() < 0.06,
            "{across} across: {sheared} m in the place of {expected} m"
        );
        let tilted = moved.iter().map(|(_, u)| u.y.abs()).fold(0.0, f64::max);
        assert!(tilted < 1e-4, "{tilted} m");
        assert!(sim.ledger().relative_error().abs() < 5e-3, "{}", sim.ledger().relative_error());
    }
}
