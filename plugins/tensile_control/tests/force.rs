//! No force on evenly spread particles; the force on uneven ones against a naive second implementation; no
//! energy gain.

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

fn of_text(text: &str) -> Simulation {
    let (scene, source) = parse(Source::new("test.ron", text)).unwrap_or_else(|error| panic!("{error}"));
    let plugins = [tensile_control::register, density_diffusion::register, artificial_viscosity::register];
    let registry = plugins.into_iter().fold(Registry::standard(), Registry::with);
    build(&scene, &source, &registry).unwrap_or_else(|error| panic!("{error}"))
}

/// A block under tension with free sides, one and two lengths wide.
fn free_block(plugins: &str) -> Simulation {
    of_text(&format!(
        r#"(dimension: Two, precision: Double, materials: {{"m": Fluid(density: 1.0, sound_speed: 10.0)}},
            bodies: [(name: "b", material: "m", shape: Box(min: (0, 0), max: (1, 2)), spacing: 0.05,
                      lattice: Relaxed(seed: 3, iterations: 1), formulation: Fluid(pressure: "-0.2"), plugins: [{plugins}])],
            time: (end: 1.0))"#
    ))
}

/// Smallest eigenvalue of the moment matrix, and first moment, of each particle; whether two are neighbours.
struct Naive {
    lambda: Vec<f64>,
    first_moment: Vec<DVec3>,
    near: Vec<Vec<usize>>,
}

impl Naive {
    /// In a box with that period along both axes, m, or without one.
    fn new(sim: &Simulation, period: Option<f64>) -> Self {
        let (x, m, rho) = (column::<Position>(sim), column::<Mass>(sim), column::<Density>(sim));
        let kernel = Kernel::new(KernelName::WendlandC2, 2).expect("a kernel");
        let mut naive = Self { lambda: Vec::new(), first_moment: Vec::new(), near: Vec::new() };
        for i in 0..x.len() {
            let (mut xx, mut xy, mut yy, mut sum, mut near) = (0.0, 0.0, 0.0, DVec3::ZERO, Vec::new());
            for j in (0..x.len()).filter(|&j| j != i) {
                let d = x[j].0 - x[i].0;
                let d = period.map_or(d, |period| d - (d / period).round() * period);
                if d.length() < 0.15 {
                    near.push(j);
                }
                let weight = m[j].0 / rho[j].0 * kernel.pair_weight(d.length(), 0.075);
                (xx, xy, yy) = (xx + weight * d.x * d.x, xy + weight * d.x * d.y, yy + weight * d.y * d.y);
                sum += weight * d;
            }
            let (trace, determinant) = (xx + yy, xx * yy - xy * xy);
            naive.lambda.push(0.5 * (trace - (trace * trace - 4.0 * determinant).sqrt()));
            naive.first_moment.push(sum);
            naive.near.push(near);
        }
        naive
    }

    fn is_inside(&self, i: usize) -> bool {
        self.lambda[i] >= 0.75 && self.near[i].iter().all(|&j| self.lambda[j] >= 0.65)
    }
}

/// Largest difference from the naive force, largest force, and the number of particles inside.
fn compare(with: &mut Simulation, without: &mut Simulation, period: Option<f64>) -> (f64, f64, usize) {
    with.start().expect("a start");
    without.start().expect("a start");
    let naive = Naive::new(with, period);
    let (m, rho, p) = (column::<Mass>(with), column::<Density>(with), column::<Pressure>(with));
    let before = column::<Force>(without);
    let inside: Vec<bool> = (0..m.len()).map(|i| naive.is_inside(i)).collect();
    let unbalanced = |i: usize| naive.first_moment[i] * (2.0 * p[i].0 * m[i].0 / rho[i].0);
    let own: Vec<DVec3> = (0..m.len()).map(|i| if inside[i] { unbalanced(i) } else { DVec3::ZERO }).collect();
    let (sum, sizes) = (own.iter().sum::<DVec3>(), own.iter().map(|f| f.length()).sum::<f64>());
    let (mut difference, mut largest, mut total) = (0.0_f64, 0.0_f64, DVec3::ZERO);
    for (i, force) in column::<Force>(with).iter().enumerate() {
        let found = force.0 - before[i].0;
        let wanted = own[i] - sum * (own[i].length() / sizes.max(f64::MIN_POSITIVE));
        (difference, largest) = (difference.max(found.distance(wanted)), largest.max(found.length()));
        total += found;
    }
    // In mixed precision the forces without the control are rounded too.
    assert!(total.length() < 1e-6 * (largest + 1e-6), "momentum stays: {total}");
    let inside = inside.iter().filter(|inside| **inside).count();
    (difference, largest, inside)
}

#[test]
fn the_force_is_that_of_a_naive_sum_and_zero_on_a_lattice() {
    let uneven = "Relaxed(seed: 3, iterations: 1)";
    // Forces that meet in a particle are some 1e-2: single precision knows 1e-6 of them.
    for (precision, lattice, even, most) in
        [("Double", "Square", true, 1e-12), ("Double", uneven, false, 1e-12), ("Mixed", uneven, false, 1e-8)]
    {
        let (mut with, mut without) =
            (simulation(precision, "tensile_control()", lattice), simulation(precision, "", lattice));
        let (difference, largest, _) = compare(&mut with, &mut without, Some(1.0));
        assert!(difference < most, "{precision}: {difference}");
        assert_eq!(largest < most, even, "{largest}");
    }
}

/// A thread or a drop that flies off has no inside, whatever the wall beside it fills.
#[test]
fn what_a_free_surface_is_near_feels_nothing() {
    let (mut with, mut without) = (free_block("tensile_control()"), free_block(""));
    let (difference, largest, inside) = compare(&mut with, &mut without, None);
    // Of 20 by 40 particles some three rows on each side are at the surface or beside it.
    assert!((300..700).contains(&inside), "{inside}");
    assert!(difference < 1e-12 && largest > 1e-4, "{difference} {largest}");
}

/// Largest energy that the control has given, over the kinetic energy then, and what it has taken in the end.
fn given(sim: &mut Simulation) -> (f64, f64) {
    let mut given = 0.0_f64;
    let account = |sim: &Simulation| sim.ledger().total_named("tensile_control");
    sim.run(|sim| {
        given = given.max(-account(sim) / sim.ledger().total_named("kinetic"));
        true
    })
    .expect("a run");
    (given, account(sim))
}

/// The front of a dam break is two particles thin where it hits the wall, with pressures of a water hammer:
/// before the control left free surfaces alone, it gave 7 J of 165 within 3 ms.
#[test]
fn an_impact_gets_no_energy() {
    for precision in ["Mixed", "Double"] {
        let mut sim = of_text(&format!(
            r#"(dimension: Two, precision: {precision}, domain: (min: (-0.5, -0.5), max: (2.5, 3.0)), gravity: (0, -9.81),
                materials: {{"water": Fluid(density: 1000.0, sound_speed: 40.0)}},
                bodies: [
                    (name: "water", material: "water", shape: Box(min: (0, 0), max: (0.4, 0.4)), spacing: 0.02,
                     formulation: Fluid(), plugins: [density_diffusion(), tensile_control()]),
                    (name: "tank", material: "wall", spacing: 0.02, formulation: Wall(slip: Free),
                     shape: Difference(Box(min: (-0.06, -0.06), max: (1.26, 1.2)), Box(min: (0, 0), max: (1.2, 2)))),
                ],
                plugins: [artificial_viscosity(alpha: 0.02, beta: 0.0)], time: (end: 0.45))"#
        ));
        let (given, _) = given(&mut sim);
        // Round-off alone.
        assert!(given < 1e-12, "{precision}: {given}");
    }
}

/// A free square that turns is under negative pressure: the control acts, and takes.
#[test]
fn a_free_square_that_turns_gets_no_energy() {
    let mut sim = of_text(
        r#"(dimension: Two, materials: {"m": Fluid(density: 1.0, sound_speed: 10.0)},
        bodies: [(name: "b", material: "m", shape: Box(min: (-0.5, -0.5), max: (0.5, 0.5)), spacing: 0.05,
                  lattice: Relaxed(seed: 1), formulation: Fluid(), plugins: [tensile_control()])],
        conditions: [InitialVelocity(on: Select(body: "b"), value: ("y", "-x"))],
        time: (end: 2.0))"#,
    );
    let (given, taken) = given(&mut sim);
    assert!(given < 1e-12 && taken > 0.0, "{given} {taken}");
}
