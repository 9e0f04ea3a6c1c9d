//! Rigid bodies that touch each other and deformable ones.

use glam::DVec3;

use super::{centre, momentum, simulation};
use crate::rigid::RigidBodies;
use crate::simulation::Simulation;

/// A sphere of steel that falls on a fixed block at `speed`; `contact` goes into the contact.
fn sphere_on_block(speed: f64, contact: &str, end: f64) -> Simulation {
    simulation(&format!(
        r#"(dimension: Three,
            materials: {{"steel": NeoHookean(density: 7850, young: 2.1e11, poisson: 0.3),
                        "anvil": NeoHookean(density: 7850, young: 1e25, poisson: 0.3)}},
            bodies: [
                (name: "anvil", material: "anvil", shape: Box(min: (-0.02, -0.02, -0.02), max: (0.02, 0.02, 0)), spacing: 0.01,
                 formulation: Rigid()),
                (name: "ball", material: "steel", shape: Sphere(center: (0.003, 0.001, 0.0100001), radius: 0.01), spacing: 0.005,
                 formulation: Rigid(), velocity: (0, 0, {})),
            ],
            conditions: [Fix(on: Select(body: "anvil"))],
            contacts: [Contact(between: ("ball", "anvil"), {contact})],
            time: (end: {end:?}))"#,
        -speed
    ))
}

#[test]
fn hertz_impact_of_a_sphere_has_the_depth_force_and_time_of_the_closed_form() {
    let mut sim = sphere_on_block(1.0, "law: Hertz()", 1e-4);
    sim.start().unwrap();
    let (mut deepest, mut begin, mut finish, mut force) = (0.0f64, 0.0, 0.0, 0.0f64);
    while !sim.is_finished() {
        sim.step().unwrap();
        let overlap = 0.01 - centre(&sim, 1).0.z;
        let bodies = sim.resources().get::<RigidBodies>();
        force = force.max(bodies[1].state.force.length());
        deepest = deepest.max(overlap);
        if overlap > 0.0 {
            if begin == 0.0 {
                begin = sim.clock().time;
            }
            finish = sim.clock().time;
        }
    }
    // E_hertz_sphere_impact.csv, first row.
    let check = |found: f64, expected: f64, tolerance: f64| {
        assert!((found / expected - 1.0).abs() < tolerance, "{found} {expected}");
    };
    check(deepest, 1.77951091e-05, 0.01);
    check(force, 2309.76408, 0.01);
    check(finish - begin, 5.23745652e-05, 0.03);
    let (_, v) = centre(&sim, 1);
    assert!((v.z - 1.0).abs() < 5e-3 && v.x.abs() < 1e-12, "{v}");
    assert!(sim.ledger().relative_error().abs() < 1e-2, "{}", sim.ledger().relative_error());
}

#[test]
fn restitution_is_what_is_asked_for() {
    for (law, wanted) in [("Penalty()", 0.9), ("Penalty()", 0.5), ("Penalty()", 0.2), ("Hertz()", 0.6)] {
        let contact = format!("law: {law}, restitution: {wanted}");
        let mut sim = sphere_on_block(1.0, &contact, 3e-4);
        sim.run(|_| true).unwrap();
        let (_, v) = centre(&sim, 1);
        assert!((v.z / wanted - 1.0).abs() < 0.02, "{law} {wanted}: {}", v.z);
        let lost = sim.ledger().total_named("contact_damping");
        let energy = sim.ledger().stored_at_start();
        assert!((lost / energy - (1.0 - wanted * wanted)).abs() < 0.02, "{lost} of {energy}");
    }
}

/// Speed at which a rigid block rebounds that lands flat at 1 m/s, m/s, and the balance error.
fn rebound(dimension: &str, floor: &str, restitution: f64) -> (f64, f64) {
    let (low, high, down) = if dimension == "Two" {
        ("(0, 0.001)", "(0.1, 0.051)", "(0, -1)")
    } else {
        ("(0, 0.001, 0)", "(0.1, 0.051, 0.08)", "(0, -1, 0)")
    };
    let mut sim = simulation(&format!(
        r#"(dimension: {dimension},
            materials: {{"stone": NeoHookean(density: 1000, young: 1e7, poisson: 0.3)}},
            bodies: [
                (name: "floor", material: "stone", shape: {floor}, spacing: 0.01, formulation: Rigid()),
                (name: "block", material: "stone", shape: Box(min: {low}, max: {high}), spacing: 0.01, formulation: Rigid(),
                 velocity: {down}),
            ],
            conditions: [Fix(on: Select(body: "floor"))],
            contacts: [Contact(between: ("block", "floor"), restitution: {restitution})],
            time: (end: 0.01))"#
    ));
    sim.run(|_| true).unwrap();
    (centre(&sim, 1).1.y, sim.ledger().relative_error().abs())
}

#[test]
fn a_block_that_lands_flat_has_the_restitution_that_is_asked_for() {
    for (dimension, plane, floor) in [
        ("Two", "HalfSpace(point: (0, 0), normal: (0, 1))", "Box(min: (-0.05, -0.05), max: (0.15, 0))"),
        (
            "Three",
            "HalfSpace(point: (0, 0, 0), normal: (0, 1, 0))",
            "Box(min: (-1, -0.1, -1), max: (1, 0, 1))",
        ),
    ] {
        let all: &[f64] = if dimension == "Two" { &[0.9, 0.5, 0.1] } else { &[0.5] };
        for &wanted in all {
            let (found, error) = rebound(dimension, plane, wanted);
            assert!((found - wanted).abs() < 0.02, "{dimension} {wanted}: {found}");
            assert!(error < 5e-3, "{dimension} {wanted}: {error}");
        }
        // The points of a box touch the block as well, beside its own; dashpots of zero restitution threw it
        // away.
        let (found, error) = rebound(dimension, floor, 0.0);
        assert!((0.0..0.05).contains(&found) && error < 0.05, "{dimension}: {found} {error}");
    }
}

#[test]
fn a_roller_that_is_turned_drives_what_lies_on_it_and_its_work_is_booked() {
    let mut sim = simulation(
        r#"(dimension: Two, gravity: (0, -10),
            materials: {"stone": NeoHookean(density: 1000, young: 1e7, poisson: 0.3)},
            bodies: [
                (name: "roller", material: "stone", shape: Sphere(center: (0, -0.1), radius: 0.1), spacing: 0.05, formulation: Rigid()),
                (name: "plank", material: "stone", shape: Box(min: (-0.5, 0), max: (0.5, 0.05)), spacing: 0.025,
                 formulation: Rigid(rotation: Held)),
            ],
            conditions: [Fix(on: Select(body: "roller")), RotationRate(on: Select(body: "roller"), rate: "-2*smoothstep(t/0.05)")],
            contacts: [Contact(between: ("roller", "plank"), law: Penalty(stiffness: 1e6), friction: 0.5, restitution: 0.3)],
            time: (end: 0.5))"#,
    );
    sim.run(|_| true).unwrap();
    let (_, plank) = centre(&sim, 1);
    // The surface of the roller moves at 0.2 m/s.
    assert!((plank.x - 0.2).abs() < 2e-3 && plank.y.abs() < 1e-3, "{plank}");
    let constraints = sim.ledger().total_named("constraints");
    assert!(constraints > 0.9 && sim.ledger().relative_error().abs() < 1e-2, "{constraints}");
}

/// Momentum and angular momentum about the origin of all rigid bodies.
pub(super) fn momenta(sim: &Simulation) -> (DVec3, DVec3) {
    let bodies = sim.resources().get::<RigidBodies>();
    let linear = bodies.iter().map(|body| body.mass * body.state.velocity).sum();
    let angular = |body: &crate::rigid::RigidBody| {
        body.state.center.cross(body.mass * body.state.velocity) + body.state.angular_momentum
    };
    (linear, bodies.iter().map(angular).sum())
}

#[test]
fn tumbling_boxes_and_a_sphere_keep_momentum_and_angular_momentum() {
    let mut sim = simulation(
        r#"(dimension: Three,
            materials: {"steel": NeoHookean(density: 1000, young: 1e7, poisson: 0.3)},
            bodies: [
                (name: "one", material: "steel", shape: Box(min: (0, 0, 0), max: (0.1, 0.06, 0.04)), spacing: 0.01,
                 formulation: Rigid(spin: (3, -20, 9))),
                (name: "two", material: "steel", shape: Box(min: (0.03, 0.02, 0.07), max: (0.09, 0.08, 0.11)), spacing: 0.01,
                 formulation: Rigid(spin: (10, 2, -5)), velocity: (0.1, -0.2, -2.0)),
                (name: "ball", material: "steel", shape: Sphere(center: (0.02, 0.03, -0.05), radius: 0.03), spacing: 0.01,
                 formulation: Rigid(), velocity: (0.0, 0.1, 1.5)),
            ],
            contacts: [
                Contact(between: ("one", "two"), law: Penalty(), friction: 0.3, restitution: 0.9),
                Contact(between: ("one", "ball"), law: Hertz(), friction: 0.5, restitution: 0.7),
                Contact(between: ("two", "ball"), law: Hertz()),
            ],
            time: (end: 0.1))"#,
    );
    sim.start().unwrap();
    let (p, l) = momenta(&sim);
    let particles = momentum(&sim);
    assert!((particles - p).length() < 1e-12 * p.length());
    sim.run(|_| true).unwrap();
    let (q, m) = momenta(&sim);
    assert!((q - p).length() < 1e-12 * p.length(), "{p} {q}");
    assert!((m - l).length() < 1e-12 * l.length(), "{l} {m}");
    let bodies = sim.resources().get::<RigidBodies>();
    let hit = bodies.iter().filter(|body| body.state.velocity.length() > 0.05).count();
    assert!(hit == 3 && sim.ledger().total_named("friction") > 0.0);
    assert!(sim.ledger().relative_error().abs() < 5e-3, "{}", sim.ledger().relative_error());
}

#[test]
fn a_body_may_not_start_inside_a_tool() {
    let text = r#"(dimension: Two,
        materials: {"soft": NeoHookean(density: 1000, young: 1e6, poisson: 0.3)},
        bodies: [
            (name: "block", material: "soft", shape: Box(min: (0, 0), max: (0.1, 0.1)), spacing: 0.01,
             formulation: TotalLagrangian),
            (name: "tool", material: "soft", shape: Box(min: (0.0, 0.097), max: (0.1, 0.3)), spacing: 0.05,
             formulation: Rigid()),
        ],
        contacts: [Contact(between: ("block", "tool"), law: Penalty())],
        time: (end: 1e-3))"#;
    let (scene, source) = crate::scene::parse(crate::scene::Source::new("x.ron", text)).unwrap();
    let error = crate::assembly::build(&scene, &source, &crate::plugin::Registry::standard());
    let Err(error) = error else { panic!("it was built") };
    assert!(error.to_string().contains("the surface of `block` starts inside rigid body `tool`"), "{error}");
}

/// The particles of a lattice beside a curved side are nearer to it than half a spacing.
#[test]
fn a_body_may_start_on_a_curved_tool() {
    let sim = simulation(
        r#"(dimension: Two,
        materials: {"soft": NeoHookean(density: 1000, young: 1e6, poisson: 0.3)},
        bodies: [
            (name: "arch", material: "soft", spacing: 0.002, formulation: TotalLagrangian,
             shape: Difference(Ring(center: (0, 0), inner: 0.1, outer: 0.108), HalfSpace(point: (0, 0), normal: (0, 1)))),
            (name: "drum", material: "soft", shape: Sphere(center: (0, 0), radius: 0.1), spacing: 0.01,
             formulation: Rigid()),
        ],
        contacts: [Contact(between: ("arch", "drum"), law: Penalty())],
        time: (end: 1e-3))"#,
    );
    assert_eq!(sim.world().bodies().len(), 2);
}

/// A block between a fixed table and a tool that presses it with that motion; contacts of that kind, up to
/// that time, s.
fn pressed_block(motion: &str, contact: &str, end: f64) -> Simulation {
    simulation(&format!(
        r#"(dimension: Two,
            materials: {{"soft": NeoHookean(density: 1000, young: 1e6, poisson: 0.3)}},
            bodies: [
                (name: "block", material: "soft", shape: Box(min: (0, 0), max: (0.1, 0.1)), spacing: 0.01,
                 formulation: TotalLagrangian),
                (name: "table", material: "soft", shape: Box(min: (-0.05, -0.1), max: (0.15, 0)), spacing: 0.05,
                 formulation: Rigid()),
                (name: "tool", material: "soft", shape: Box(min: (-0.05, 0.1), max: (0.15, 0.2)), spacing: 0.05,
                 formulation: Rigid()),
            ],
            conditions: [Fix(on: Select(body: "table")), {motion}],
            contacts: [
                Contact(between: ("block", "tool"), {contact}),
                Contact(between: ("block", "table"), {contact}),
            ],
            time: (end: {end}))"#,
    ))
}

#[test]
fn a_tool_that_presses_feels_the_reaction_and_does_the_work() {
    let motion = r#"Velocity(on: Select(body: "tool"), value: (0.0, "-0.5*smoothstep(t/0.01)"))"#;
    let mut sim = pressed_block(motion, "law: Penalty()", 0.02);
    sim.run(|_| true).unwrap();
    let bodies = sim.resources().get::<RigidBodies>();
    let states: Vec<_> = bodies.iter().map(|body| body.state).collect();
    let (table, tool) = (states[0], states[1]);
    // Pressed by 7.5 mm of 100: about E'(0.075) over 0.1 m, with half a spacing of soft contact on both
    // sides.
    assert!((5e3..9e3).contains(&tool.force.y), "{}", tool.force);
    assert!((table.force.y + tool.force.y).abs() < 0.1 * tool.force.y, "{} {}", table.force, tool.force);
    assert!((tool.center.y - 0.15 + 0.0075).abs() < 1e-6, "{}", tool.center);
    let work = sim.ledger().total_named("constraints");
    assert!(work > 0.0 && (sim.ledger().stored() / work - 1.0).abs() < 0.01, "{work}");
    assert!(sim.ledger().relative_error().abs() < 2e-3, "{}", sim.ledger().relative_error());
    // The force column of its particles adds up to the reaction.
    let (view, rows) = sim.world().body_view(crate::world::BodyId(2));
    let force = view.read::<crate::world::Force>().unwrap();
    let sum: DVec3 = rows.map(|row| force[row].0).sum();
    assert!((sum - tool.force).length() < 1e-9 * tool.force.length());
}

#[test]
fn dashpots_take_energy_from_a_block_that_is_pressed_and_give_none_back() {
    let motion = r#"Displacement(on: Select(body: "tool"), value: (0.0, "-0.008*(smoothstep(t/0.01) - smoothstep(t/0.01 - 1.5))"))"#;
    let mut sim = pressed_block(motion, "law: Penalty(), friction: 0.3, restitution: 0.4", 0.025);
    let (mut largest, mut fallen) = (0.0f64, 0.0f64);
    while !sim.is_finished() {
        sim.step().unwrap();
        let lost = sim.ledger().total_named("contact_damping");
        largest = largest.max(lost);
        fallen = fallen.max(largest - lost);
    }
    assert!(largest > 0.0 && fallen < 0.01 * largest, "{fallen} of {largest} was given back");
    assert!(sim.ledger().relative_error().abs() < 5e-3, "{}", sim.ledger().relative_error());
}

#[test]
fn a_hard_body_that_falls_into_an_empty_corner_of_a_tank_bounces_with_the_speed_that_it_had() {
    // The step of the water is three hundred times that of the impact, and the wall has none of its own.
    let mut sim = simulation(
        r#"(dimension: Two,
            materials: {"water": Fluid(density: 1000, sound_speed: 30), "steel": NeoHookean(density: 7850, young: 2e11, poisson: 0.3)},
            bodies: [
                (name: "water", material: "water", shape: Box(min: (0, 0), max: (0.2, 0.1)), spacing: 0.02, formulation: Fluid),
                (name: "tank", material: "water", spacing: 0.02, formulation: Wall,
                 shape: Difference(Box(min: (-0.08, -0.08), max: (1.08, 0.4)), Box(min: (0, 0), max: (1, 1)))),
                (name: "disc", material: "steel", shape: Sphere(center: (0.7, 0.085), radius: 0.08), spacing: 0.02,
                 formulation: Rigid, velocity: (0, -2)),
            ],
            contacts: [Contact(between: ("disc", "tank"), law: Penalty())],
            time: (end: 0.006))"#,
    );
    sim.start().unwrap();
    while !sim.is_finished() {
        sim.step().unwrap();
    }
    let (x, v) = centre(&sim, 2);
    assert!((v.y - 2.0).abs() < 0.02 && x.y > 0.08, "{x} {v}");
}

/// Three balls in a row on one line, the first of which flies at the others; `contacts` are those of the
/// scene.
fn cradle(contacts: &str) -> Simulation {
    let ball = |k: usize, x: f64, speed: f64| {
        format!(
            r#"(name: "ball {k}", material: "steel", shape: Sphere(center: ({x}, 0, 0), radius: 0.01), spacing: 0.005, formulation: Rigid(), velocity: ({speed:?}, 0, 0)),"#
        )
    };
    let balls: String = [(0.0, 1.0), (0.021, 0.0), (0.042, 0.0)]
        .into_iter()
        .enumerate()
        .map(|(k, (x, speed))| ball(k + 1, x, speed))
        .collect();
    simulation(&format!(
        r#"(dimension: Three, materials: {{"steel": NeoHookean(density: 7850, young: 2.1e11, poisson: 0.3)}},
            bodies: [{balls}], contacts: [{contacts}], time: (end: 3e-3))"#
    ))
}

#[test]
fn a_star_stands_for_all_bodies_whose_names_begin_alike() {
    let one_by_one: String = [(1, 2), (1, 3), (2, 3)]
        .map(|(a, b)| format!(r#"Contact(between: ("ball {a}", "ball {b}"), law: Hertz()),"#))
        .concat();
    let all = r#"Contact(between: ("ball*", "ball*"), law: Hertz())"#;
    let each = r#"Contact(between: ("ball 1", "ball*"), law: Hertz()), Contact(between: ("ball 2", "ball 3"), law: Hertz())"#;
    let hashes = [&one_by_one, all, each].map(|contacts| {
        let mut sim = cradle(contacts);
        sim.run(|_| true).unwrap();
        // The last ball leaves with the speed of the first.
        assert!((centre(&sim, 2).1.x - 1.0).abs() < 5e-3, "{}", centre(&sim, 2).1);
        sim.state_hash()
    });
    assert!(hashes[0] == hashes[1] && hashes[0] == hashes[2]);
}

#[test]
fn a_rigid_block_slides_down_a_slope_with_the_acceleration_of_coulomb() {
    // 30 degrees, friction 0.4: a = g (sin 30 - 0.4 cos 30), over seven points of the floor that the front of
    // the block passes.
    let (g, friction) = (9.81, 0.4);
    let (sin, cos) = 30f64.to_radians().sin_cos();
    let mut sim = simulation(&format!(
        r#"(dimension: Two, gravity: ({}, {}), materials: {{"s": NeoHookean(density: 1000.0, young: 2.0e6, poisson: 0.3)}},
            bodies: [
                (name: "block", material: "s", shape: Box(min: (0, 0), max: (0.16, 0.08)), spacing: 0.01, formulation: Rigid()),
                (name: "floor", material: "s", shape: Box(min: (-0.1, -0.05), max: (0.4, 0)), spacing: 0.01, formulation: Rigid()),
            ],
            conditions: [Fix(on: Select(body: "floor"))],
            contacts: [Contact(between: ("block", "floor"), friction: {friction}, restitution: 0.6)],
            time: (end: 0.3))"#,
        g * sin,
        -g * cos
    ));
    sim.run(|_| true).unwrap();
    let speed = centre(&sim, 0).1.x;
    let expected = g * (sin - friction * cos) * 0.3;
    assert!((speed / expected - 1.0).abs() < 0.005, "{speed} {expected}");
}

/// A block of 19.62 N/m rests at x = 5 m on a half-space, which has no weight of its own.
#[test]
fn force_and_moment_on_a_half_space_are_those_of_the_contact() {
    let mut sim = simulation(
        r#"(dimension: Two, gravity: (0, -9.81),
            materials: {"stone": NeoHookean(density: 2000, young: 1e7, poisson: 0.3)},
            bodies: [
                (name: "block", material: "stone", shape: Box(min: (4.9, 0), max: (5.1, 0.005)), spacing: 0.0025, formulation: Rigid()),
                (name: "floor", material: "stone", shape: HalfSpace(point: (0, 0), normal: (0, 1)), spacing: 0.05, formulation: Rigid()),
            ],
            conditions: [Fix(on: Select(body: "floor"))],
            contacts: [Contact(between: ("block", "floor"), restitution: 0.1)],
            time: (end: 0.02))"#,
    );
    sim.run(|_| true).unwrap();
    let (view, rows) = sim.world().body_view(crate::world::BodyId(1));
    let force = view.read::<crate::world::Force>().unwrap();
    let place = view.read::<crate::world::Position>().unwrap();
    let sum: DVec3 = rows.clone().map(|row| force[row].0).sum();
    let moment: DVec3 = rows.map(|row| place[row].0.cross(force[row].0)).sum();
    assert!((sum.y + 19.62).abs() < 1e-3, "{sum}");
    assert!((moment.z + 5.0 * 19.62).abs() < 5e-3, "{moment}");
}
