//! Fluids between walls with suction, without a free surface: the work on them is their change of energy.

use std::f64::consts::PI;

use glam::DVec3;

use super::{column, double, simulation};
use crate::formulations::fluid::FlowCloud;
use crate::simulation::Simulation;
use crate::world::{BodyId, Density, Mass, Position, Pressure};

/// Speed of sound, m/s, and density, kg/m3.
const SOUND: f64 = 10.0;
const DENSITY: f64 = 1000.0;

/// A liquid eight particles across, a piston on the left that goes to 0.02 in 1.5 s, and another wall on
/// the right.
fn vessel(more: &str, bodies: &str, right: &str) -> Simulation {
    vessel_with("slip: Free, suction: true", more, bodies, right)
}

fn vessel_with(wall: &str, more: &str, bodies: &str, right: &str) -> Simulation {
    let mut sim = prepared(wall, more, bodies, right);
    sim.run(|_| true).expect("a run");
    sim
}

/// The vessel before its first step.
fn prepared(wall: &str, more: &str, bodies: &str, right: &str) -> Simulation {
    simulation(&format!(
        r#"(dimension: Two, {more} materials: {{"liquid": Fluid(density: {DENSITY}, sound_speed: {SOUND}, eos: Linear)}},
            bodies: [
                (name: "liquid", material: "liquid", spacing: 0.125, formulation: Fluid, shape: Box(min: (0, 0), max: (1, 1))),
                (name: "piston", material: "wall", spacing: 0.125, formulation: Wall({wall}), shape: Box(min: (-0.5, 0), max: (0, 1))),
                (name: "end", material: "wall", spacing: 0.125, formulation: Wall({wall}), shape: Box({right})),
                {bodies}
            ],
            conditions: [Velocity(on: Select(body: "piston"), value: ("0.02/1.5*(1 - cos(2*pi*t/1.5))", None))],
            time: (end: 1.5))"#
    ))
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

/// The fluid beside a piston saw half of its motion: .88 of the pressure, and walls took a tenth of the
/// work.
#[test]
fn a_liquid_that_a_piston_presses_has_the_pressure_of_its_equation_of_state() {
    let domain = "domain: (min: (-2, 0), max: (3, 1), periodic: [Y]),";
    let sim = vessel(domain, "", "min: (1, 0), max: (1.5, 1)");
    let (pressure, walls) = (pressure(&sim), taken_by_walls(&sim));
    assert!((pressure - 1.0).abs() < 0.01, "{pressure}");
    assert!(walls.abs() < 1e-3, "{walls}");
}

/// Between walls along which it slides it had .78, and these took a seventh of the work; as long as the
/// particles of these stood still behind the edges of the piston, where the liquid leans on them, it had
/// .93.
#[test]
fn a_liquid_between_walls_loses_nothing_to_them() {
    let sides = r#"
        (name: "top", material: "wall", spacing: 0.125, formulation: Wall(slip: Free, suction: true), shape: Box(min: (-0.5, 1), max: (1, 1.5))),
        (name: "bottom", material: "wall", spacing: 0.125, formulation: Wall(slip: Free, suction: true), shape: Box(min: (-0.5, -0.5), max: (1, 0))),"#;
    let sim = vessel("", sides, "min: (1, -0.5), max: (1.5, 1.5)");
    let (pressure, walls) = (pressure(&sim), taken_by_walls(&sim));
    assert!((pressure - 1.0).abs() < 0.01, "{pressure}");
    assert!(walls.abs() < 1e-3, "{walls}");
}

/// In a cube, whose piston has edges on four sides, it had .87; with the default support the sum of w x^2
/// over a cubic lattice is 2 % too small.
#[test]
fn a_piston_in_a_cube_finds_the_pressure_too() {
    let mut sim = simulation(
        r#"(dimension: Three, materials: {"liquid": Fluid(density: 1000.0, sound_speed: 10.0, eos: Linear)},
            bodies: [
                (name: "liquid", material: "liquid", spacing: 0.125, formulation: Fluid(support: 3.0), shape: Box(min: (0, 0, 0), max: (1, 1, 1))),
                (name: "piston", material: "wall", spacing: 0.125, formulation: Wall(slip: Free, suction: true), shape: Box(min: (-0.375, 0, 0), max: (0, 1, 1))),
                (name: "vessel", material: "wall", spacing: 0.125, formulation: Wall(slip: Free, suction: true),
                 shape: Difference(Box(min: (-0.375, -0.375, -0.375), max: (1.375, 1.375, 1.375)), Box(min: (-1, 0, 0), max: (1, 1, 1)))),
            ],
            conditions: [Velocity(on: Select(body: "piston"), value: ("0.02/0.8*(1 - cos(2*pi*t/0.8))", None, None))],
            time: (end: 0.8))"#,
    );
    sim.run(|_| true).expect("a run");
    let (pressure, walls) = (pressure(&sim), taken_by_walls(&sim));
    assert!((pressure - 1.0).abs() < 0.02, "{pressure}");
    assert!(walls.abs() < 1e-3, "{walls}");
}

/// A piston whose face is inclined, between the walls along which it slides: at its ends it meets them at
/// 60 and 120 degrees.
#[test]
fn an_inclined_piston_finds_the_pressure_too() {
    let slant = |y: f64| y / 3f64.sqrt();
    let part = |name: &str, formulation: &str, [x0, x1, y0, y1]: [f64; 4]| {
        format!(
            r#"(name: "{name}", material: "liquid", spacing: 0.1, lattice: BodyFitted(iterations: 10), formulation: {formulation},
                shape: Polygon(points: [({}, {y0}), ({}, {y0}), ({}, {y1}), ({}, {y1})])),"#,
            x0 + slant(y0),
            x1 + slant(y0),
            x1 + slant(y1),
            x0 + slant(y1),
        )
    };
    let wall = |name: &str, bounds: [f64; 4]| part(name, "Wall(slip: Free, suction: true)", bounds);
    let mut sim = simulation(&format!(
        r#"(dimension: Two, materials: {{"liquid": Fluid(density: 1000.0, sound_speed: 10.0, eos: Linear)}},
            bodies: [{} {} {} {} {}],
            conditions: [Velocity(on: Select(body: "piston"), value: ("0.02/1.5*(1 - cos(2*pi*t/1.5))", None))],
            time: (end: 1.5))"#,
        part("liquid", "Fluid", [0.0, 1.0, 0.0, 1.0]),
        wall("piston", [-0.45, 0.0, 0.0, 1.0]),
        wall("end", [1.0, 1.45, -0.4, 1.4]),
        wall("top", [-0.45, 1.0, 1.0, 1.4]),
        wall("bottom", [-0.45, 1.0, -0.4, 0.0]),
    ));
    sim.run(|_| true).expect("a run");
    let (pressure, walls) = (pressure(&sim), taken_by_walls(&sim));
    assert!((pressure - 1.0).abs() < 0.015, "{pressure}");
    assert!(walls.abs() < 1e-3, "{walls}");
}

/// The work of a piston is that of the pressure on the volume that the fluid loses, and this is what the
/// piston sweeps.
#[test]
fn the_volume_that_a_fluid_loses_is_what_its_walls_sweep() {
    let sides = r#"
        (name: "top", material: "wall", spacing: 0.125, formulation: Wall(slip: Free, suction: true), shape: Box(min: (-0.5, 1), max: (1, 1.5))),
        (name: "bottom", material: "wall", spacing: 0.125, formulation: Wall(slip: Free, suction: true), shape: Box(min: (-0.5, -0.5), max: (1, 0))),"#;
    let wall = "slip: Free, suction: true";
    let mut sim = prepared(wall, "", sides, "min: (1, -0.5), max: (1.5, 1.5)");
    let state = |sim: &Simulation| {
        let (m, rho) = (column::<Mass>(sim, 0), column::<Density>(sim, 0));
        let p = column::<Pressure>(sim, 0);
        let volume: f64 = m.iter().zip(&rho).map(|(m, rho)| m.0 / rho.0).sum();
        (volume, p.iter().map(|p| p.0).sum::<f64>() / p.len() as f64)
    };
    let start = state(&sim);
    let (mut before, mut work) = (start, 0.0);
    sim.run(|sim| {
        let now = state(sim);
        work += 0.5 * (before.1 + now.1) * (before.0 - now.0);
        before = now;
        true
    })
    .expect("a run");
    let of_walls = sim.ledger().total_named("constraints");
    assert!((work / of_walls - 1.0).abs() < 0.01, "{work} {of_walls}");
    let swept = start.0 - before.0;
    assert!((swept / 0.02 - 1.0).abs() < 0.01, "{swept}");
}

/// Gates beside a floor: the fluid leans on the particles behind their lower edge, and what is done to
/// these is the force on the gate. Bodies that are held had 0.95 of it, two layers thick.
#[test]
fn a_gate_on_a_floor_bears_the_pressure_down_to_its_edge() {
    let wall = r#"material: "wall", formulation: Wall(slip: Free)"#;
    let rigid = r#"material: "steel", formulation: Rigid()"#;
    for (gate, layers, hold) in [
        (wall, 4.0, ""),
        (rigid, 2.0, r#"Fix(on: Select(body: "gate"))"#),
        (rigid, 4.0, r#"Fix(on: Select(body: "gate"))"#),
        (rigid, 2.0, r#"Velocity(on: Select(body: "gate"), value: (0.0, 0.0))"#),
    ] {
        let back = 0.8 + 0.025 * layers;
        let mut sim = simulation(&format!(
            r#"(dimension: Two, gravity: (0, -10), materials: {{"water": Fluid(density: 1000.0, sound_speed: 40.0), "steel": Steel()}},
                bodies: [
                    (name: "water", material: "water", spacing: 0.025, formulation: Fluid, shape: Box(min: (0, 0), max: (0.8, 0.6))),
                    (name: "gate", {gate}, spacing: 0.025, shape: Box(min: (0.8, 0), max: ({back}, 0.8))),
                    (name: "tank", {wall}, spacing: 0.025, shape: Difference(Box(min: (-0.2, -0.2), max: (1, 0.8)), Box(min: (0, 0), max: (2, 2)))),
                ],
                conditions: [{hold}],
                probes: [(name: "load", on: Select(body: "gate"), quantity: FluidForce)],
                time: (end: 1e-3))"#
        ));
        sim.run(|_| true).expect("a run");
        let load = sim.measure("load").expect("a probe");
        let force = load.iter().find(|(name, _)| name.starts_with('x')).expect("a force across").1;
        let exact = 0.5 * 1000.0 * 10.0 * 0.6 * 0.6;
        assert!((force / exact - 1.0).abs() < 0.005, "{gate}, {layers}: {}", force / exact);
    }
}

/// The amplitude of a wave in a closed tube, four times as long as wide, that stands for three quarters of
/// its period: it is zero. Sound was 10 % too slow, so that it was -0.47.
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

/// Walls without suction take part of the work, and the run says so.
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

/// At a free surface walls with suction compress what slides along them, and the run says so.
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

/// Notches of a worn floor that the water has not filled are not a free surface: nobody should be told to
/// leave out the suction of walls that bound a full channel.
#[test]
fn gaps_beside_a_rough_floor_are_no_free_surface() {
    let notches: Vec<String> = (0..10)
        .map(|k| 0.2 * f64::from(k))
        .map(|x| format!("Box(min: ({x:.2}, -0.15), max: ({:.2}, 0.01))", x + 0.1))
        .collect();
    let mut sim = simulation(&format!(
        r#"(dimension: Two, domain: (min: (0, -1), max: (2, 2), periodic: [X]),
        materials: {{"water": Fluid(density: 1000.0, sound_speed: 40.0)}},
        bodies: [
            (name: "water", material: "water", spacing: 0.05, formulation: Fluid(pressure: 1.0e4), shape: Box(min: (0, 0), max: (2, 1))),
            (name: "roof", material: "wall", spacing: 0.05, formulation: Wall(slip: Free, suction: true), shape: Box(min: (0, 1), max: (2, 1.2))),
            (name: "floor", material: "wall", spacing: 0.05, formulation: Wall(slip: Free, suction: true),
             shape: Difference(Box(min: (0, -0.4), max: (2, 0)), Union([{}]))),
        ], time: (end: 1.0e-3))"#,
        notches.join(", ")
    ));
    sim.run(|_| true).expect("a run");
    let told: Vec<&String> =
        sim.warnings().iter().filter(|text| text.contains("leave `suction` out")).collect();
    assert!(told.is_empty(), "{told:?}");
}

/// A chamber full of water beside an open tank: the roof raised its pressure by 10 and 7 % of that at the
/// floor, 10 and 20 deep, without a word. With suction in its own walls it has nothing to be told, and the
/// open water beside it is not that of a wall that pulls.
#[test]
fn a_roof_that_does_not_pull_is_warned_of_and_one_that_pulls_is_not() {
    let told = |chamber: &str, roof: &str| {
        let mut sim = simulation(&format!(
            r#"(dimension: Two, gravity: (0, -9.81), materials: {{"water": Fluid(density: 1000.0, sound_speed: 20.0)}},
            bodies: [
                (name: "in", material: "water", spacing: 0.02, formulation: Fluid, shape: Box(min: (0, 0), max: (0.2, 0.2))),
                (name: "out", material: "water", spacing: 0.02, formulation: Fluid, shape: Box(min: (0.32, 0), max: (0.6, 0.2))),
                (name: "chamber", material: "wall", spacing: 0.02, formulation: Wall(slip: Free{chamber}),
                 shape: Difference(Box(min: (-0.06, -0.06), max: (0.26, 0.26)), Box(min: (0, 0), max: (0.2, {roof})))),
                (name: "tank", material: "wall", spacing: 0.02, formulation: Wall(slip: Free),
                 shape: Difference(Box(min: (0.26, -0.06), max: (0.66, 0.3)), Box(min: (0.32, 0), max: (0.6, 1)))),
            ], time: (end: 0.02))"#
        ));
        sim.run(|_| true).expect("a run");
        let has = |part: &str| sim.warnings().iter().any(|text| text.contains(part));
        [has("`in` fills a space up to its roof"), has("leave `suction` out")]
    };
    assert_eq!(told("", "0.2"), [true, false]);
    assert_eq!(told(", suction: true", "0.2"), [false, false]);
    assert_eq!(told("", "1"), [false, false]);
    assert_eq!(told(", suction: true", "1"), [false, true]);
}

/// A light disc rises in a closed tank: walls that do not pull give and take several hundredths of what
/// gravity does, and nobody was told.
#[test]
fn a_body_that_rises_between_walls_that_do_not_pull_is_warned_of() {
    let told = |suction: bool| {
        let tank = format!(
            r#"(dimension: Two, gravity: (0, -9.81), materials: {{"water": Fluid(density: 1000.0, sound_speed: 20.0),
                "light": NeoHookean(density: 500.0, young: 1.0e6, poisson: 0.3)}},
            bodies: [
                (name: "water", material: "water", spacing: 0.025, formulation: Fluid,
                 shape: Difference(Box(min: (-0.3, 0), max: (0.3, 1.5)), Sphere(center: (0, 0.3), radius: 0.1))),
                (name: "tank", material: "wall", spacing: 0.025, formulation: Wall(slip: Free, suction: {suction}),
                 shape: Difference(Box(min: (-0.4, -0.1), max: (0.4, 1.6)), Box(min: (-0.3, 0), max: (0.3, 1.5)))),
                (name: "disc", material: "light", spacing: 0.025, formulation: Rigid(), shape: Sphere(center: (0, 0.3), radius: 0.1)),
            ], time: (end: 0.6))"#
        );
        let mut sim = simulation(&tank);
        sim.run(|_| true).expect("a run");
        sim.warnings().iter().any(|text| text.contains("of the work that moves `water`"))
    };
    assert!(told(false));
    assert!(!told(true));
}

/// Forces of still water on parts of one wall: pairs act below its surface, and the tension along it that
/// this makes was measured with the forces where a part ends. A single row bears all of the pressure on it,
/// and no row behind it any (1.39 of it and less than nothing, when rows had the forces summed for them).
#[test]
fn a_part_of_a_wall_bears_the_pressure_on_it_alone() {
    let mut sim = simulation(
        r#"(dimension: Two, gravity: (0, -10), materials: {"water": Fluid(density: 1000.0, sound_speed: 40.0)},
            bodies: [
                (name: "water", material: "water", spacing: 0.05, formulation: Fluid, shape: Box(min: (0, 0), max: (1.2, 0.6))),
                (name: "tank", material: "wall", spacing: 0.05, formulation: Wall(slip: Free),
                 shape: Difference(Box(min: (-0.2, -0.2), max: (1.4, 0.8)), Box(min: (0, 0), max: (1.2, 2)))),
            ],
            probes: [(name: "half", on: Select(body: "tank", within: Box(min: (0.6, -1), max: (2, 2))), quantity: FluidForce)],
            time: (end: 1e-3))"#,
    );
    sim.run(|_| true).expect("a run");
    let cloud = sim.resources().get::<FlowCloud>();
    let places = column::<Position>(&sim, 1);
    let on = |low: [f64; 2], high: [f64; 2]| {
        let is_there = |x: &Position| x.0.cmpge(DVec3::new(low[0], low[1], -1.0)).all();
        let is_before = |x: &Position| x.0.cmple(DVec3::new(high[0], high[1], 1.0)).all();
        let is_part: Vec<bool> = places.iter().map(|x| is_there(x) && is_before(x)).collect();
        cloud.reaction_on_part(BodyId(1), &is_part, &places, DVec3::X * 1.2).expect("a wet tank")
    };
    // rho g H^2 / 2 against the right side, of which a quarter is on its upper half.
    let exact = 0.5 * 1000.0 * 10.0 * 0.6 * 0.6;
    let (half, above) = (on([0.6, -1.0], [2.0, 2.0]).force, on([1.2, 0.3], [2.0, 2.0]).force);
    assert!((half.x / exact - 1.0).abs() < 0.01, "{}", half.x / exact);
    assert!((above.x / exact - 0.25).abs() < 0.01, "{}", above.x / exact);
    assert!(above.y.abs() < 0.005 * exact, "{}", above.y / exact);
    let (row, behind) = (on([1.2, -0.2], [1.25, 2.0]), on([1.25, -0.2], [2.0, 2.0]));
    // In the corner the floor has a share, a seventh of a spacing.
    assert!((row.force.x / exact - 1.0).abs() < 0.03, "{}", row.force.x / exact);
    assert!(behind.force.length() < 0.01 * exact, "{}", behind.force / exact);
    // Of the hydrostatic pressure, at a third of the depth.
    assert!((row.torque.z / (-0.2 * exact) - 1.0).abs() < 0.03, "{}", row.torque.z / exact);
    let floor = on([0.2, -0.05], [1.0, 0.0]).force;
    assert!((floor.y / (-1000.0 * 10.0 * 0.6 * 0.8) - 1.0).abs() < 0.01, "{}", floor.y);
}

/// A plate that separates water of two depths: the rows of each of its halves bear the pressure of the water
/// before them, whether they are thicker than the support or see the water on the other side too.
#[test]
fn each_side_of_a_plate_bears_the_pressure_before_it() {
    for (layers, formulation) in
        [(2, "Rigid()"), (4, "Rigid()"), (2, "TotalLagrangian()"), (4, "TotalLagrangian()"), (4, "Wall()")]
    {
        let end = 0.05 * f64::from(layers) + 0.8;
        let text = format!(
            r#"(dimension: Two, gravity: (0, -10),
                materials: {{"water": Fluid(density: 1000.0, sound_speed: 40.0), "rubber": NeoHookean(density: 1000, young: 1e7, poisson: 0.3)}},
                bodies: [
                    (name: "deep", material: "water", spacing: 0.05, formulation: Fluid, shape: Box(min: (0, 0), max: (0.8, 0.8))),
                    (name: "low", material: "water", spacing: 0.05, formulation: Fluid, shape: Box(min: ({end}, 0), max: (1.8, 0.5))),
                    (name: "tank", material: "wall", spacing: 0.05, formulation: Wall(slip: Free),
                     shape: Difference(Box(min: (-0.2, -0.2), max: (2.0, 1.0)), Union([Box(min: (0, 0), max: (1.8, 2)), Box(min: (0.8, -0.2), max: ({end}, 0.2))]))),
                    (name: "plate", material: "rubber", spacing: 0.05, formulation: {formulation}, shape: Box(min: (0.8, -0.2), max: ({end}, 1.0))),
                ],
                conditions: [Fix(on: Select(body: "plate"))],
                probes: [(name: "side", on: Select(body: "plate", face: MinX), quantity: FluidForce)],
                time: (end: 1e-3))"#
        );
        let mut sim = simulation(&text);
        sim.run(|_| true).expect("a run");
        let cloud = sim.resources().get::<FlowCloud>();
        let places = column::<Position>(&sim, 3);
        let middle = 0.4 + 0.5 * end;
        for (is_left, depth) in [(true, 0.8), (false, 0.5)] {
            let is_part: Vec<bool> =
                places.iter().map(|x| (x.0.x < middle) == is_left && x.0.y > 0.2).collect();
            let part =
                cloud.reaction_on_part(BodyId(3), &is_part, &places, DVec3::ZERO).expect("a wet plate");
            let exact = 0.5 * 1000.0 * 10.0 * f64::powi(depth - 0.2, 2) * if is_left { 1.0 } else { -1.0 };
            let ratio = part.force.x / exact;
            assert!((ratio - 1.0).abs() < 0.01, "{layers} {formulation}: {ratio}");
        }
    }
}
