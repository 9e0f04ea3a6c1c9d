//! The displacement against a naive second implementation, and off as if it were not there.

use meshless_engine::glam::DVec3;
use meshless_engine::kernels::{Kernel, KernelName};
use meshless_engine::plugin::{Registry, build};
use meshless_engine::scene::{Source, parse};
use meshless_engine::simulation::Simulation;
use meshless_engine::world::{BodyId, Column, Position};
use meshless_engine::world::{Density, Mass, Velocity};

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
    xsph::register(&mut registry);
    build(&scene, &source, &registry).unwrap_or_else(|error| panic!("{error}"))
}

fn column<C: Column + Copy>(sim: &Simulation) -> Vec<C> {
    let (view, _) = sim.world().body_view(BodyId(0));
    view.read::<C>().expect("a column").to_vec()
}

const VORTICES: &str = r#"("-cos(2*pi*x)*sin(2*pi*y)", "sin(2*pi*x)*cos(2*pi*y)")"#;

#[test]
fn particles_move_with_the_mean_velocity_around_them() {
    let run = |plugins: &str| {
        let mut sim = simulation(plugins, "Square", VORTICES);
        sim.run(|sim| sim.clock().step < 1).expect("a step");
        sim
    };
    let (with, without) = (run("xsph(epsilon: 0.4)"), run(""));
    let dt = with.clock().dt;
    let (x, v) = (column::<Position>(&without), column::<Velocity>(&without));
    let (m, rho) = (column::<Mass>(&without), column::<Density>(&without));
    let kernel = Kernel::new(KernelName::WendlandC2, 2).expect("a kernel");
    for (i, moved) in column::<Position>(&with).iter().enumerate() {
        let mean: DVec3 = (0..x.len())
            .map(|j| {
                let d = x[j].0 - x[i].0;
                let r = (d - d.round()).length();
                (v[j].0 - v[i].0) * (kernel.w(r, 0.075) * m[j].0 / rho[j].0)
            })
            .sum();
        let wanted = x[i].0 + 0.4 * dt * mean;
        assert!(moved.0.distance(wanted) < 1e-12, "{i}: {} {wanted}", moved.0);
    }
}

#[test]
fn off_is_as_if_it_were_not_there() {
    let hash = |plugins: &str| {
        let mut sim = simulation(plugins, "Square", VORTICES);
        sim.run(|sim| sim.clock().step < 10).expect("a run");
        sim.state_hash()
    };
    assert_eq!(hash(""), hash("xsph(epsilon: 0.0)"));
    assert_ne!(hash(""), hash("xsph()"));
}
