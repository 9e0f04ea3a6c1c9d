//! Even particles feel nothing; the force of uneven ones against a naive second implementation.

use meshless_engine::glam::DVec3;
use meshless_engine::kernels::{Kernel, KernelName};
use meshless_engine::plugin::{Registry, build};
use meshless_engine::scene::{Source, parse};
use meshless_engine::simulation::Simulation;
use meshless_engine::world::{BodyId, Column, Position};
use meshless_engine::world::{Density, Force, Mass, Pressure};

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
    tensile_control::register(&mut registry);
    build(&scene, &source, &registry).unwrap_or_else(|error| panic!("{error}"))
}

fn column<C: Column + Copy>(sim: &Simulation) -> Vec<C> {
    let (view, _) = sim.world().body_view(BodyId(0));
    view.read::<C>().expect("a column").to_vec()
}

const VORTICES: &str = r#"("-cos(2*pi*x)*sin(2*pi*y)", "sin(2*pi*x)*cos(2*pi*y)")"#;

#[test]
fn the_force_is_that_of_a_naive_sum_and_zero_on_a_lattice() {
    for (lattice, even) in [("Square", true), ("Relaxed(seed: 3, iterations: 1)", false)] {
        let start = |plugins: &str| {
            let mut sim = simulation(plugins, lattice, VORTICES);
            sim.start().expect("a start");
            sim
        };
        let (with, without) = (start("tensile_control()"), start(""));
        let x = column::<Position>(&with);
        let (m, rho, p) = (column::<Mass>(&with), column::<Density>(&with), column::<Pressure>(&with));
        let volume = |k: usize| m[k].0 / rho[k].0;
        let kernel = Kernel::new(KernelName::WendlandC2, 2).expect("a kernel");
        let before = column::<Force>(&without);
        let mut largest = 0.0_f64;
        for (i, force) in column::<Force>(&with).iter().enumerate() {
            let sum: DVec3 = (0..x.len())
                .map(|j| {
                    let d = x[j].0 - x[i].0;
                    let d = d - d.round();
                    d * (volume(j) * kernel.pair_weight(d.length(), 0.075))
                })
                .sum();
            let wanted = sum * (2.0 * p[i].0 * volume(i));
            let found = force.0 - before[i].0;
            assert!(found.distance(wanted) < 1e-12, "{i}: {found} {wanted}");
            largest = largest.max(found.length());
        }
        assert_eq!(largest < 1e-12, even, "{largest}");
    }
}
