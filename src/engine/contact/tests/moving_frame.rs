//! Galilean invariance: the same collision in moving frames has the same motion and the same steps.

use glam::DVec3;

use super::{centre, simulation};

/// A pair of blocks that meets at 4 m/s, moved by a height, m, and a velocity, m/s.
fn pair(kind: &str, names: [&str; 2], height: f64, frame: DVec3) -> String {
    let body = |name: &str, x: f64, y: f64, speed: f64| {
        let (u, v) = (frame.x + speed, frame.y);
        format!(
            r#"(name: "{name}", material: "rubber", shape: Box(min: ({x}, {y}), max: ({}, {})), spacing: 0.01, formulation: {kind}, velocity: ({u}, {v})),"#,
            x + 0.08,
            y + 0.08
        )
    };
    body(names[0], -0.082, height, 2.0) + &body(names[1], 0.002, height + 0.02, -2.0)
}

/// A scene of these bodies and contacts.
fn scene(bodies: &str, contacts: &str) -> String {
    format!(
        r#"(dimension: Two, materials: {{"rubber": NeoHookean(density: 1000, young: 1e6, poisson: 0.3)}},
            bodies: [{bodies}], contacts: [{contacts}], time: (end: 0.02))"#
    )
}

/// Steps of a scene, and the velocity of its body of that number afterwards, m/s.
fn run(text: &str, body: usize) -> (u64, DVec3) {
    let mut sim = simulation(text);
    sim.run(|_| true).expect("a run");
    (sim.clock().step, centre(&sim, body).1)
}

const KINDS: [(&str, &str); 4] = [
    ("TotalLagrangian", "surface: Skin"),
    ("TotalLagrangian", "surface: Particles"),
    ("Eulerian", "surface: Particles"),
    ("Rigid()", ""),
];

#[test]
fn a_common_velocity_changes_neither_the_course_nor_the_steps() {
    for (kind, surface) in KINDS {
        let contact = format!(r#"Contact(between: ("one", "other"), {surface})"#);
        let meeting = |frame| run(&scene(&pair(kind, ["one", "other"], 0.0, frame), &contact), 1);
        let frame = DVec3::new(300.0, -200.0, 0.0);
        let (steps, velocity) = meeting(DVec3::ZERO);
        let (moving, same) = meeting(frame);
        assert!(moving < steps + steps / 50, "{kind}, {surface}: {moving} steps in place of {steps}");
        let same = same - frame;
        assert!(
            (same - velocity).length() < 0.02 * 4.0,
            "{kind}, {surface}: {same} m/s in place of {velocity}"
        );
    }
}

#[test]
fn two_pairs_that_move_apart_take_the_steps_of_pairs_at_rest() {
    for (kind, surface) in KINDS {
        let contact =
            |names: [&str; 2]| format!(r#"Contact(between: ("{}", "{}"), {surface}),"#, names[0], names[1]);
        let (left, right) = (["one", "other"], ["third", "fourth"]);
        let contacts = contact(left) + &contact(right);
        let meeting = |frame: DVec3| {
            let bodies = pair(kind, left, 0.0, frame) + &pair(kind, right, 1.0, -frame);
            run(&scene(&bodies, &contacts), 3)
        };
        let frame = DVec3::new(300.0, 0.0, 0.0);
        let (steps, velocity) = meeting(DVec3::ZERO);
        let (moving, same) = meeting(frame);
        assert!(moving < steps + steps / 50, "{kind}, {surface}: {moving} steps in place of {steps}");
        let same = same + frame;
        assert!(
            (same - velocity).length() < 0.02 * 4.0,
            "{kind}, {surface}: {same} m/s in place of {velocity}"
        );
    }
}
