//! Conditions against closed forms, in small scenes.

use glam::DVec3;

use crate::assembly::build;
use crate::plugin::Registry;
use crate::scene::{Source, parse};
use crate::simulation::{Checkpoint, Simulation};
use crate::world::{BodyId, Column, Mass, Position, ReferencePosition, Velocity};

/// A simulation of a scene text.
pub(super) fn simulation(text: &str) -> Simulation {
    let mut registry = Registry::standard();
    registry.plugin::<super::image_tests::Stiffener>();
    let built =
        parse(Source::new("test.ron", text)).and_then(|(scene, source)| build(&scene, &source, &registry));
    match built {
        Ok(simulation) => simulation,
        Err(error) => panic!("{error}"),
    }
}

/// A two-dimensional scene of one block of 1 m x 0.5 m, E = 1e6 Pa, density 1000 kg/m3, with the given
/// conditions.
fn block(conditions: &str, rest: &str) -> String {
    format!(
        "Scene(dimension: Two,
        materials: {{\"rubber\": StVenantKirchhoff(density: 1000.0, young: 1.0e6, poisson: 0.3)}},
        bodies: [Body(name: \"block\", material: \"rubber\", shape: Box(min: (0.0, 0.0), max: (1.0, 0.5)),
            spacing: 0.0625, formulation: TotalLagrangian)],
        conditions: [{conditions}], {rest})"
    )
}

fn column<C: Column + Copy>(simulation: &Simulation) -> Vec<C> {
    let (view, rows) = simulation.world().body_view(BodyId(0));
    view.read::<C>().expect("a column")[rows].to_vec()
}

fn account(simulation: &Simulation, name: &str) -> f64 {
    let accounts = simulation.ledger().accounts();
    accounts.iter().find(|account| account.name == name).map_or(0.0, |account| account.total())
}

fn finish(simulation: &mut Simulation) {
    simulation.run(|_| true).expect("the run ends");
}

fn assert_close(found: f64, wanted: f64, tolerance: f64) {
    assert!((found - wanted).abs() <= tolerance, "{found:e} instead of {wanted:e}");
}

#[test]
fn a_body_in_free_fall_follows_the_parabola() {
    let text =
        block("InitialVelocity(on: Select(), value: (3.0, 1.0))", "gravity: (0.0, -9.81), time: (end: 0.1)");
    let mut sim = simulation(&text);
    finish(&mut sim);
    let t = 0.1;
    let moved = DVec3::new(3.0 * t, 1.0 * t - 0.5 * 9.81 * t * t, 0.0);
    for (x, reference) in column::<Position>(&sim).iter().zip(column::<ReferencePosition>(&sim)) {
        assert!((x.0 - reference.0).distance(moved) < 1e-12, "{}", x.0 - reference.0);
    }
    assert!(sim.ledger().relative_error().abs() < 1e-12);
}

/// Two faces share a corner: what holds both is an error only where the values differ.
#[test]
fn conditions_that_agree_may_share_particles() {
    let pair = |one: &str, other: &str| block(&format!("{one}, {other}"), "time: (end: 0.001)");
    let (bottom, left) = ("Select(face: MinY)", "Select(face: MinX)");
    let fixed = |on: &str| format!("Fix(on: {on}, axes: [X])");
    let moved = |name: &str, on: &str, value: &str| format!("{name}(on: {on}, value: (\"{value}\", None))");
    for text in [
        pair(&fixed(bottom), &fixed(left)),
        pair(&format!("Fix(on: {bottom})"), &moved("Velocity", left, "0*t")),
        pair(&fixed(bottom), &moved("Displacement", left, "0.1*t*y*0")),
        pair(
            &moved("Velocity", bottom, "0.1*sin(50*t)*(x + y)"),
            &moved("Velocity", left, "0.1*(y + x)*sin(50*t)"),
        ),
    ] {
        let mut sim = simulation(&text);
        finish(&mut sim);
        assert!(sim.ledger().relative_error().abs() < 1e-3, "{text}");
    }
    for text in [
        pair(&fixed(bottom), &moved("Velocity", left, "0.1*t")),
        pair(&moved("Velocity", bottom, "0.1*t"), &moved("Displacement", left, "0.05*t^2")),
        pair(&moved("Displacement", bottom, "0.1*t"), &moved("Displacement", left, "0.2*t")),
    ] {
        let (scene, source) = parse(Source::new("test.ron", &text)).expect("a scene");
        let Err(error) = build(&scene, &source, &Registry::standard()) else { panic!("{text}") };
        assert!(error.to_string().contains("and differ"), "{error}");
    }
}

#[test]
fn a_body_force_on_all_of_a_body_accelerates_it_uniformly() {
    let text =
        block("BodyForce(on: Select(), value: (\"20*t\", -4.0))", "time: (end: 0.1, step: Fixed(1.0e-4))");
    let mut sim = simulation(&text);
    finish(&mut sim);
    let t: f64 = 0.1;
    // The leapfrog sums 20 t by the trapezoidal rule for v, and its drift is exact for x up to 20 t dt^2 / 6.
    let v = DVec3::new(10.0 * t * t, -4.0 * t, 0.0);
    let x = DVec3::new(20.0 * t.powi(3) / 6.0, -2.0 * t * t, 0.0);
    let places = column::<Position>(&sim);
    let velocities = column::<Velocity>(&sim);
    for (k, reference) in column::<ReferencePosition>(&sim).iter().enumerate() {
        assert!(velocities[k].0.distance(v) < 1e-12, "{}", velocities[k].0);
        assert!((places[k].0 - reference.0).distance(x) < 1e-8, "{}", places[k].0 - reference.0);
    }
    let mass = 500.0;
    // The kinetic energy of the leapfrog differs from the work by m (dt a)^2 / 8.
    let kinetic = 0.5 * mass * v.length_squared();
    assert_close(account(&sim, "body_force"), kinetic, 1e-7 * kinetic);
    assert!(sim.ledger().relative_error().abs() < 1e-7);
}

#[test]
fn a_prescribed_sine_is_met_in_every_step_and_its_work_is_booked() {
    let text = block(
        "Displacement(on: Select(), value: (\"0.01*sin(40*t)*(1 + x)\", 0.0))",
        "time: (end: 0.05, step: Fixed(1.0e-4))",
    );
    let mut sim = simulation(&text);
    sim.start().expect("a start");
    let masses = column::<Mass>(&sim);
    let references = column::<ReferencePosition>(&sim);
    let kinetic = |t: f64| {
        let v = |x: f64| 0.4 * (40.0 * t).cos() * (1.0 + x);
        masses.iter().zip(&references).map(|(m, x)| 0.5 * m.0 * v(x.0.x).powi(2)).sum::<f64>()
    };
    assert_close(account(&sim, "kinetic"), kinetic(0.0), 1e-6 * kinetic(0.0));
    let mut worst: f64 = 0.0;
    while !sim.is_finished() {
        sim.step().expect("a step");
        let t = sim.clock().time;
        for (k, x) in column::<Position>(&sim).iter().enumerate() {
            let wanted = 0.01 * (40.0 * t).sin() * (1.0 + references[k].0.x);
            worst = worst.max((x.0 - references[k].0 - DVec3::X * wanted).length());
        }
        assert_close(account(&sim, "kinetic"), kinetic(t), 1e-5 * kinetic(0.0));
    }
    assert!(worst < 1e-15, "{worst}");
    let strain = account(&sim, "strain");
    // F_xx = 1 + 0.01 sin(40 t), uniaxial strain: W = (lambda / 2 + mu) E_xx^2.
    let f = 1.0 + 0.01 * (40.0_f64 * 0.05).sin();
    let green = 0.5 * (f * f - 1.0);
    let (lambda, mu) = (1e6 * 0.3 / (1.3 * 0.4), 1e6 / 2.6);
    assert_close(strain, 0.5 * (0.5 * lambda + mu) * green * green, 1e-9 * strain);
    let balance = sim.ledger().relative_error();
    assert!(balance.abs() < 1e-5, "{balance}");
}

#[test]
fn a_prescribed_velocity_is_integrated_at_mid_step_and_leaves_other_axes_free() {
    let text = block(
        "Velocity(on: Select(), value: (\"2*smoothstep(t/0.02)\", None))",
        "gravity: (0.0, -10.0), time: (end: 0.02, step: Fixed(1.0e-4))",
    );
    let mut sim = simulation(&text);
    finish(&mut sim);
    let velocities = column::<Velocity>(&sim);
    for (k, reference) in column::<ReferencePosition>(&sim).iter().enumerate() {
        let moved = column::<Position>(&sim)[k].0 - reference.0;
        // The integral of smoothstep over the ramp is half its length.
        assert_close(moved.x, 0.02, 1e-6);
        assert_close(moved.y, -0.5 * 10.0 * 0.02_f64.powi(2), 1e-12);
        assert_close(velocities[k].0.x, 2.0, 1e-12);
    }
    assert_close(account(&sim, "constraints"), 0.5 * 500.0 * 4.0, 1e-9);
    assert!(sim.ledger().relative_error().abs() < 1e-12);
}

#[test]
fn the_work_of_a_dead_load_is_force_times_displacement() {
    let text = block(
        "Fix(on: Select(face: MinX)), Force(on: Select(face: MaxX), value: (2.0e4, 1.0e3))",
        "time: (end: 0.05, step: Adaptive(factor: 0.2))",
    );
    let mut sim = simulation(&text);
    finish(&mut sim);
    let loaded: Vec<DVec3> = column::<Position>(&sim)
        .iter()
        .zip(column::<ReferencePosition>(&sim))
        .filter(|(_, reference)| reference.0.x > 1.0 - 0.0625)
        .map(|(x, reference)| x.0 - reference.0)
        .collect();
    assert_eq!(loaded.len(), 8);
    let mean = loaded.iter().sum::<DVec3>() / 8.0;
    let work = DVec3::new(2.0e4, 1.0e3, 0.0).dot(mean);
    assert!(work > 1.0, "the load must do work: {work}");
    assert_close(account(&sim, "force"), work, 1e-11 * work);
    let balance = sim.ledger().relative_error();
    assert!(balance.abs() < 1e-3, "{balance}");
}

#[test]
fn the_balance_closes_with_the_square_of_the_step() {
    let error = |factor: f64| {
        let text = block(
            "Fix(on: Select(face: MinX)), Traction(on: Select(face: MaxX), value: (\"4.0e4*sin(300*t)\", 0.0)),
             Pressure(on: Select(face: MaxY), value: \"2.0e4*smoothstep(t/0.01)\")",
            &format!("time: (end: 0.02, step: Fixed({}))", factor * 1.0e-4),
        );
        let mut sim = simulation(&text);
        finish(&mut sim);
        sim.ledger().relative_error().abs()
    };
    let (coarse, fine, finest) = (error(1.0), error(0.25), error(0.0625));
    assert!(fine < coarse / 10.0 && finest < fine / 10.0, "{coarse:e} {fine:e} {finest:e}");
    assert!(finest < 1e-6, "{finest:e}");
}

#[test]
fn a_traction_has_the_area_of_the_face_on_any_lattice() {
    for lattice in ["Regular", "Hexagonal", "Relaxed(seed: 3)"] {
        let text = format!(
            "Scene(dimension: Two,
            materials: {{\"rubber\": StVenantKirchhoff(density: 1000.0, young: 1.0e6, poisson: 0.3)}},
            bodies: [Body(name: \"block\", material: \"rubber\", shape: Box(min: (0.0, 0.0), max: (1.0, 0.5)),
                spacing: 0.05, lattice: {lattice}, formulation: TotalLagrangian)],
            conditions: [Traction(on: Select(face: MinY), value: (0.0, 3.0e3))],
            time: (end: 1.0e-4, step: Fixed(1.0e-5)))"
        );
        let mut sim = simulation(&text);
        finish(&mut sim);
        let momentum: f64 =
            column::<Velocity>(&sim).iter().zip(column::<Mass>(&sim)).map(|(v, m)| m.0 * v.0.y).sum();
        let area = momentum / (3.0e3 * 1.0e-4);
        assert!((area - 1.0).abs() < 1e-9, "{lattice}: {area}");
    }
}

#[test]
fn a_restart_with_loads_and_prescribed_motion_continues_bit_for_bit() {
    let text = block(
        "Displacement(on: Select(face: MinX), value: (\"0.01*sin(200*t)\", 0.0)),
         Displacement(on: Select(face: MaxX), value: (None, \"0.01*sin(100*t)\")),
         Traction(on: Select(face: MaxX), value: (\"1.0e4*sin(300*t)\", None)),
         Traction(on: Select(face: MinY), value: (\"1.0e3*t\", None)),
         Pressure(on: Select(face: MaxY), value: \"2.0e4*t\"), Pressure(on: Select(face: MaxX), value: 5.0e3)",
        "time: (end: 0.01, step: Fixed(2.5e-4))",
    );
    let mut whole = simulation(&text);
    let mut first = simulation(&text);
    for _ in 0..17 {
        whole.step().expect("a step");
        first.step().expect("a step");
    }
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("state");
    first.save(&path, &Source::new("test.ron", text.clone())).expect("a checkpoint");
    let mut second = simulation(&text);
    second.restore(&Checkpoint::read(&path).expect("a checkpoint")).expect("a restart");
    finish(&mut whole);
    finish(&mut second);
    assert_eq!(whole.state_hash(), second.state_hash());
    assert_eq!(whole.ledger(), second.ledger());
}

#[test]
fn a_pressure_on_a_confined_block_gives_the_uniaxial_strain_of_elasticity() {
    // Symmetry planes on both sides and below: uniaxial strain. Loaded smoothly over 20 transits.
    let text = block(
        "Symmetry(plane: X, at: 0.0), Symmetry(plane: X, at: 1.0), Symmetry(plane: Y, at: 0.0),
         Pressure(on: Select(face: MaxY), value: \"1.0e5*smoothstep(t/0.3)\")",
        "plugins: [stiffener()], time: (end: 0.35)",
    );
    let mut sim = simulation(&text);
    finish(&mut sim);
    let positions = column::<Position>(&sim);
    let references = column::<ReferencePosition>(&sim);
    // St Venant-Kirchhoff: the nominal stress F S = F (lambda + 2 mu) (F^2 - 1) / 2 is the pressure, J F^-T
    // N = N here.
    let modulus = 1e6 * 0.7 / (1.3 * 0.4);
    let mut stretch: f64 = 1.0;
    for _ in 0..50 {
        let value = 0.5 * modulus * stretch * (stretch * stretch - 1.0) + 1.0e5;
        stretch -= value / (0.5 * modulus * (3.0 * stretch * stretch - 1.0));
    }
    assert!(stretch < 0.94);
    for (x, reference) in positions.iter().zip(&references) {
        assert_close(x.0.x, reference.0.x, 1e-12);
        // Away from the loaded layer: half a spacing of it is not resolved.
        if reference.0.y < 0.3 {
            let found = x.0.y / reference.0.y;
            assert!(
                (found - stretch).abs() < 0.02 * (1.0 - stretch),
                "{found} instead of {stretch}, {reference:?}"
            );
        }
    }
    assert!(sim.ledger().relative_error().abs() < 1e-4);
}

#[test]
fn a_pressure_turns_with_the_body() {
    // A block that is turned by a quarter: the face that looked up looks to the left, and is pushed to the
    // right.
    let text = block(
        "Displacement(on: Select(), value: (\"(x*(cos(50*pi*t) - 1) - y*sin(50*pi*t))\",
             \"(x*sin(50*pi*t) + y*(cos(50*pi*t) - 1))\")),
         Pressure(on: Select(face: MaxY), value: 2.0e4)",
        "time: (end: 0.01, step: Fixed(1.0e-4))",
    );
    let mut sim = simulation(&text);
    finish(&mut sim);
    let total: DVec3 = column::<crate::world::Force>(&sim).iter().map(|force| force.0).sum();
    assert!(total.distance(DVec3::new(2.0e4, 0.0, 0.0)) < 1e-6, "{total}");
}

#[test]
fn an_initial_displacement_stretches_a_body_before_the_first_step() {
    let text = block(
        "InitialDisplacement(on: Select(body: \"block\"), value: (\"0.1*x\", \"-0.2*y\"))",
        "time: (end: 1.0e-9, step: Fixed(1.0e-9))",
    );
    let mut sim = simulation(&text);
    for (x, reference) in column::<Position>(&sim).iter().zip(column::<ReferencePosition>(&sim)) {
        assert_close(x.0.x, 1.1 * reference.0.x, 1e-15);
        assert_close(x.0.y, 0.8 * reference.0.y, 1e-15);
    }
    finish(&mut sim);
    // W = (lambda + 2 mu)/2 (Exx^2 + Eyy^2) + lambda Exx Eyy per area, over 0.5 m2.
    let (exx, eyy) = (0.5 * (1.21 - 1.0), 0.5 * (0.64 - 1.0));
    let (lambda, mu) = (1e6 * 0.3 / (1.3 * 0.4), 1e6 / 2.6);
    let energy = 0.5 * (0.5 * (lambda + 2.0 * mu) * (exx * exx + eyy * eyy) + lambda * exx * eyy);
    assert_close(account(&sim, "strain"), energy, 1e-6 * energy);
}

#[test]
fn a_load_on_a_side_that_is_not_flat_is_an_error() {
    let load = |shape: &str, face: &str| {
        let text = format!(
            r#"(dimension: Two, materials: {{"soft": NeoHookean(density: 1000, young: 1e6, poisson: 0.3)}},
                bodies: [(name: "body", material: "soft", shape: {shape}, spacing: 0.005, formulation: TotalLagrangian)],
                conditions: [Pressure(on: Select(body: "body", face: {face}), value: 100)],
                time: (end: 0.01))"#
        );
        let (scene, source) = parse(Source::new("load.ron", text)).unwrap();
        build(&scene, &source, &Registry::standard()).err().map(|error| error.to_string())
    };
    let error =
        load("Ring(center: (0, 0), inner: 0.05, outer: 0.1)", "MaxX").expect("a ring has no flat side");
    assert!(error.contains("no flat side"), "{error}");
    assert!(error.contains("surface: Outer"), "{error}");
    assert!(load("Polygon(points: [(0, 0), (0.1, 0.05), (0.1, 0.1), (0, 0.1)])", "MaxX").is_none());
    assert!(load("Polygon(points: [(0, 0), (0.1, 0.05), (0.1, 0.1), (0, 0.1)])", "MinY").is_some());
}

/// A point far from all particles is probably a slip; one on the surface is not.
#[test]
fn a_point_that_no_particle_is_near_is_noticed() {
    for (point, told) in [("(5, 0.25)", true), ("(1, 0.5)", false), ("(0.3, 0.2)", false)] {
        let sim = simulation(&block(
            &format!(r#"Force(on: Select(nearest: {point}), value: (1, 0))"#),
            "time: (end: 1e-4)",
        ));
        let is_told = sim.warnings().iter().any(|warning| warning.contains("from that point"));
        assert_eq!(is_told, told, "{point}: {:?}", sim.warnings());
    }
}
