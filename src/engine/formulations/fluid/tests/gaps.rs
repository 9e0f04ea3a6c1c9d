//! Bodies so near to walls that no particle of the fluid fits between: they feel the pressure that the fluid
//! has there.

use glam::DVec3;

use super::{column, double, simulation};
use crate::formulations::fluid::FlowCloud;
use crate::simulation::Simulation;
use crate::world::{BodyId, Position, Pressure};

const GRAVITY: f64 = 9.81;

/// A body in a tank with still water 0.2 m deep; the shape of the water leaves out that of the body.
fn tank(shape: &str, more: &str) -> String {
    format!(
        r#"(dimension: Two, gravity: (0.0, -{GRAVITY}),
            materials: {{"water": Fluid(density: 1000.0, sound_speed: 20.0), "stone": NeoHookean(density: 2500.0, young: 1.0e6, poisson: 0.3)}},
            bodies: [
                (name: "water", material: "water", spacing: 0.01, formulation: Fluid, shape: Difference(Box(min: (0, 0), max: (0.3, 0.2)), {shape})),
                (name: "tank", material: "wall", spacing: 0.01, formulation: Wall(),
                 shape: Difference(Box(min: (-0.03, -0.03), max: (0.33, 0.25)), Box(min: (0, 0), max: (0.3, 1)))),
                (name: "stone", material: "stone", spacing: 0.01, formulation: Rigid(), shape: {shape}),
            ],
            {more}, time: (end: 0.05))"#
    )
}

/// Force of the water on a body at the end of a run, N.
fn force(sim: &mut Simulation, body: usize) -> DVec3 {
    sim.run(|_| true).expect("a run");
    let cloud = sim.resources().get::<FlowCloud>();
    cloud.forces_on(BodyId(body)).expect("a flow").iter().map(|(force, _)| *force).sum()
}

/// Archimedes: the floor gives what is missing on the side where the body lies.
#[test]
fn a_body_on_the_floor_or_at_a_wall_has_its_buoyancy() {
    let held = r#"conditions: [Fix(on: Select(body: "stone"))]"#;
    for (shape, area) in [
        ("Box(min: (0.1, 0.0), max: (0.2, 0.06))", 0.006),
        ("Box(min: (0.0, 0.06), max: (0.06, 0.12))", 0.0036),
        ("Box(min: (0.0, 0.0), max: (0.1, 0.1))", 0.01),
        ("Sphere(center: (0.15, 0.05), radius: 0.05)", 0.007854),
    ] {
        let on_body = force(&mut simulation(&tank(shape, held)), 2);
        let lift = 1000.0 * GRAVITY * area;
        // What presses one side alone is ten times as much.
        assert!((on_body - lift * DVec3::Y).length() < 0.2 * lift, "{shape}: {on_body} and {lift}");
    }
    let block = "Box(min: (0.1, 0.0), max: (0.2, 0.06))";
    let lift = force(&mut simulation(&tank(block, held)), 2).y;
    assert!((lift / (1000.0 * GRAVITY * 0.006) - 1.0).abs() < 0.01, "{lift}");
}

#[test]
fn the_forces_in_a_gap_have_no_sum_and_no_couple() {
    let (ball, block) =
        ("Sphere(center: (0.15, 0.05), radius: 0.05)", "Box(min: (0.2, 0.03), max: (0.24, 0.07))");
    let pebble = format!(
        r#"(name: "pebble", material: "stone", spacing: 0.01, formulation: Rigid(), shape: {block}), (name: "tank""#
    );
    let text = tank(ball, "conditions: []")
        .replacen(ball, &format!("Union([{ball}, {block}])"), 1)
        .replacen(r#"(name: "tank""#, &pebble, 1)
        .replace("end: 0.05", "end: 0.001");
    let mut sim = double(&text);
    sim.run(|_| true).expect("a run");
    let cloud = sim.resources().get::<FlowCloud>();
    let forces = &cloud.gap_forces;
    let places = cloud.records[cloud.fluid..].iter().map(|record| record.position());
    let scale: f64 = forces.iter().map(|force| force.length()).sum();
    assert!(scale > 100.0, "{scale}");
    let sum: DVec3 = forces.iter().sum();
    let couple: DVec3 = places.zip(forces).map(|(x, force)| x.cross(*force)).sum();
    assert!(sum.length() < 1e-12 * scale && couple.length() < 1e-12 * scale, "{sum}, {couple}, {scale}");
}

/// Its weight over the width between the walls.
#[test]
fn a_piston_bears_on_the_width_between_the_walls() {
    let mut sim = simulation(
        r#"(dimension: Two, gravity: (0.0, -9.81),
            materials: {"water": Fluid(density: 1000.0, sound_speed: 40.0), "steel": NeoHookean(density: 8000.0, young: 1.0e7, poisson: 0.3)},
            bodies: [
                (name: "water", material: "water", spacing: 0.02, formulation: Fluid(pressure: "7848 + 9810*(0.2 - y)"), shape: Box(min: (0, 0), max: (0.2, 0.2))),
                (name: "piston", material: "steel", spacing: 0.02, formulation: Rigid(), shape: Box(min: (0, 0.2), max: (0.2, 0.3))),
                (name: "tank", material: "wall", spacing: 0.02, formulation: Wall(),
                 shape: Difference(Box(min: (-0.08, -0.08), max: (0.28, 0.5)), Box(min: (0, 0), max: (0.2, 1)))),
            ],
            conditions: [Fix(on: Select(body: "piston"))], time: (end: 0.02))"#,
    );
    let lift = force(&mut sim, 1).y;
    let pressure = column::<Pressure>(&sim, 0);
    let places = column::<Position>(&sim, 0);
    // The pressure at the piston, from that at each height.
    let at_piston = |(p, x): (&Pressure, &Position)| p.0 - 1000.0 * GRAVITY * (0.2 - x.0.y);
    let mean = pressure.iter().zip(&places).map(at_piston).sum::<f64>() / places.len() as f64;
    assert!((lift / (0.2 * mean) - 1.0).abs() < 0.02, "{lift} N, {mean} Pa");
}

#[test]
fn a_body_that_has_no_pressure_in_a_gap_is_told_of() {
    let told = |shape: &str, formulation: &str| {
        let more =
            r#"conditions: [Fix(on: Select(body: "stone", within: Box(min: (0, 0), max: (1, 0.02))))]"#;
        let more = if formulation == "Held" { more } else { "conditions: []" };
        let text = tank(shape, more)
            .replace("Rigid()", if formulation == "Rigid" { "Rigid()" } else { "TotalLagrangian" });
        let mut sim = simulation(&text);
        sim.run(|_| true).expect("a run");
        sim.warnings().iter().any(|text| text.contains("`stone` lies on another body or a wall at"))
    };
    let (thin, block) = ("Box(min: (0.1, 0.0), max: (0.2, 0.02))", "Box(min: (0.1, 0.0), max: (0.2, 0.06))");
    assert!(told(thin, "Rigid") && told(block, "TotalLagrangian"));
    // One that is held there, one in the water, and one that has its pressure.
    assert!(!told(block, "Held") && !told("Box(min: (0.1, 0.1), max: (0.2, 0.16))", "TotalLagrangian"));
    assert!(!told(block, "Rigid"));
}

/// No fluid is missing below a container that stands in the dry, but below one that stands in water it is.
#[test]
fn a_container_in_the_dry_has_no_fluid_below_it() {
    let told = |formulation: &str, layers: f64, outside: bool, floor: f64| {
        let (t, e) = (0.01 * layers, 0.16 + 0.01 * layers);
        let shape = format!(
            "Polygon(points: [(-{t}, 0), ({e}, 0), ({e}, 0.12), (0.16, 0.12), (0.16, {t}), (0, {t}), (0, 0.12), (-{t}, 0.12)])"
        );
        let inside = format!("Box(min: (0, {t}), max: (0.16, 0.1))");
        let around = format!(
            "Difference(Box(min: (-0.16, 0), max: (0.32, 0.06)), Box(min: (-{t}, 0), max: ({e}, 1)))"
        );
        let water = if outside { format!("Union([{inside}, {around}])") } else { inside };
        let mut sim = simulation(&format!(
            r#"(dimension: Two, gravity: (0.0, -{GRAVITY}),
                materials: {{"water": Fluid(density: 1000.0, sound_speed: 20.0), "stuff": NeoHookean(density: 1200.0, young: 1.0e7, poisson: 0.3)}},
                bodies: [
                    (name: "water", material: "water", spacing: 0.01, formulation: Fluid, shape: {water}),
                    (name: "container", material: "stuff", spacing: 0.01, formulation: {formulation}, shape: {shape}),
                    (name: "tank", material: "wall", spacing: {floor}, formulation: Wall(),
                     shape: Difference(Box(min: (-0.2, -0.04), max: (0.36, 0.2)), Box(min: (-0.16, 0), max: (0.32, 1)))),
                ],
                contacts: [Contact(between: ("container", "tank"), restitution: 0.1)], time: (end: 0.03))"#
        ));
        sim.run(|_| true).expect("a run");
        sim.warnings().iter().any(|text| text.contains("`container` lies on another body or a wall at"))
    };
    for (formulation, layers) in [("Rigid()", 2.0), ("TotalLagrangian", 2.0), ("TotalLagrangian", 4.0)] {
        assert!(!told(formulation, layers, false, 0.01), "{formulation}, {layers} layers, in the dry");
        assert!(told(formulation, layers, true, 0.01), "{formulation}, {layers} layers, in water");
    }
    // The nearest particles of a floor with another lattice are in oblique directions.
    assert!(!told("TotalLagrangian", 4.0, false, 0.008) && told("TotalLagrangian", 4.0, true, 0.008));
}

/// A dam on the floor with water on one side: the pressure below it is between that of the water and none.
#[test]
fn the_pressure_below_a_dam_ends_where_it_is_dry() {
    let shape = "Box(min: (0.1, 0.0), max: (0.2, 0.22))";
    let text = tank(shape, r#"conditions: [Fix(on: Select(body: "stone"))]"#).replace(
        &format!("Difference(Box(min: (0, 0), max: (0.3, 0.2)), {shape})"),
        "Box(min: (0, 0), max: (0.1, 0.2))",
    );
    let on_dam = force(&mut simulation(&text), 2);
    let (push, all_wet) = (0.5 * 1000.0 * GRAVITY * 0.04, 1000.0 * GRAVITY * 0.2 * 0.1);
    assert!((on_dam.x / push - 1.0).abs() < 0.03, "{on_dam}");
    assert!((0.3..0.7).contains(&(on_dam.y / all_wet)), "{on_dam}");
}

/// It falls evenly below the dam, from the water to the dry side: the moment of the uplift about the middle
/// is `rho g h b^2 / 12`, where a pressure that ends halfway has 1.5 times that.
#[test]
fn the_pressure_below_a_dam_falls_evenly() {
    let mut sim = simulation(
        r#"(dimension: Two, gravity: (0.0, -9.81),
            materials: {"water": Fluid(density: 1000.0, sound_speed: 30.0), "stone": NeoHookean(density: 2500.0, young: 1.0e6, poisson: 0.3)},
            bodies: [
                (name: "water", material: "water", spacing: 0.02, formulation: Fluid, shape: Box(min: (-0.2, 0), max: (0, 0.2))),
                (name: "tank", material: "wall", spacing: 0.02, formulation: Wall(),
                 shape: Union([Box(min: (-0.26, -0.06), max: (0.5, 0)), Box(min: (-0.26, 0), max: (-0.2, 0.3))])),
                (name: "dam", material: "stone", spacing: 0.02, formulation: Rigid(), shape: Box(min: (0, 0), max: (0.4, 0.3))),
            ],
            conditions: [Fix(on: Select(body: "dam"))], time: (end: 0.001))"#,
    );
    sim.run(|_| true).expect("a run");
    let cloud = sim.resources().get::<FlowCloud>();
    let places = column::<Position>(&sim, 2);
    let forces = cloud.forces_on(BodyId(2)).expect("a flow");
    let uplift: f64 = places.iter().zip(forces.iter()).map(|(x, (force, _))| force.y * (x.0.x - 0.2)).sum();
    let even = -1000.0 * GRAVITY * 0.2 * 0.4 * 0.4 / 12.0;
    assert!((1.0..1.2).contains(&(uplift / even)), "{uplift} and {even}");
}

#[test]
fn a_cube_on_the_floor_has_its_buoyancy_in_space() {
    let mut sim = simulation(
        r#"(dimension: Three, gravity: (0.0, -9.81, 0.0),
            materials: {"water": Fluid(density: 1000.0, sound_speed: 20.0), "stone": NeoHookean(density: 2500.0, young: 1.0e6, poisson: 0.3)},
            bodies: [
                (name: "water", material: "water", spacing: 0.02, formulation: Fluid(support: 2.8),
                 shape: Difference(Box(min: (0, 0, 0), max: (0.24, 0.2, 0.24)), Box(min: (0.08, 0, 0.08), max: (0.16, 0.08, 0.16)))),
                (name: "tank", material: "wall", spacing: 0.02, formulation: Wall(),
                 shape: Difference(Box(min: (-0.06, -0.06, -0.06), max: (0.3, 0.22, 0.3)), Box(min: (0, 0, 0), max: (0.24, 1, 0.24)))),
                (name: "stone", material: "stone", spacing: 0.02, formulation: Rigid(), shape: Box(min: (0.08, 0, 0.08), max: (0.16, 0.08, 0.16))),
            ],
            conditions: [Fix(on: Select(body: "stone"))], time: (end: 0.01))"#,
    );
    let lift = force(&mut sim, 2);
    let expected = 1000.0 * GRAVITY * 0.08_f64.powi(3);
    assert!((lift - expected * DVec3::Y).length() < 0.1 * expected, "{lift} and {expected}");
}

/// What strikes a body on the floor does not lift it by the pressure below it: that falls as the gap opens,
/// and what it gives nevertheless is told of as the work of a gap.
#[test]
fn a_gap_that_opens_loses_its_pressure() {
    let mut sim = simulation(
        r#"(dimension: Two, gravity: (0.0, -9.81),
            materials: {"water": Fluid(density: 1000.0, sound_speed: 25.0), "wood": NeoHookean(density: 600.0, young: 1.0e6, poisson: 0.3)},
            bodies: [
                (name: "water", material: "water", spacing: 0.02, formulation: Fluid, shape: Box(min: (0, 0), max: (0.3, 0.4))),
                (name: "block", material: "wood", spacing: 0.02, formulation: Rigid(), shape: Box(min: (0.5, 0), max: (0.6, 0.1))),
                (name: "tank", material: "wall", spacing: 0.02, formulation: Wall(),
                 shape: Difference(Box(min: (-0.08, -0.08), max: (0.88, 0.8)), Box(min: (0, 0), max: (0.8, 2)))),
            ],
            contacts: [Contact(between: ("block", "tank"), surface: Particles)], time: (end: 0.2))"#,
    );
    sim.run(|_| true).expect("a run");
    let given = -sim.ledger().total_named("wall_pressure");
    // The pressure at the foot of the column at rest, on the width of the block, over the spacing: 7.8 J.
    // Without the fall it was 13.
    let at_rest = 1000.0 * GRAVITY * 0.4 * 0.1 * 0.02;
    assert!(given < 1.3 * at_rest, "{given} J of {at_rest} J");
    let told = |part: &str| sim.warnings().iter().any(|text| text.contains(part));
    assert!(
        told("the pressure in gaps that no particle of the fluid fits into has moved a body"),
        "{:?}",
        sim.warnings()
    );
}

/// Water in a container of four layers that stands on a dry floor: there is no fluid in the gap below it.
#[test]
fn pressure_does_not_pass_through_a_container_into_a_dry_gap() {
    let mut sim = simulation(&format!(
        r#"(dimension: Two, gravity: (0.0, -{GRAVITY}),
            materials: {{"water": Fluid(density: 1000.0, sound_speed: 25.0), "wood": NeoHookean(density: 500.0, young: 1.0e7, poisson: 0.3)}},
            bodies: [
                (name: "water", material: "water", spacing: 0.01, formulation: Fluid, shape: Box(min: (0, 0), max: (0.4, 0.2))),
                (name: "container", material: "wood", spacing: 0.01, formulation: Rigid(),
                 shape: Polygon(points: [(-0.04, -0.04), (0.44, -0.04), (0.44, 0.3), (0.4, 0.3), (0.4, 0), (0, 0), (0, 0.3), (-0.04, 0.3)])),
                (name: "floor", material: "wood", spacing: 0.01, formulation: Rigid(), shape: Box(min: (-0.2, -0.1), max: (0.6, -0.04))),
            ],
            conditions: [Fix(on: Select(body: "floor")), Fix(on: Select(body: "container"))], time: (end: 0.1))"#
    ));
    let (on_container, weight) = (force(&mut sim, 1), 1000.0 * GRAVITY * 0.4 * 0.2);
    assert!((on_container + weight * DVec3::Y).length() < 0.02 * weight, "{on_container} and {weight}");
}
