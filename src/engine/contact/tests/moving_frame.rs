//! The same meeting in frames that move: its course and its steps are the same.

use glam::DVec3;

use super::{centre, simulation};

/// Steps of two blocks that meet at 4 m/s, and the velocity of the second one in the frame afterwards, m/s.
fn meeting(formulation: &str, surface: &str, frame: DVec3) -> (u64, DVec3) {
    let body = |name: &str, x: f64, y: f64, speed: f64| {
        let (u, v) = (frame.x + speed, frame.y);
        format!(
            r#"(name: "{name}", material: "rubber", shape: Box(min: ({x}, {y}), max: ({}, {})), spacing: 0.01, formulation: {formulation}, velocity: ({u}, {v})),"#,
            x + 0.08,
            y + 0.08
        )
    };
    let text = format!(
        r#"(dimension: Two, materials: {{"rubber": NeoHookean(density: 1000, young: 1e6, poisson: 0.3)}},
            bodies: [{}{}], contacts: [Contact(between: ("one", "other"), surface: {surface})], time: (end: 0.02))"#,
        body("one", -0.082, 0.0, 2.0),
        body("other", 0.002, 0.02, -2.0)
    );
    let mut sim = simulation(&text);
    sim.run(|_| true).expect("a run");
    (sim.clock().step, centre(&sim, 1).1 - frame)
}

#[test]
fn a_common_velocity_changes_neither_the_course_nor_the_steps() {
    for (formulation, surface) in
        [("TotalLagrangian", "Skin"), ("TotalLagrangian", "Particles"), ("Eulerian", "Particles")]
    {
        let (steps, velocity) = meeting(formulation, surface, DVec3::ZERO);
        let (moving, same) = meeting(formulation, surface, DVec3::new(300.0, -200.0, 0.0));
        assert!(moving < steps + steps / 5, "{formulation}, {surface}: {moving} steps in place of {steps}");
        assert!(
            (same - velocity).length() < 0.02 * 4.0,
            "{formulation}, {surface}: {same} m/s in place of {velocity}"
        );
    }
}
