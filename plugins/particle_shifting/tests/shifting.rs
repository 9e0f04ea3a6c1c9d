//! Even particles stay, uneven ones become even, off is as if it were not there.

use meshless_engine::glam::DVec3;
use meshless_engine::plugin::{Registry, build};
use meshless_engine::scene::{Source, parse};
use meshless_engine::simulation::Simulation;
use meshless_engine::world::{BodyId, Column, Position};

fn simulation(plugins: &str, lattice: &str, velocity: &str) -> Simulation {
    let text = format!(
        r#"(dimension: Two, domain: (min: (0, 0), max: (1, 1), periodic: [X, Y]),
            materials: {{"m": Fluid(density: 1.0, sound_speed: 10.0, viscosity: 0.01)}},
            bodies: [(name: "b", material: "m", shape: Box(min: (0, 0), max: (1, 1)), spacing: 0.05, lattice: {lattice},
                      formulation: Fluid(pressure: "-0.2"), plugins: [{plugins}])],
            conditions: [InitialVelocity(on: Select(), value: {velocity})],
            time: (end: 1.0))"#
    );
    let (scene, source) = parse(Source::new("test.ron", text)).unwrap_or_else(|error| panic!("{error}"));
    let mut registry = Registry::standard();
    particle_shifting::register(&mut registry);
    build(&scene, &source, &registry).unwrap_or_else(|error| panic!("{error}"))
}

fn column<C: Column + Copy>(sim: &Simulation) -> Vec<C> {
    let (view, _) = sim.world().body_view(BodyId(0));
    view.read::<C>().expect("a column").to_vec()
}

const VORTICES: &str = r#"("-cos(2*pi*x)*sin(2*pi*y)", "sin(2*pi*x)*cos(2*pi*y)")"#;

/// Least distance of two particles over the spacing, across the sides of the box as well.
fn least_distance(sim: &Simulation) -> f64 {
    let x = column::<Position>(sim);
    let distance = |a: DVec3, b: DVec3| {
        let d = b - a;
        (d - d.round()).length()
    };
    let mut least = f64::INFINITY;
    for i in 0..x.len() {
        for j in 0..i {
            least = least.min(distance(x[i].0, x[j].0));
        }
    }
    least / 0.05
}

#[test]
fn a_lattice_is_not_moved() {
    let still = r#"("1", "0.5")"#;
    let run = |plugins: &str| {
        let mut sim = simulation(plugins, "Square", still);
        sim.run(|sim| sim.clock().step < 20).expect("a run");
        column::<Position>(&sim)
    };
    let (with, without) = (run("particle_shifting()"), run(""));
    let largest = with.iter().zip(&without).map(|(a, b)| a.0.distance(b.0)).fold(0.0, f64::max);
    assert!(largest < 1e-9, "{largest}");
}

#[test]
fn vortices_leave_the_particles_even() {
    let run = |plugins: &str| {
        let mut sim = simulation(plugins, "Square", VORTICES);
        sim.run(|sim| sim.clock().time < 0.4).expect("a run");
        assert!(sim.ledger().relative_error().abs() < 0.01, "{}", sim.ledger().relative_error());
        least_distance(&sim)
    };
    let (with, without) = (run("particle_shifting()"), run(""));
    assert!(with > 0.65 && with > without + 0.05, "{with} {without}");
}

#[test]
fn off_is_as_if_it_were_not_there() {
    let hash = |plugins: &str| {
        let mut sim = simulation(plugins, "Square", VORTICES);
        sim.run(|sim| sim.clock().step < 10).expect("a run");
        sim.state_hash()
    };
    assert_eq!(hash(""), hash("particle_shifting(strength: 0.0)"));
    assert_ne!(hash(""), hash("particle_shifting()"));
}
