//! The rate against a naive second implementation, linear fields, energy; a zero coefficient changes nothing.

use meshless_engine::assembly::build;
use meshless_engine::glam::{DMat2, DVec2, DVec3};
use meshless_engine::kernels::{Kernel, KernelName};
use meshless_engine::plugin::Registry;
use meshless_engine::scene::{Source, parse};
use meshless_engine::simulation::Simulation;
use meshless_engine::world::{BodyId, Column, Density, DensityRate, Mass, Position};

fn simulation(plugins: &str, pressure: &str) -> Simulation {
    simulation_with_step(plugins, pressure, 1.0)
}

/// In double precision: the sums are compared to round-off.
fn simulation_with_step(plugins: &str, pressure: &str, factor: f64) -> Simulation {
    let text = format!(
        r#"(dimension: Two, precision: Double,
            materials: {{"m": Fluid(density: 1000.0, sound_speed: 20.0)}},
            bodies: [(name: "b", material: "m", shape: Box(min: (0, 0), max: (1.0, 0.6)), spacing: 0.05,
                      lattice: Relaxed(seed: 7), formulation: Fluid(pressure: "{pressure}"), plugins: [{plugins}])],
            time: (end: 1.0, step: Adaptive(factor: {factor:?})))"#
    );
    let (scene, source) = parse(Source::new("test.ron", text)).unwrap_or_else(|error| panic!("{error}"));
    let mut registry = Registry::standard();
    density_diffusion::register(&mut registry);
    build(&scene, &source, &registry).unwrap_or_else(|error| panic!("{error}"))
}

fn column<C: Column + Copy>(sim: &Simulation) -> Vec<C> {
    let (view, _) = sim.world().body_view(BodyId(0));
    view.read::<C>().expect("a column").to_vec()
}

const ROUGH: &str = "2000*sin(40*x)*cos(31*y)";
const LINEAR: &str = "3000 + 500*x - 900*y";

#[test]
fn the_rate_is_that_of_a_naive_sum_over_all_pairs() {
    for (plugin, corrected) in
        [("density_diffusion(delta: 0.2)", true), ("density_diffusion(model: Molteni, delta: 0.2)", false)]
    {
        let mut sim = simulation(plugin, ROUGH);
        sim.start().expect("a start");
        let (x, rho, m) = (column::<Position>(&sim), column::<Density>(&sim), column::<Mass>(&sim));
        let kernel = Kernel::new(KernelName::WendlandC2, 2).expect("a kernel");
        let h = 0.075;
        let weight = |i: usize, j: usize| kernel.pair_weight(x[i].0.distance(x[j].0), h) * m[j].0 / rho[j].0;
        let gradient: Vec<DVec3> = (0..x.len())
            .map(|i| {
                let (mut moment, mut sum) = (DMat2::ZERO, DVec2::ZERO);
                for j in (0..x.len()).filter(|&j| j != i) {
                    let d = (x[j].0 - x[i].0).truncate();
                    moment += weight(i, j) * DMat2::from_cols(d * d.x, d * d.y);
                    sum += weight(i, j) * (rho[j].0 - rho[i].0) * d;
                }
                if corrected { (moment.inverse() * sum).extend(0.0) } else { DVec3::ZERO }
            })
            .collect();
        for (i, found) in column::<DensityRate>(&sim).iter().enumerate() {
            let others = (0..x.len()).filter(|&j| j != i);
            let wanted: f64 = others
                .map(|j| {
                    let d = x[j].0 - x[i].0;
                    2.0 * 0.2
                        * 20.0
                        * h
                        * weight(i, j)
                        * (rho[j].0 - rho[i].0 - 0.5 * (gradient[i] + gradient[j]).dot(d))
                })
                .sum();
            assert!((found.0 - wanted).abs() < 1e-8 * 20.0, "{plugin} {i}: {} {wanted}", found.0);
        }
    }
}

#[test]
fn a_linear_density_is_left_alone() {
    let mut sim = simulation("density_diffusion()", LINEAR);
    sim.start().expect("a start");
    let largest = column::<DensityRate>(&sim).iter().map(|rate| rate.0.abs()).fold(0.0, f64::max);
    assert!(largest < 1e-8, "{largest}");
}

#[test]
fn it_takes_energy_and_the_books_close() {
    // Noise of the grid swings as fast as the step allows: what is left is the error of the leapfrog, and
    // falls with the step.
    let error = |factor: f64| {
        let mut sim = simulation_with_step("density_diffusion()", ROUGH, factor);
        sim.run(|sim| sim.clock().time < 0.05).expect("a run");
        assert!(sim.ledger().total_named("density_diffusion") > 0.0);
        sim.ledger().relative_error().abs()
    };
    let errors = [1.0, 0.5, 0.25].map(error);
    assert!(errors[2] < 0.01 && errors[1] < 0.5 * errors[0] && errors[2] < 0.5 * errors[1], "{errors:?}");
}

#[test]
fn off_is_as_if_it_were_not_there() {
    let hash = |plugins: &str| {
        let mut sim = simulation(plugins, ROUGH);
        sim.run(|sim| sim.clock().step < 10).expect("a run");
        sim.state_hash()
    };
    assert_eq!(hash(""), hash("density_diffusion(delta: 0.0)"));
    assert_ne!(hash(""), hash("density_diffusion()"));
}
