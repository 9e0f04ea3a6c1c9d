//! Even particles feel nothing; the force of uneven ones against a naive second implementation.

#[path = "../../../tests/common/periodic_flow.rs"]
mod periodic_flow;

use meshless_engine::assembly::build;
use meshless_engine::glam::DVec3;
use meshless_engine::kernels::{Kernel, KernelName};
use meshless_engine::plugin::Registry;
use meshless_engine::scene::{Source, parse};
use meshless_engine::simulation::Simulation;
use meshless_engine::world::Position;
use meshless_engine::world::{Density, Force, Mass, Pressure};
use periodic_flow::{VORTICES, column};

fn simulation(precision: &str, plugins: &str, lattice: &str) -> Simulation {
    periodic_flow::simulation(tensile_control::register, precision, plugins, (lattice, VORTICES))
}

#[test]
fn the_force_is_that_of_a_naive_sum_and_zero_on_a_lattice() {
    let uneven = "Relaxed(seed: 3, iterations: 1)";
    // Forces that meet in a particle are some 1e-2: single precision knows 1e-6 of them.
    for (precision, lattice, even, most) in
        [("Double", "Square", true, 1e-12), ("Double", uneven, false, 1e-12), ("Mixed", uneven, false, 1e-8)]
    {
        let start = |plugins: &str| {
            let mut sim = simulation(precision, plugins, lattice);
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
            assert!(found.distance(wanted) < most, "{precision} {i}: {found} {wanted}");
            largest = largest.max(found.length());
        }
        assert_eq!(largest < most, even, "{largest}");
    }
}

/// A free square that turns is under negative pressure, and its arms are uneven.
#[test]
fn energy_that_it_gives_is_paid_back() {
    let text = r#"(dimension: Two, materials: {"m": Fluid(density: 1.0, sound_speed: 10.0)},
        bodies: [(name: "b", material: "m", shape: Box(min: (-0.5, -0.5), max: (0.5, 0.5)), spacing: 0.05,
                  lattice: Relaxed(seed: 1), formulation: Fluid(), plugins: [tensile_control()])],
        conditions: [InitialVelocity(on: Select(body: "b"), value: ("y", "-x"))],
        time: (end: 2.0))"#;
    let (scene, source) = parse(Source::new("test.ron", text)).unwrap_or_else(|error| panic!("{error}"));
    let registry = Registry::standard().with(tensile_control::register);
    let mut sim = build(&scene, &source, &registry).unwrap_or_else(|error| panic!("{error}"));
    sim.run(|_| true).expect("a run");
    let (taken, kinetic) = (sim.ledger().total_named("tensile_control"), sim.ledger().total_named("kinetic"));
    assert!(taken > -1e-3 * kinetic, "{taken} of {kinetic}");
}
