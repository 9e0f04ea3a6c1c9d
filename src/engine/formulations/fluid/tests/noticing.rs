//! Flows that go wrong, and the warnings of the run.

use super::simulation;
use crate::assembly::build;
use crate::formulations::fluid::FlowCloud;
use crate::plugin::Registry;
use crate::rigid::RigidBodies;
use crate::scene::{Source, parse};
use crate::simulation::Simulation;

/// A tank with water, with what else is in the scene.
fn tank(water: &str, bodies: &str, more: &str) -> String {
    format!(
        r#"(dimension: Two, gravity: (0.0, -9.81), materials: {{"water": Fluid(density: 1000.0, sound_speed: 20.0), "block": NeoHookean(density: 7800.0, young: 1.0e6, poisson: 0.3)}},
            bodies: [
                (name: "water", material: "water", shape: Box(min: (0, 0), max: (0.6, 0.2)), spacing: 0.02, formulation: Fluid({water})),
                (name: "tank", material: "wall", spacing: 0.02, formulation: Wall(),
                 shape: Difference(Box(min: (-0.06, -0.06), max: (0.66, 0.4)), Box(min: (0, 0), max: (0.6, 1)))),
                {bodies}
            ],
            {more})"#
    )
}

fn warning<'s>(sim: &'s Simulation, part: &str) -> Option<&'s str> {
    sim.warnings().iter().find(|warning| warning.contains(part)).map(String::as_str)
}

/// What is wrong with a scene.
fn fault(text: &str) -> String {
    let built = parse(Source::new("test.ron", text))
        .and_then(|(scene, source)| build(&scene, &source, &Registry::standard()));
    match built {
        Ok(_) => panic!("the scene is taken"),
        Err(error) => error.to_string(),
    }
}

#[test]
fn a_flow_without_density_diffusion_is_warned_of() {
    let sim = simulation(&tank("", "", "time: (end: 1.0)"));
    assert!(warning(&sim, "nothing diffuses the density of `water`").is_some(), "{:?}", sim.warnings());
}

#[test]
fn the_warning_of_a_fast_flow_names_its_largest_mach_number_and_sound_is_the_end() {
    let scene = |end: f64| {
        format!(
            r#"(dimension: Two, domain: (min: (0, 0), max: (1, 1), periodic: [X, Y]),
                materials: {{"oil": Fluid(density: 1000.0, sound_speed: 10.0)}},
                bodies: [(name: "oil", material: "oil", shape: Box(min: (0, 0), max: (1, 1)), spacing: 0.1, formulation: Fluid)],
                conditions: [BodyForce(on: Select(), value: ("20*y - 10", 0.0))], time: (end: {end}))"#
        )
    };
    // The flow is sheared: the outer rows, at y = 0.05 and 0.95, move with v = 9 t.
    let mut slow = simulation(&scene(0.19));
    slow.run(|_| true).expect("a run");
    assert!(warning(&slow, "Mach").is_none(), "{:?}", slow.warnings());
    let mut fast = simulation(&scene(0.6));
    fast.run(|_| true).expect("a run");
    let fast: Vec<&String> = fast.warnings().iter().filter(|text| text.contains("Mach number of")).collect();
    let number = |text: &str| -> f64 {
        let rest = text.split("Mach number of ").nth(1).expect("a number");
        rest.split(',').next().expect("a number").parse().expect("a number")
    };
    assert!(fast.len() == 1 && (0.49..=0.54).contains(&number(fast[0])), "{fast:?}");
    let error = simulation(&scene(2.0)).run(|_| true).expect_err("faster than sound").to_string();
    assert!(error.contains("faster than its sound of 10 m/s"), "{error}");
}

#[test]
fn the_mach_number_of_a_tank_that_moves_as_a_whole_is_that_of_the_flow_in_it() {
    let scene = |walls: f64, sound: &str| {
        let moves = r#"conditions: [InitialVelocity(on: Select(body: "water"), value: (15.0, 0.0))], time: (end: 0.02)"#;
        tank("", "", moves)
            .replace("formulation: Wall()", &format!("velocity: ({walls:?}, 0.0), formulation: Wall()"))
            .replace(", sound_speed: 20.0", sound)
    };
    let mut together = simulation(&scene(15.0, ", sound_speed: 20.0"));
    together.run(|_| true).expect("a run");
    assert!(warning(&together, "Mach").is_none(), "{:?}", together.warnings());
    simulation(&scene(15.0, ", sound_speed: 12.0")).run(|_| true).expect("slower than its sound in the tank");
    let mut apart = simulation(&scene(0.0, ", sound_speed: 20.0"));
    apart.run(|sim| sim.clock().step < 3).expect("a run");
    assert!(warning(&apart, "Mach number of 0.7").is_some(), "{:?}", apart.warnings());
}

/// What nothing bounds moves on as it is, also faster than its sound.
#[test]
fn a_flow_without_bounds_is_judged_in_its_own_frame() {
    let scene = |speed: f64| {
        format!(
            r#"(dimension: Two, domain: (min: (0, 0), max: (1, 1), periodic: [X, Y]),
                materials: {{"oil": Fluid(density: 1000.0, sound_speed: 10.0)}},
                bodies: [(name: "oil", material: "oil", shape: Box(min: (0, 0), max: (1, 1)), spacing: 0.1, formulation: Fluid)],
                conditions: [InitialVelocity(on: Select(), value: ("{speed:?} + sin(2*pi*y)", 0.0))], time: (end: 0.05))"#
        )
    };
    let after = |speed| {
        let mut sim = simulation(&scene(speed));
        sim.run(|_| true).expect("a run");
        assert!(warning(&sim, "Mach").is_none(), "{:?}", sim.warnings());
        sim.clock().step
    };
    // The stable step is the same, too.
    assert_eq!(after(30.0), after(0.0));
}

/// Friction makes pressures that have nothing to do with the Mach number: between two discs that are drawn
/// apart, and here by a load that varies along a closed box.
#[test]
fn a_slow_flow_that_is_compressed_is_warned_of() {
    let run = |sound: f64| {
        let mut sim = simulation(&format!(
            r#"(dimension: Two, materials: {{"oil": Fluid(density: 1.0, sound_speed: {sound:?}, viscosity: 1.0)}},
                bodies: [
                    (name: "oil", material: "oil", shape: Box(min: (0, 0), max: (1, 0.4)), spacing: 0.05, formulation: Fluid),
                    (name: "box", material: "wall", spacing: 0.05, formulation: Wall(suction: true),
                     shape: Difference(Box(min: (-0.15, -0.15), max: (1.15, 0.55)), Box(min: (0, 0), max: (1, 0.4)))),
                ],
                conditions: [BodyForce(on: Select(body: "oil"), value: (1.0, 0.0))],
                time: (end: 2.0), record: (every: 0.2))"#
        ));
        sim.run(|_| true).expect("a run");
        warning(&sim, "is compressed unevenly").map(str::to_owned)
    };
    // Pressures of rho b L = 1 Pa: a standard deviation of 1 / sqrt(12) over rho c^2.
    let text = run(2.0).expect("a warning");
    let share: f64 = text
        .split("varies by ")
        .nth(1)
        .and_then(|rest| rest.split(' ').next())
        .expect("a share")
        .parse()
        .expect("a number");
    assert!((share - 100.0 / 12f64.sqrt() / 4.0).abs() < 1.5, "{text}");
    assert_eq!(run(10.0), None);
}

#[test]
fn a_speed_of_sound_is_estimated_against_what_bounds_the_flow() {
    let sound = |water: f64, walls: f64| {
        let scene = tank("", "", "time: (end: 1.0)").replace(", sound_speed: 20.0", "");
        let scene = scene
            .replace("formulation: Fluid()", &format!("velocity: ({water:?}, 0.0), formulation: Fluid()"));
        let sim = simulation(
            &scene
                .replace("formulation: Wall()", &format!("velocity: ({walls:?}, 0.0), formulation: Wall()")),
        );
        let cloud = sim.resources().get::<FlowCloud>();
        cloud.groups[0].fluid().map(|state| state.sound_speed).expect("a fluid")
    };
    // A fall through the height between the lowest and the highest row, 0.18 m, ends with 1.88 m/s.
    let fall = 10.0 * (2.0_f64 * 9.81 * 0.18).sqrt();
    assert!((sound(15.0, 15.0) - fall).abs() < 1e-9 * fall);
    assert!((sound(15.0, 12.0) - 30.0).abs() < 1e-9);
    assert!((sound(15.0, 0.0) - 150.0).abs() < 1e-9);
}

#[test]
fn a_particle_inside_of_a_wall_is_named_with_place_and_time() {
    let more = r#"conditions: [Velocity(on: Select(body: "water", nearest: (0.31, 0.01)), value: (0.0, "-0.4"))], time: (end: 0.1)"#;
    let mut sim = simulation(&tank("", "", more));
    sim.run(|_| true).expect("a run");
    // It starts 0.01 m above the floor and goes down with 0.4 m/s: it is 0.01 m below the surface at 0.05 s.
    let text = warning(&sim, "is inside of `tank`").expect("a warning");
    let milliseconds: f64 = text
        .split(") and ")
        .nth(1)
        .and_then(|rest| rest.split_once(" ms").map(|(time, _)| time))
        .expect("a time")
        .parse()
        .expect("a time");
    assert!(text.contains("of `water`") && (50.0..80.0).contains(&milliseconds), "{text}");
}

#[test]
fn a_fluid_that_has_swollen_is_warned_of() {
    // Lengths have grown by a tenth, and the densities do not know.
    let more = r#"conditions: [InitialDisplacement(on: Select(body: "water"), value: ("0.1*(x - 0.3)", "0.1*y"))], time: (end: 0.001)"#;
    let scene = tank("pressure: 0.0", "", more)
        .replace("(-0.06, -0.06), max: (0.66", "(-0.16, -0.06), max: (0.76")
        .replace("Box(min: (0, 0), max: (0.6, 1))", "Box(min: (-0.1, 0), max: (0.7, 1))");
    let mut sim = simulation(&scene);
    sim.run(|_| true).expect("a run");
    let text = warning(&sim, "do not fill").expect("a warning");
    let share: f64 = text
        .split("make up ")
        .nth(1)
        .and_then(|rest| rest.split(' ').next())
        .expect("a share")
        .parse()
        .expect("a share");
    assert!((share - 100.0 / 1.21).abs() < 3.0, "{text}");
}

#[test]
fn a_rigid_body_that_sinks_to_a_wall_without_contact_is_warned_of() {
    let block = r#"(name: "block", material: "block", shape: Box(min: (0.2, 0.26), max: (0.4, 0.34)), spacing: 0.02, formulation: Rigid()),"#;
    let contact = r#"contacts: [(between: ("block", "tank"), law: Penalty())], time: (end: 1.0)"#;
    let sinks = simulation(&tank("", block, "time: (end: 1.0)"));
    assert!(warning(&sinks, "no contact holds it off a wall").is_some(), "{:?}", sinks.warnings());
    let held = simulation(&tank("", block, contact));
    assert!(warning(&held, "no contact").is_none(), "{:?}", held.warnings());
    let floor = r#"(name: "floor", material: "block", shape: Box(min: (0.1, 0.0), max: (0.5, 0.1)), spacing: 0.02, formulation: TotalLagrangian()),"#;
    let on_floor = contact.replace("tank", "floor");
    let scene = tank("", &format!("{block}{floor}"), &on_floor).replace("max: (0.6, 0.2)", "max: (0.1, 0.2)");
    let rests = simulation(&scene);
    assert!(warning(&rests, "no contact").is_none(), "{:?}", rests.warnings());
    let wood = tank("", block, "time: (end: 1.0)").replace("7800.0", "500.0");
    assert!(warning(&simulation(&wood), "no contact").is_none());
}

#[test]
fn a_body_that_passes_through_a_wall_is_named() {
    let block = r#"(name: "block", material: "block", shape: Box(min: (0.2, 0.21), max: (0.4, 0.29)), spacing: 0.02, formulation: Rigid(), velocity: (0.0, -4.0)),"#;
    // The floor below it is dry: water that cannot pass would carry it.
    let scene = tank("", block, "time: (end: 0.12)").replace("max: (0.6, 0.2)", "max: (0.14, 0.2)");
    let mut sim = simulation(&scene);
    sim.run(|_| true).expect("a run");
    let text = warning(&sim, "of `block` is inside of `tank`").expect("a warning");
    assert!(text.contains("no contact holds the two apart"), "{text}");
}

#[test]
fn rows_of_a_viscous_flow_that_break_up_are_warned_of() {
    let channel = |lattice: &str, viscosity: f64| {
        let mut sim = simulation(&format!(
            r#"(dimension: Two, domain: (min: (0, -1), max: (0.8, 2), periodic: [X]),
                materials: {{"oil": Fluid(density: 1.0, sound_speed: 10.0, viscosity: {viscosity})}},
                bodies: [
                    (name: "oil", material: "oil", shape: Box(min: (0, 0), max: (0.8, 1)), spacing: 0.1, lattice: {lattice}, formulation: Fluid),
                    (name: "walls", material: "wall", spacing: 0.1, formulation: Wall(slip: No, suction: true),
                     shape: Difference(Box(min: (0, -0.3), max: (0.8, 1.3)), Box(min: (-1, 0), max: (2, 1)))),
                ],
                conditions: [
                    BodyForce(on: Select(body: "oil"), value: ({}, 0.0)),
                    InitialVelocity(on: Select(body: "oil"), value: ("4*y*(1 - y)", 0.0)),
                ],
                time: (end: 3.0))"#,
            8.0 * viscosity
        ));
        sim.run(|_| true).expect("a run");
        warning(&sim, "particles of `oil` have become uneven").map(str::to_owned)
    };
    let relaxed = "Relaxed(seed: 1, iterations: 30)";
    let text = channel(relaxed, 0.02).expect("a warning");
    assert!(text.contains("particle_shifting()"), "{text}");
    assert_eq!(channel("Square", 0.1), None);
}

/// A disc, four particles in radius, that sinks in oil, with what the run says of the oil until 5 s.
fn disc(pressure: &str, end: f64) -> Vec<String> {
    let mut sim = simulation(&format!(
        r#"(dimension: Two, gravity: (0.0, -0.1),
            materials: {{"oil": Fluid(density: 1000.0, sound_speed: 6.0, viscosity: 10.0), "steel": NeoHookean(density: 4500.0, young: 1e7, poisson: 0.3)}},
            bodies: [
                (name: "oil", material: "oil", shape: Difference(Box(min: (0, 0), max: (0.4, 0.6)), Sphere(center: (0.2, 0.4), radius: 0.08)),
                 spacing: 0.02, lattice: Regular, formulation: Fluid({pressure})),
                (name: "disc", material: "steel", shape: Sphere(center: (0.2, 0.4), radius: 0.08), spacing: 0.02, lattice: Regular, formulation: Rigid()),
                (name: "tank", material: "wall", spacing: 0.02, formulation: Wall(slip: No, suction: true),
                 shape: Difference(Box(min: (-0.06, -0.06), max: (0.46, 0.66)), Box(min: (0, 0), max: (0.4, 0.6)))),
            ],
            time: (end: {end}))"#
    ));
    sim.run(|_| true).expect("a run");
    sim.warnings().iter().filter(|warning| warning.contains("particles of `oil`")).cloned().collect()
}

#[test]
fn particles_that_become_uneven_beside_a_small_body_are_warned_of() {
    // The root mean square over all of them never exceeds half of what is worth a warning.
    let warnings = disc("", 5.0);
    assert!(warnings.iter().any(|warning| warning.contains("have become uneven")), "{warnings:?}");
}

#[test]
fn a_pressure_that_makes_a_solid_of_particles_in_order_is_warned_of() {
    // 1000 Pa more than at rest slow the disc down from 12 to 2 mm/s; the particles are as even as can be.
    let warnings = disc("pressure: \"1000.0 + 100.0*(0.6 - y)\"", 1.5);
    assert!(warnings.len() == 1 && warnings[0].contains("resist as a solid does"), "{warnings:?}");
}

#[test]
fn lattices_that_do_not_fit_at_the_start_are_warned_of() {
    let float = |bottom: f64, lattice: &str| {
        let mut sim = simulation(&format!(
            r#"(dimension: Two, gravity: (0.0, -9.81), materials: {{"water": Fluid(density: 1000.0, sound_speed: 20.0), "wood": NeoHookean(density: 500.0, young: 1e7, poisson: 0.3)}},
                bodies: [
                    (name: "water", material: "water", shape: Difference(Box(min: (0, 0), max: (0.6, 0.2)), Box(min: (0.2, {bottom}), max: (0.4, 0.3))),
                     spacing: 0.02, {lattice} formulation: Fluid),
                    (name: "box", material: "wood", shape: Box(min: (0.2, {bottom}), max: (0.4, 0.24)), spacing: 0.02, formulation: Rigid()),
                    (name: "tank", material: "wall", spacing: 0.02, formulation: Wall(),
                     shape: Difference(Box(min: (-0.06, -0.06), max: (0.66, 0.4)), Box(min: (0, 0), max: (0.6, 1)))),
                ],
                time: (end: 1.0))"#
        ));
        sim.run(|sim| sim.clock().step < 2).expect("a run");
        sim.warnings().iter().filter(|warning| warning.contains("do not fit")).cloned().collect::<Vec<_>>()
    };
    // The lattice of the water has lines at multiples of 0.02 m.
    let warnings = float(0.151, "lattice: Regular,");
    assert!(warnings.len() == 1 && warnings[0].contains("`water` and `box`"), "{warnings:?}");
    let even = ["", "lattice: Relaxed(seed: 1, iterations: 30),"].map(|lattice| float(0.151, lattice));
    assert!(even.concat().is_empty() && float(0.16, "lattice: Regular,").is_empty(), "{even:?}");
}

#[test]
fn a_fluid_that_starts_across_a_gap_from_its_floor_is_warned_of() {
    let above = |bottom: f64| {
        let scene = tank("", "", "time: (end: 1.0)").replace(
            "Box(min: (0, 0), max: (0.6, 0.2))",
            &format!("Box(min: (0, {bottom}), max: (0.6, {}))", bottom + 0.2),
        );
        let mut sim = simulation(&scene);
        sim.run(|sim| sim.clock().step < 2).expect("a run");
        warning(&sim, "`water` starts apart from `tank`").map(str::to_owned)
    };
    // Spacings of 0.02 m: the lowest row of 30 stands across .65 and 1.3 of them, less those in the corners
    // that are nearer to the sides.
    for (bottom, found) in [
        (0.013, "28 of its particles face it across 0.65 spacings"),
        (0.026, "26 of its particles face it across 1.30 spacings"),
    ] {
        let text = above(bottom).expect("a warning");
        assert!(text.contains(found), "{text}");
    }
    assert_eq!(above(0.0), None);
    // It is to fall.
    assert_eq!(above(0.08), None);
}

#[test]
fn walls_have_no_initial_velocity() {
    let more = r#"conditions: [InitialVelocity(on: Select(), value: (0.1, 0.0))], time: (end: 0.01)"#;
    let mut sim = simulation(&tank("", "", more));
    sim.run(|_| true).expect("a run");
    let moves = |body| super::column::<crate::world::Velocity>(&sim, body).iter().any(|v| v.0.x != 0.0);
    assert!(moves(0) && !moves(1));
    let fault = fault(&tank("", "", &more.replace("Select()", "Select(body: \"tank\")")));
    assert!(fault.contains("a wall has no initial velocity"), "{fault}");
}

#[test]
fn a_wall_with_a_thin_baffle_is_warned_of() {
    let tank = |baffle: &str| {
        simulation(&format!(
            r#"(dimension: Two, gravity: (0, -9.81), materials: {{"water": Fluid(density: 1000.0, sound_speed: 20.0)}},
                bodies: [
                    (name: "water", material: "water", shape: Box(min: (0, 0), max: (0.4, 0.2)), spacing: 0.02, formulation: Fluid),
                    (name: "tank", material: "water", spacing: 0.02, formulation: Wall(slip: Free), shape: Union([
                        Difference(Box(min: (-0.08, -0.08), max: (1.08, 0.4)), Box(min: (0, 0), max: (1, 0.5))),
                        Box(min: (0.48, 0), max: ({baffle}, 0.2))])),
                ],
                time: (end: 0.01))"#
        ))
    };
    let seen = |baffle: &str| warning(&tank(baffle), "thinner than the kernel support").is_some();
    assert!(seen("0.52"), "two layers");
    assert!(!seen("0.56"), "four layers");
}

#[test]
fn a_fluid_that_falls_through_a_half_space_is_warned_of() {
    let pool = |floor: &str| {
        let text = format!(
            r#"(dimension: Two, gravity: (0.0, -9.81), materials: {{"water": Fluid(density: 1000.0, sound_speed: 20.0), "stone": NeoHookean(density: 2000.0, young: 1.0e6, poisson: 0.3)}},
                bodies: [
                    (name: "water", material: "water", shape: Box(min: (0, 0), max: (0.2, 0.2)), spacing: 0.02, formulation: Fluid()),
                    (name: "floor", material: "stone", shape: {floor}, spacing: 0.02, formulation: Rigid()),
                ],
                conditions: [Fix(on: Select(body: "floor"))], time: (end: 0.1))"#
        );
        let mut sim = simulation(&text);
        sim.run(|_| true).expect("a run");
        warning(&sim, "fluids do not see a half-space").map(str::to_owned)
    };
    let text = pool("HalfSpace(point: (0, 0), normal: (0, 1))").expect("a warning");
    assert!(text.contains("`water` falls into `floor`"), "{text}");
    // Free fall by a whole spacing, from half of it above to half of it below, takes 64 ms; the weight of the
    // water above presses the corners out a little before.
    let time = text.split(" and ").nth(1).and_then(|rest| rest.split(' ').next()).expect("a time");
    let time: f64 = time.parse().expect("a time");
    assert!((50.0..70.0).contains(&time), "{text}");
    assert_eq!(pool("Box(min: (-0.5, -0.1), max: (0.7, 0.0))"), None);
}

#[test]
fn a_light_body_that_water_holds_down_is_warned_of() {
    let ball = |bottom: f64, density: f64| {
        let center = bottom + 0.06;
        let block = format!(
            r#"(name: "block", material: "cork", shape: Sphere(center: (0.3, {center:?}), radius: 0.06), spacing: 0.02, lattice: Concentric, formulation: Rigid()),"#
        );
        let hole = format!(
            "Difference(Box(min: (0, 0), max: (0.6, 0.3)), Sphere(center: (0.3, {center:?}), radius: 0.06))"
        );
        let contact = r#"contacts: [(between: ("block", "tank"), restitution: 0.2, law: Penalty(factor: 0.1))], time: (end: 0.3)"#;
        let cork =
            format!(r#""cork": NeoHookean(density: {density:?}, young: 1.0e6, poisson: 0.3), "block""#);
        let text = tank("", &block, contact)
            .replace("Box(min: (0, 0), max: (0.6, 0.2))", &hole)
            .replace(
                "formulation: Fluid()",
                "lattice: Relaxed(seed: 1, iterations: 30), formulation: Fluid()",
            )
            .replace("sound_speed: 20.0", "sound_speed: 20.0, viscosity: 1.0")
            .replacen(r#""block": Neo"#, &format!("{cork}: Neo"), 1);
        let mut sim = simulation(&text);
        sim.run(|_| true).expect("a run");
        let rose =
            sim.resources().get::<RigidBodies>().iter().next().expect("a body").state.center.y - center;
        (warning(&sim, "lighter than the fluid").is_some(), rose)
    };
    // On the floor no particle of the water fits below it, and it has the pressure of the gap.
    let (told, rose) = ball(0.0, 500.0);
    assert!(!told && rose > 0.03, "{rose}");
    // With water below it comes up; a heavy one stays below with good reason.
    let (told, rose) = ball(0.06, 500.0);
    assert!(!told && rose > 0.03, "{rose}");
    assert!(!ball(0.0, 2000.0).0);
}

#[test]
fn a_body_between_the_densities_of_two_fluids_floats_on_the_denser_one() {
    let oil = r#"(name: "oil", material: "oil", shape: Box(min: (0, 0.2), max: (0.6, 0.3)), spacing: 0.02, formulation: Fluid()),
        (name: "block", material: "wood", shape: Box(min: (0.2, 0.36), max: (0.4, 0.44)), spacing: 0.02, formulation: Rigid()),"#;
    let told = |density: f64| {
        let text = tank("", oil, "time: (end: 1.0)").replacen(
            r#""block": Neo"#,
            &format!(r#""oil": Fluid(density: 700.0, sound_speed: 20.0), "wood": NeoHookean(density: {density:?}, young: 1.0e6, poisson: 0.3), "block": Neo"#),
            1,
        );
        warning(&simulation(&text), "no contact holds it off a wall").is_some()
    };
    assert!(!told(850.0) && told(1100.0));
}

#[test]
fn rows_at_the_interface_of_two_liquids_are_warned_of_and_other_pairs_are_not() {
    let scene = |support: &str, oil: f64, gravity: f64| {
        format!(
            r#"(dimension: Two, gravity: (0.0, {gravity}), domain: (min: (0, -1), max: (0.4, 1), periodic: [X]),
                materials: {{"water": Fluid(density: 1000.0, sound_speed: 20.0), "oil": Fluid(density: {oil}, sound_speed: 20.0)}},
                bodies: [
                    (name: "water", material: "water", shape: Box(min: (0, 0), max: (0.4, 0.2)), spacing: 0.02, formulation: Fluid({support})),
                    (name: "oil", material: "oil", shape: Box(min: (0, 0.2), max: (0.4, 0.4)), spacing: 0.02, formulation: Fluid({support})),
                    (name: "floor", material: "wall", shape: Box(min: (0, -0.08), max: (0.4, 0)), spacing: 0.02, formulation: Wall()),
                ],
                time: (end: 0.1))"#
        )
    };
    let is_told =
        |text: &str| warning(&simulation(text), "waves on the interface of `water` and `oil`").is_some();
    assert!(is_told(&scene("", 800.0, -9.81)));
    assert!(!is_told(&scene("support: 3.3", 800.0, -9.81)));
    assert!(!is_told(&scene("", 1000.0, -9.81)));
    assert!(!is_told(&scene("", 800.0, 0.0)));
}

#[test]
fn a_turning_fluid_without_friction_is_warned_of_and_one_with_friction_is_not() {
    let run = |viscosity: f64| {
        let mut sim = simulation(&format!(
            r#"(dimension: Two, materials: {{"fluid": Fluid(density: 1.0, sound_speed: 10.0, viscosity: {viscosity})}},
                bodies: [(name: "patch", material: "fluid", shape: Sphere(center: (0, 0), radius: 0.5), spacing: 0.05, formulation: Fluid(pressure: "(x^2 + y^2)/2 - 0.125"))],
                conditions: [InitialVelocity(on: Select(body: "patch"), value: ("y", "-x"))], record: (every: 0.02), time: (end: 0.1))"#
        ));
        sim.run(|_| true).expect("a run");
        sim
    };
    // 0 and a fifth of 1e-4 c_0 h, below which friction takes less than everything else; ten times as much.
    for viscosity in [0.0, 1.5e-5] {
        let sim = run(viscosity);
        assert!(warning(&sim, "`patch` has been in tension since").is_some(), "{:?}", sim.warnings());
    }
    let sim = run(1e-3);
    assert!(warning(&sim, "in tension").is_none(), "{:?}", sim.warnings());
}

#[test]
fn sound_about_zero_pressure_in_a_closed_tube_is_warned_of_and_about_a_pressure_is_not() {
    // The lowest mode of a closed tube, half of whose time every half of it is in tension.
    let told = |pressure: f64| {
        let mut sim = simulation(&format!(
            r#"(dimension: Two, domain: (min: (-0.5, 0), max: (1.5, 0.2), periodic: [Y]),
                materials: {{"liquid": Fluid(density: 1000.0, sound_speed: 10.0)}},
                bodies: [
                    (name: "liquid", material: "liquid", shape: Box(min: (0, 0), max: (1, 0.2)), spacing: 0.025, formulation: Fluid(pressure: {pressure:?})),
                    (name: "ends", material: "wall", spacing: 0.025, formulation: Wall(suction: true),
                     shape: Union([Box(min: (-0.1, 0), max: (0, 0.2)), Box(min: (1, 0), max: (1.1, 0.2))])),
                ],
                conditions: [InitialVelocity(on: Select(body: "liquid"), value: ("0.02*sin(pi*x)", 0.0))], record: (every: 0.06), time: (end: 0.8))"#
        ));
        sim.run(|_| true).expect("a run");
        warning(&sim, "has been in tension").is_some()
    };
    assert!(told(0.0));
    assert!(!told(600.0));
}
