//! Walls that drag a fluid along, or let it slide, against closed forms.

use std::f64::consts::PI;

use super::{column, simulation};
use crate::simulation::Simulation;
use crate::world::{Position, Velocity};

/// Kinematic viscosity, m2/s; the channel is 1 m wide.
const NU: f64 = 0.1;

fn channel(slip: &str, conditions: &str) -> Simulation {
    simulation(&format!(
        r#"(dimension: Two, domain: (min: (0, -1), max: (0.5, 2), periodic: [X]),
            materials: {{"fluid": Fluid(density: 1.0, sound_speed: 10.0, viscosity: {NU})}},
            bodies: [
                (name: "fluid", material: "fluid", shape: Box(min: (0, 0), max: (0.5, 1)), spacing: 0.05, formulation: Fluid),
                (name: "lower", material: "wall", spacing: 0.05, formulation: Wall(slip: {slip}, suction: true),
                 shape: Box(min: (0, -0.2), max: (0.5, 0))),
                (name: "upper", material: "wall", spacing: 0.05, formulation: Wall(slip: {slip}, suction: true),
                 shape: Box(min: (0, 1), max: (0.5, 1.2))),
            ],
            conditions: [{conditions}],
            time: (end: 2.0))"#
    ))
}

/// Root mean square of the difference to the closed form u(y, t).
fn error(sim: &Simulation, exact: impl Fn(f64, f64) -> f64) -> f64 {
    let (x, v) = (column::<Position>(sim, 0), column::<Velocity>(sim, 0));
    let time = sim.clock().time;
    let square: f64 = x.iter().zip(&v).map(|(x, v)| (v.0.x - exact(x.0.y, time)).powi(2)).sum();
    (square / x.len() as f64).sqrt()
}

/// Sums a series over n = 1, 2, ...
fn series(term: impl Fn(f64) -> f64) -> f64 {
    (1..400).map(|n| term(f64::from(n))).sum()
}

fn decay(n: f64, t: f64) -> f64 {
    (-n * n * PI * PI * NU * t).exp()
}

/// (-1)^n sin(n pi y)
fn wave(n: f64, y: f64) -> f64 {
    (n * PI).cos() * (n * PI * y).sin()
}

#[test]
fn a_wall_that_starts_to_move_drags_the_fluid_along() {
    let velocity = r#"Velocity(on: Select(body: "upper"), value: ("1", None))"#;
    let mut sim = channel("No", velocity);
    let exact = |y: f64, t: f64| y + series(|n| 2.0 / (n * PI) * wave(n, y) * decay(n, t));
    for time in [0.5, 1.0] {
        sim.run(|sim| sim.clock().time < time).expect("a run");
        let error = error(&sim, exact);
        assert!(error < 0.01, "off by {error} of the speed of the wall at {time} s");
    }
    // The wall itself has moved by twice the period, and still is where it is.
    assert!(column::<Position>(&sim, 2).iter().all(|x| x.0.x > 0.9));
}

#[test]
fn a_wall_that_gathers_speed_drags_the_fluid_along() {
    let mut sim = channel("No", r#"Velocity(on: Select(body: "upper"), value: ("t", None))"#);
    // Duhamel's integral of the sudden start.
    let exact = |y: f64, t: f64| {
        t * y + series(|n| 2.0 / (n.powi(3) * PI.powi(3) * NU) * wave(n, y) * (1.0 - decay(n, t)))
    };
    for time in [0.5, 1.0] {
        sim.run(|sim| sim.clock().time < time).expect("a run");
        let error = error(&sim, exact) / time;
        assert!(error < 0.01, "off by {error} of the speed of the wall at {time} s");
    }
}

#[test]
fn a_fluid_sticks_to_walls_or_slides_along_them() {
    let start = r#"InitialVelocity(on: Select(body: "fluid"), value: ("1", "0"))"#;
    let mut sticks = channel("No", start);
    let exact = |y: f64, t: f64| -> f64 {
        series(|n| 2.0 / (n * PI) * (1.0 - (n * PI).cos()) * (n * PI * y).sin() * decay(n, t))
    };
    for time in [0.5, 1.0] {
        sticks.run(|sim| sim.clock().time < time).expect("a run");
        let error = error(&sticks, exact);
        assert!(error < 0.01, "off by {error} of the speed at the start, at {time} s");
    }
    let mut slides = channel("Free", start);
    slides.run(|sim| sim.clock().time < 1.0).expect("a run");
    let error = error(&slides, |_, _| 1.0);
    // Particles of a wall are bumps, which the fluid hardly feels.
    assert!(error < 2e-5, "walls without friction took {error} of the speed");
}

/// A viscous fluid that slides along a wall because nobody has said what it does is warned of, and so is a
/// belt that it does not feel.
#[test]
fn walls_whose_slip_is_not_stated_are_warned_of() {
    let told = |wall: &str, viscosity: f64| {
        let sim = simulation(&format!(
            r#"(dimension: Two, materials: {{"fluid": Fluid(density: 1.0, sound_speed: 10.0, viscosity: {viscosity})}},
                bodies: [
                    (name: "fluid", material: "fluid", shape: Box(min: (0, 0), max: (0.5, 0.5)), spacing: 0.05, formulation: Fluid),
                    (name: "belt", material: "wall", spacing: 0.05, formulation: Wall({wall}), shape: Box(min: (0, -0.2), max: (0.5, 0))),
                ], time: (end: 0.1))"#
        ));
        let has = |part: &str| sim.warnings().iter().any(|text| text.contains(part));
        (
            has("along the wall `belt`, whose `slip` is not stated"),
            has("the `surface_velocity` of the wall `belt`"),
        )
    };
    assert_eq!(told("", 0.1), (true, false));
    assert_eq!(told("slip: Free", 0.1), (false, false));
    assert_eq!(told("slip: No, surface_velocity: (1, 0)", 0.1), (false, false));
    assert_eq!(told("surface_velocity: (1, 0)", 1e-6), (false, true));
}

/// The flux of a channel whose walls have half of the spacing of the fluid is 7 % too small at this size.
#[test]
fn walls_that_are_finer_than_a_fluid_that_sticks_to_them_are_warned_of() {
    let told = |spacing: f64, slip: &str| {
        let sim = simulation(&format!(
            r#"(dimension: Two, materials: {{"fluid": Fluid(density: 1.0, sound_speed: 10.0, viscosity: 0.1)}},
                bodies: [
                    (name: "fluid", material: "fluid", shape: Box(min: (0, 0), max: (0.5, 0.5)), spacing: 0.05, formulation: Fluid),
                    (name: "floor", material: "wall", spacing: {spacing}, formulation: Wall(slip: {slip}), shape: Box(min: (0, -0.2), max: (0.5, 0))),
                ], time: (end: 0.1))"#
        ));
        sim.warnings().iter().any(|text| text.contains("the wall `floor` is finer than the viscous fluid"))
    };
    assert!(told(0.025, "No"));
    assert!(!told(0.05, "No") && !told(0.025, "Free"));
}
