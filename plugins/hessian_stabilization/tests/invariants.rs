//! Exact properties: affine maps, force as the gradient of the energy, momentum and angular momentum, in both
//! Lagrangian formulations, and after updates.

use std::error::Error;

use meshless_engine::assembly::build;
use meshless_engine::glam::{DMat3, DVec3};
use meshless_engine::invariants::{Momenta, Specimen};
use meshless_engine::plugin::Registry;
use meshless_engine::scene::{Source, parse};
use meshless_engine::simulation::{Checkpoint, Simulation};
use meshless_engine::world::{BodyId, Force, Position, Velocity};

const FORMS: [&str; 2] = ["FrameIndifferent", "Vidal2007"];
/// Of every step, unless a test says otherwise.
const ADAPTIVE: &str = "Adaptive()";
const FORMULATIONS: [&str; 2] = ["TotalLagrangian", "UpdatedLagrangian()"];

/// An irregular body, in two or three dimensions.
fn scene(dimension: usize, formulation: &str, form: &str, step: &str) -> Source {
    let (name, low, high) = if dimension == 2 {
        ("Two", "(0, 0)", "(1.0, 0.5)")
    } else {
        ("Three", "(0, 0, 0)", "(0.8, 0.5, 0.5)")
    };
    let text = format!(
        r#"(dimension: {name},
            materials: {{"m": NeoHookean(density: 1, young: 1, poisson: 0.3)}},
            bodies: [(name: "b", material: "m", shape: Box(min: {low}, max: {high}), spacing: 0.1, lattice: Relaxed(seed: 3, iterations: 2),
                      formulation: {formulation}, plugins: [hessian_stabilization(form: {form})])],
            time: (end: 100.0, step: {step}))"#
    );
    Source::new("test.ron", text)
}

fn simulation(source: &Source) -> Simulation {
    let (scene, source) = parse(source.clone()).unwrap_or_else(|error| panic!("{error}"));
    let registry = Registry::standard().with(hessian_stabilization::register);
    build(&scene, &source, &registry).unwrap_or_else(|error| panic!("{error}"))
}

fn read(sim: &Simulation) -> (Vec<DVec3>, Vec<DVec3>) {
    let (view, _) = sim.world().body_view(BodyId(0));
    let force = view.read::<Force>().expect("forces").iter().map(|f| f.0).collect();
    let place = view.read::<Position>().expect("places").iter().map(|x| x.0).collect();
    (force, place)
}

fn displace(sim: &Simulation, place: impl Fn(usize, DVec3) -> DVec3, velocity: impl Fn(DVec3) -> DVec3) {
    let (view, _) = sim.world().body_view(BodyId(0));
    let mut x = view.write::<Position>().expect("places");
    let mut v = view.write::<Velocity>().expect("velocities");
    for (k, (x, v)) in x.iter_mut().zip(v.iter_mut()).enumerate() {
        v.0 = velocity(x.0);
        x.0 = place(k, x.0);
    }
}

/// A rough displacement of the size of 0.4 % of the body, in the plane or in space.
fn rough(dimension: usize, x: DVec3) -> DVec3 {
    let phase = DVec3::new(31.0, 17.0, 23.0).dot(x);
    let bend = DVec3::new(phase.sin(), (1.7 * phase + 0.3).cos(), (2.3 * phase).sin()) * 0.004;
    x + if dimension == 2 { DVec3::new(bend.x, bend.y, 0.0) } else { bend }
}

fn energy(sim: &Simulation) -> f64 {
    sim.ledger().total_named("strain") + sim.ledger().total_named("hessian")
}

fn each(mut run: impl FnMut(usize, &str, &str)) {
    for dimension in [2, 3] {
        for formulation in FORMULATIONS {
            FORMS.into_iter().for_each(|form| run(dimension, formulation, form));
        }
    }
}

#[test]
fn an_affine_map_is_exact_and_holds_nothing() {
    each(|dimension, formulation, form| {
        let z = if dimension == 2 { DVec3::Z } else { DVec3::new(0.1, -0.1, 1.1) };
        let map = DMat3::from_cols(DVec3::new(1.2, 0.3, 0.0), DVec3::new(-0.2, 0.8, 0.0), z);
        let source = scene(dimension, formulation, &format!("{form}, eta: 0.7"), ADAPTIVE);
        let make = || -> Result<Simulation, Box<dyn Error>> { Ok(simulation(&source)) };
        let found = Specimen::new(&make).affine(map, DVec3::ZERO).expect("a start");
        let name = format!("{dimension} dimensions, {formulation}, {form}: {found:?}");
        assert!(found.gradient < 1e-10 && found.held < 1e-12, "{name}");
        assert!(found.net.force < 1e-10 && found.net.torque < 1e-10, "{name}");
    });
}

#[test]
fn the_force_is_the_gradient_of_the_energy_without_net_force_and_torque() {
    each(|dimension, formulation, form| {
        let source = scene(dimension, formulation, &format!("{form}, eta: 0.7"), ADAPTIVE);
        let make = || -> Result<Simulation, Box<dyn Error>> { Ok(simulation(&source)) };
        let found = Specimen::new(&make).slope().expect("a start");
        let name = format!("{dimension} dimensions, {formulation}, {form}: {found:?}");
        assert!(found.net.force < 1e-10 && found.net.torque < 1e-10, "{name}");
        assert!(found.error < 1e-6, "{name}");
    });
}

fn check_balance(force: &[DVec3], x: &[DVec3], name: &str) {
    let size: f64 = force.iter().map(|f| f.length()).sum();
    let net: DVec3 = force.iter().sum();
    let torque: DVec3 = force.iter().zip(x).map(|(f, x)| x.cross(*f)).sum();
    assert!(size > 0.0 && net.length() < 1e-10 * size, "{name}: net force {net} of {size}");
    assert!(torque.length() < 1e-10 * size, "{name}: torque {torque} of {size}");
}

/// A body that swings wildly, with an update of its reference after ten steps.
fn swinging(dimension: usize, form: &str, step: &str) -> Source {
    scene(dimension, "UpdatedLagrangian(update: Every(10))", &format!("{form}, eta: 0.7"), step)
}

#[test]
fn after_an_update_the_force_is_still_the_gradient_of_the_energy() {
    for (dimension, form) in [2, 3].into_iter().flat_map(|dimension| FORMS.map(|form| (dimension, form))) {
        let name = format!("{dimension} dimensions, {form}");
        let source = swinging(dimension, form, ADAPTIVE);
        let mut sim = simulation(&source);
        let velocity = |x: DVec3| DVec3::new(0.1 * (9.0 * x.y).sin(), 0.2 * x.x, 0.0);
        displace(&sim, |_, x| rough(dimension, x), velocity);
        sim.run(|sim| sim.clock().step < 14).expect("a run");
        let folder = tempfile::tempdir().expect("a temporary folder");
        let path = folder.path().join("state.mlc");
        sim.save(&path, &source).expect("a checkpoint");
        let checkpoint = Checkpoint::read(&path).expect("a checkpoint");
        // The state with one particle off its place, after a step of nearly no length.
        let at = |row: usize, axis: usize, by: f64| {
            let mut sim = simulation(&swinging(dimension, form, "Fixed(1e-15)"));
            sim.restore(&checkpoint).expect("a restart");
            let (view, _) = sim.world().body_view(BodyId(0));
            view.write::<Position>().expect("places")[row].0[axis] += by;
            sim.step().expect("a step");
            sim
        };
        let (force, x) = read(&at(0, 0, 0.0));
        check_balance(&force, &x, &name);
        let scale = force.iter().map(|f| f.length()).fold(0.0, f64::max);
        for row in [0, force.len() / 2] {
            for axis in 0..dimension {
                let energy = |by: f64| energy(&at(row, axis, by));
                let h = 1e-4;
                let slope =
                    (8.0 * (energy(h) - energy(-h)) - (energy(2.0 * h) - energy(-2.0 * h))) / (12.0 * h);
                let found = force[row][axis];
                assert!((found + slope).abs() < 1e-6 * scale, "{name}: {found} and slope {slope}");
            }
        }
    }
}

#[test]
fn a_thrown_body_keeps_its_momenta_and_its_energy_through_updates() {
    for form in FORMS {
        for formulation in ["TotalLagrangian", "UpdatedLagrangian(update: Every(10))"] {
            let mut sim = simulation(&scene(2, formulation, form, ADAPTIVE));
            displace(
                &sim,
                |_, x| x,
                |x| DVec3::new(0.1 - 0.1 * x.y + 0.03 * (3.0 * x.x).cos(), 0.1 * x.x, 0.0),
            );
            sim.start().expect("a start");
            let start = Momenta::of(&sim).expect("momenta");
            sim.run(|sim| sim.clock().step < 1500).expect("a run");
            let now = Momenta::of(&sim).expect("momenta");
            let name = format!("{form}, {formulation}: {start:?} -> {now:?}");
            assert!((now.linear - start.linear).length() < 1e-12 * start.linear.length(), "{name}");
            assert!((now.angular - start.angular).length() < 1e-10 * start.angular.length(), "{name}");
            let share = sim.ledger().balance_error() / sim.ledger().total_named("kinetic");
            assert!(share.abs() < 2e-3, "{name}: balance {share}");
        }
    }
}

#[test]
fn a_turned_body_swings_the_same_but_for_the_form_of_the_paper() {
    // Energy of one and the same saw-tooth across a square lattice, along one diagonal and along the other.
    let energy_along = |form: &str, sign: f64| {
        let text = format!(
            r#"(dimension: Two, materials: {{"m": NeoHookean(density: 1, young: 1, poisson: 0.3)}},
                bodies: [(name: "b", material: "m", shape: Box(min: (0, 0), max: (1.2, 1.2)), spacing: 0.1,
                          formulation: TotalLagrangian, plugins: [hessian_stabilization(form: {form})])],
                time: (end: 100.0))"#
        );
        let mut sim = simulation(&Source::new("test.ron", text));
        let wave = |x: DVec3| (30.0 * ((x.x - 0.6) + sign * (x.y - 0.6))).sin() * 1e-3;
        displace(&sim, |_, x| x + DVec3::new(1.0, sign, 0.0) * wave(x), |_| DVec3::ZERO);
        sim.start().expect("a start");
        energy(&sim)
    };
    let ratio = |form: &str| energy_along(form, -1.0) / energy_along(form, 1.0);
    assert!((ratio("FrameIndifferent") - 1.0).abs() < 1e-6, "{}", ratio("FrameIndifferent"));
    assert!(ratio("Vidal2007") < 0.9, "{}", ratio("Vidal2007"));
}

#[test]
fn what_is_wrong_is_an_error_that_points() {
    let error = |formulation: &str, plugin: &str, material: &str| {
        let text = format!(
            r#"(dimension: Two, materials: {{"m": {material}}},
                bodies: [(name: "b", material: "m", shape: Box(min: (0, 0), max: (1.2, 1.2)), spacing: 0.1,
                          formulation: {formulation}, plugins: [hessian_stabilization({plugin})])],
                time: (end: 100.0))"#
        );
        let registry = Registry::standard().with(hessian_stabilization::register);
        let read = parse(Source::new("test.ron", text));
        let built = read.and_then(|(scene, source)| build(&scene, &source, &registry).map(|_| ()));
        built.expect_err("an error").to_string()
    };
    let solid = "NeoHookean(density: 1, young: 1, poisson: 0.3)";
    let water = "Fluid(density: 1000, sound_speed: 20)";
    let negative = error("TotalLagrangian", "eta: -0.1", solid);
    assert!(negative.contains("`eta` must not be negative, found -0.1"), "{negative}");
    assert!(error("TotalLagrangian", "eta: 7", solid).contains("at most 5"));
    let form = error("TotalLagrangian", "form: Vidal", solid);
    assert!(form.contains("Vidal2007"), "{form}");
    let fluid = error("Fluid", "", water);
    assert!(fluid.contains("stabilization by differences of second derivatives"), "{fluid}");
}
