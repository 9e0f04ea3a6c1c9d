//! Eulerian solids: the rate against a naive second implementation; a zero coefficient changes nothing.

use meshless_engine::assembly::build;
use meshless_engine::formulations::eulerian::DilatationRate;
use meshless_engine::glam::{DMat2, DVec2};
use meshless_engine::kernels::{Kernel, KernelName};
use meshless_engine::plugin::Registry;
use meshless_engine::scene::{Source, parse};
use meshless_engine::simulation::Simulation;
use meshless_engine::world::{BodyId, Column, DeformationGradient, Position, ReferenceVolume};

const SPACING: f64 = 0.05;

/// A block whose particles start with a rough density.
fn block(plugins: &str) -> Simulation {
    block_beside("", plugins)
}

/// The same with more bodies behind it.
fn block_beside(others: &str, plugins: &str) -> Simulation {
    let text = format!(
        r#"(dimension: Two,
            materials: {{"m": StVenantKirchhoff(density: 1000.0, young: 1.0e6, poisson: 0.3)}},
            bodies: [(name: "b", material: "m", shape: Box(min: (0, 0), max: (1.0, 0.6)), spacing: {SPACING},
                      lattice: Relaxed(seed: 7), formulation: Eulerian(), plugins: [{plugins}]){others}],
            conditions: [InitialDisplacement(on: Select(body: "b"), value: ("0.004*sin(40*x)*cos(31*y)", "0.02*y"))],
            time: (end: 1.0))"#
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

fn after(plugins: &str, steps: u64) -> Simulation {
    let mut sim = block(plugins);
    sim.run(|sim| sim.clock().step < steps).expect("a run");
    sim
}

#[test]
fn the_rate_is_that_of_a_naive_sum_over_all_pairs() {
    for (plugin, corrected) in
        [("density_diffusion(delta: 0.2)", true), ("density_diffusion(model: Molteni, delta: 0.2)", false)]
    {
        let sim = after(plugin, 1);
        let (x, f) = (column::<Position>(&sim), column::<DeformationGradient>(&sim));
        let volume: Vec<f64> = column::<ReferenceVolume>(&sim)
            .iter()
            .zip(&f)
            .map(|(volume, f)| volume.0 * f.0.determinant())
            .collect();
        let density: Vec<f64> = f.iter().map(|f| 1.0 / f.0.determinant()).collect();
        let kernel = Kernel::new(KernelName::CubicSpline, 2).expect("a kernel");
        let h = 1.3 * SPACING;
        let weight = |i: usize, j: usize| volume[j] * kernel.pair_weight(x[i].0.distance(x[j].0), h);
        let arm = |i: usize, j: usize| (x[j].0 - x[i].0).truncate();
        let others = |i: usize| (0..x.len()).filter(move |&j| j != i);
        let gradient: Vec<DVec2> = (0..x.len())
            .map(|i| {
                let (mut moment, mut sum) = (DMat2::ZERO, DVec2::ZERO);
                for j in others(i) {
                    let a = arm(i, j);
                    moment += DMat2::from_cols(a * a.x, a * a.y) * weight(i, j);
                    sum += a * (weight(i, j) * (density[j] - density[i]));
                }
                moment.inverse() * sum
            })
            .collect();
        // Plane strain: K = E / (3 (1 - 2 nu)).
        let sound = (1.0e6 / (3.0 * 0.4) / 1000.0f64).sqrt();
        let rate = column::<DilatationRate>(&sim);
        let largest = rate.iter().map(|rate| rate.0.abs()).fold(0.0, f64::max);
        for i in 0..x.len() {
            let difference = |j: usize| {
                let slope = if corrected { 0.5 * (gradient[i] + gradient[j]).dot(arm(i, j)) } else { 0.0 };
                weight(i, j) * (density[j] - density[i] - slope)
            };
            let expected = -2.0 * 0.2 * h * sound / density[i] * others(i).map(difference).sum::<f64>();
            assert!((rate[i].0 - expected).abs() < 1e-10 * largest, "{plugin}: {} {expected}", rate[i].0);
        }
    }
}

#[test]
fn each_of_two_bodies_has_its_own() {
    let plugin = "density_diffusion(delta: 0.2)";
    let other = r#", (name: "c", material: "m", shape: Box(min: (3, 0), max: (4, 0.6)), spacing: 0.05, formulation: Eulerian(),
                     plugins: [density_diffusion(model: Molteni)])"#;
    let (mut alone, mut beside) = (block(plugin), block_beside(other, plugin));
    for sim in [&mut alone, &mut beside] {
        sim.step().expect("a step");
    }
    assert_eq!(alone.clock().dt, beside.clock().dt);
    let (alone, beside) = (column::<DilatationRate>(&alone), column::<DilatationRate>(&beside));
    assert!(beside.len() > alone.len() && alone.iter().any(|rate| rate.0 != 0.0));
    assert!(alone.iter().zip(&beside).all(|(one, two)| one.0 == two.0));
}

#[test]
fn off_it_is_as_if_it_were_not_there() {
    let with = after("density_diffusion(delta: 0)", 20);
    assert_eq!(with.state_hash(), after("", 20).state_hash());
}
