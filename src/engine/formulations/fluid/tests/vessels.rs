//! Fluids between walls that pull, without a free surface: what is done to them is what they feel.

use std::f64::consts::PI;

use super::{column, double, simulation};
use crate::simulation::Simulation;
use crate::world::{Position, Pressure};

/// Speed of sound, m/s, and density, kg/m3.
const SOUND: f64 = 10.0;
const DENSITY: f64 = 1000.0;

/// A liquid eight particles across, a piston on the left that goes to 0.02 in 1.5 s, and another wall on the right.
fn vessel(more: &str, bodies: &str, right: &str) -> Simulation {
    vessel_with("slip: Free, suction: true", more, bodies, right)
}

fn vessel_with(wall: &str, more: &str, bodies: &str, right: &str) -> Simulation {
    let mut sim = simulation(&format!(
        r#"(dimension: Two, {more} materials: {{"liquid": Fluid(density: {DENSITY}, sound_speed: {SOUND}, eos: Linear)}},
            bodies: [
                (name: "liquid", material: "liquid", spacing: 0.125, formulation: Fluid, shape: Box(min: (0, 0), max: (1, 1))),
                (name: "piston", material: "wall", spacing: 0.125, formulation: Wall({wall}), shape: Box(min: (-0.5, 0), max: (0, 1))),
                (name: "end", material: "wall", spacing: 0.125, formulation: Wall({wall}), shape: Box({right})),
                {bodies}
            ],
            conditions: [Velocity(on: Select(body: "piston"), value: ("0.02/1.5*(1 - cos(2*pi*t/1.5))", None))],
            time: (end: 1.5))"#
    ));
    sim.run(|_| true).expect("a run");
    sim
}

/// Mean pressure over that of the equation of state at 0.98 of the volume.
fn pressure(sim: &Simulation) -> f64 {
    let p = column::<Pressure>(sim, 0);
    let mean = p.iter().map(|p| p.0).sum::<f64>() / p.len() as f64;
    mean / (SOUND * SOUND * DENSITY * (1.0 / 0.98 - 1.0))
}

/// What walls have taken over what the piston has done.
fn taken_by_walls(sim: &Simulation) -> f64 {
    sim.ledger().total_named("wall_pressure") / sim.ledger().total_named("constraints")
}

/// The fluid beside a piston saw half of its motion: .88 of the pressure, and walls took a tenth of the work.
#[test]
fn a_liquid_that_a_piston_presses_has_the_pressure_of_its_equation_of_state() {
    let domain = "domain: (min: (-2, 0), max: (3, 1), periodic: [Y]),";
    let sim = vessel(domain, "", "min: (1, 0), max: (1.5, 1)");
    let (pressure, walls) = (pressure(&sim), taken_by_walls(&sim));
    assert!((pressure - 1.0).abs() < 0.01, "{pressure}");
    assert!(walls.abs() < 1e-3, "{walls}");
}

/// Between walls along which it slides it had .78, and these took a seventh of the work. What is left of the error is that of the force on the piston: at its edges the liquid leans on the other walls.
#[test]
fn a_liquid_between_walls_loses_nothing_to_them() {
    let sides = r#"
        (name: "top", material: "wall", spacing: 0.125, formulation: Wall(slip: Free, suction: true), shape: Box(min: (-0.5, 1), max: (1, 1.5))),
        (name: "bottom", material: "wall", spacing: 0.125, formulation: Wall(slip: Free, suction: true), shape: Box(min: (-0.5, -0.5), max: (1, 0))),"#;
    let sim = vessel("", sides, "min: (1, -0.5), max: (1.5, 1.5)");
    let (pressure, walls) = (pressure(&sim), taken_by_walls(&sim));
    assert!((0.92..1.01).contains(&pressure), "{pressure}");
    assert!(walls.abs() < 1e-3, "{walls}");
}

/// The amplitude of a wave in a closed tube, four times as long as wide, that stands for three quarters of its period: it is zero. Sound was 10 % too slow, so that it was -0.47.
#[test]
fn sound_between_walls_without_friction_has_its_speed() {
    let tube = r#"(dimension: Two, materials: {"liquid": Fluid(density: 1000.0, sound_speed: 10.0, eos: Linear)},
        bodies: [
            (name: "liquid", material: "liquid", spacing: 0.125, formulation: Fluid(pressure: "100*cos(pi*x/4)"), shape: Box(min: (0, 0), max: (4, 1))),
            (name: "tube", material: "wall", spacing: 0.125, formulation: Wall(slip: Free, suction: true),
             shape: Difference(Box(min: (-0.5, -0.5), max: (4.5, 1.5)), Box(min: (0, 0), max: (4, 1)))),
        ], time: (end: 0.6))"#;
    for mut sim in [simulation(tube), double(tube)] {
        sim.run(|_| true).expect("a run");
        let (x, p) = (column::<Position>(&sim, 0), column::<Pressure>(&sim, 0));
        let wave = |x: &Position| (PI * x.0.x / 4.0).cos();
        let (along, all) = x
            .iter()
            .zip(&p)
            .fold((0.0, 0.0), |(along, all), (x, p)| (along + p.0 * wave(x), all + 100.0 * wave(x).powi(2)));
        assert!((along / all).abs() < 0.05, "{}", along / all);
    }
}

/// Walls that do not pull take part of the work, and the run says so.
#[test]
fn a_closed_vessel_whose_walls_do_not_pull_is_warned_of() {
    let domain = "domain: (min: (-2, 0), max: (3, 1), periodic: [Y]),";
    let told = |wall: &str| {
        let sim = vessel_with(wall, domain, "", "min: (1, 0), max: (1.5, 1)");
        sim.warnings().iter().any(|text| text.contains("give the walls `Wall(suction: true)`"))
    };
    assert!(told("slip: Free"));
    assert!(!told("slip: Free, suction: true"));
}

/// At a free surface walls that pull compress what slides along them, and the run says so.
#[test]
fn walls_that_pull_at_a_free_surface_are_warned_of() {
    let told = |suction: bool| {
        let tank = format!(
            r#"(dimension: Two, gravity: (0, -9.81), materials: {{"water": Fluid(density: 1000.0, sound_speed: 40.0)}},
            bodies: [
                (name: "water", material: "water", spacing: 0.05, formulation: Fluid, shape: Box(min: (0, 0), max: (1, 0.5))),
                (name: "tank", material: "wall", spacing: 0.05, formulation: Wall(slip: Free, suction: {suction}),
                 shape: Difference(Box(min: (-0.2, -0.2), max: (1.2, 0.8)), Box(min: (0, 0), max: (1, 1)))),
            ], time: (end: 0.02))"#
        );
        let mut sim = simulation(&tank);
        sim.run(|_| true).expect("a run");
        sim.warnings().iter().any(|text| text.contains("leave `suction` out"))
    };
    assert!(told(true));
    assert!(!told(false));
}
