//! Walls in scenes without a fluid, and half-spaces as tools.

use glam::DVec3;

use super::{centre, simulation};
use crate::assembly::build;
use crate::plugin::Registry;
use crate::scene::{Source, parse};
use crate::simulation::Simulation;
use crate::world::{BodyId, Force, Position, Velocity};

/// A block that is thrown onto something below, which does not move.
fn thrown(tool: &str, conditions: &str) -> String {
    format!(
        r#"(dimension: Two, gravity: (0, -9.81),
            materials: {{"soft": NeoHookean(density: 1000, young: 1e6, poisson: 0.3)}},
            bodies: [
                (name: "block", material: "soft", shape: Box(min: (0, 0.002), max: (0.06, 0.062)), spacing: 0.01,
                 formulation: TotalLagrangian, velocity: (0.0, -2.0)),
                (name: "tool", material: "soft", {tool}),
            ],
            conditions: [{conditions}],
            contacts: [Contact(between: ("block", "tool"), law: Penalty())],
            time: (end: 0.02))"#
    )
}

#[test]
fn a_wall_without_a_fluid_stands() {
    let tool = r#"shape: Box(min: (-0.1, -0.04), max: (0.16, 0)), spacing: 0.01, formulation: Wall"#;
    let mut sim = simulation(&thrown(tool, ""));
    let of_wall = |sim: &Simulation| {
        let (view, rows) = sim.world().body_view(BodyId(1));
        let (place, velocity) = (view.read::<Position>().unwrap(), view.read::<Velocity>().unwrap());
        (place[rows.clone()].to_vec(), velocity[rows].to_vec())
    };
    let (before, _) = of_wall(&sim);
    sim.run(|_| true).unwrap();
    let (after, velocity) = of_wall(&sim);
    assert!(after == before && velocity.iter().all(|v| v.0 == DVec3::ZERO), "{after:?} {velocity:?}");
    let (block, bounced) = centre(&sim, 0);
    assert!(block.y > 0.02 && bounced.y > 1.0, "{block} {bounced}");
}

#[test]
fn a_half_space_is_a_tool_like_a_large_box() {
    let fix = r#"Fix(on: Select(body: "tool"))"#;
    let run = |tool: &str| {
        let mut sim = simulation(&thrown(tool, fix));
        sim.run(|_| true).unwrap();
        centre(&sim, 0)
    };
    let plane = run("shape: HalfSpace(point: (0, 0), normal: (0, 1)), spacing: 0.01, formulation: Rigid()");
    let block = run("shape: Box(min: (-0.05, -0.02), max: (0.11, 0)), spacing: 0.01, formulation: Rigid()");
    assert!(plane.0.distance(block.0) < 1e-12 && plane.1.distance(block.1) < 1e-10, "{plane:?} {block:?}");
    assert!(plane.1.y > 1.0, "{plane:?}");
}

#[test]
fn a_half_space_that_nothing_holds_is_an_error() {
    let tool = "shape: HalfSpace(point: (0, 0), normal: (0, 1)), spacing: 0.01, formulation: Rigid()";
    let (scene, source) = parse(Source::new("tool.ron", thrown(tool, ""))).unwrap();
    let Err(error) = build(&scene, &source, &Registry::standard()) else { panic!("it has no mass") };
    assert!(error.to_string().contains("rigid body `tool` is unbounded"), "{error}");
}

/// A block of 19.62 N/m rests on a wall. Neither gravity nor a force per mass acts on the wall itself, which
/// has no mass; a wall that moves takes up no work of them.
#[test]
fn the_force_on_a_wall_is_that_of_what_it_carries() {
    let mut sim = simulation(
        r#"(dimension: Two, gravity: (0, -4.81),
            materials: {"stone": NeoHookean(density: 2000, young: 1e7, poisson: 0.3)},
            bodies: [
                (name: "block", material: "stone", shape: Box(min: (0, 0), max: (0.2, 0.005)), spacing: 0.0025, formulation: Rigid()),
                (name: "floor", material: "stone", shape: Box(min: (-0.1, -0.1), max: (0.3, 0)), spacing: 0.02, formulation: Wall, velocity: (0.2, 0)),
            ],
            conditions: [BodyForce(on: Select(), value: (0, "-5 + 0*t"))],
            contacts: [Contact(between: ("block", "floor"), restitution: 0.1)],
            time: (end: 0.1))"#,
    );
    sim.run(|_| true).unwrap();
    let (view, rows) = sim.world().body_view(BodyId(1));
    let sum: DVec3 = view.read::<Force>().unwrap()[rows].iter().map(|force| force.0).sum();
    assert!((sum.y + 19.62).abs() < 0.02 && sum.x.abs() < 0.02, "{sum}");
    let accounts = sim.ledger().accounts();
    let work = accounts.iter().find(|account| account.name == "body_force").map_or(0.0, |a| a.total());
    assert!(work.abs() < 1e-3, "{work}");
}
