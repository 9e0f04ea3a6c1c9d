//! The proposed time step against the critical one of a naive second implementation: the largest frequency of
//! the linearised equations, found by power iteration over all pairs.

use glam::{DMat2, DVec2, DVec3};
use meshless_engine::assembly::build;
use meshless_engine::plugin::Registry;
use meshless_engine::scene::{Source, parse};
use meshless_engine::simulation::Simulation;
use meshless_engine::world::{BodyId, Force, Mass, Position, ReferencePosition, ReferenceVolume};

const YOUNG: f64 = 3.0e6;
const POISSON: f64 = 0.3;
const DENSITY: f64 = 1200.0;

fn simulation(support: f64, alpha: f64, lattice: &str) -> Simulation {
    let text = format!(
        r#"(dimension: Two,
            materials: {{"m": StVenantKirchhoff(density: {DENSITY:?}, young: {YOUNG:?}, poisson: {POISSON:?})}},
            bodies: [(name: "b", material: "m", shape: Box(min: (0, 0), max: (1.2, 1.0)), spacing: 0.1, lattice: {lattice},
                      formulation: TotalLagrangian(support: {support:?}), plugins: [hourglass_control(alpha: {alpha:?})])],
            time: (end: 1))"#
    );
    let (scene, source) = parse(Source::new("test.ron", text)).unwrap_or_else(|error| panic!("{error}"));
    let registry = Registry::standard().with(hourglass_control::register);
    let mut sim = build(&scene, &source, &registry).unwrap_or_else(|error| panic!("{error}"));
    sim.start().expect("a start");
    sim
}

/// A free block: places, volumes, and the spiky weights of all pairs within the support.
struct Naive {
    volume: Vec<f64>,
    pairs: Vec<Vec<(usize, DVec2, f64)>>,
    inverse: Vec<DMat2>,
    alpha: f64,
}

impl Naive {
    fn new(sim: &Simulation, support: f64, alpha: f64) -> Self {
        let (view, _) = sim.world().body_view(BodyId(0));
        let x: Vec<DVec2> =
            view.read::<ReferencePosition>().expect("places").iter().map(|x| x.0.truncate()).collect();
        let volume: Vec<f64> = view.read::<ReferenceVolume>().expect("volumes").iter().map(|v| v.0).collect();
        let radius = support * 0.1;
        let pairs: Vec<Vec<_>> = (0..x.len())
            .map(|i| {
                let others = (0..x.len()).filter(|&j| j != i && x[i].distance(x[j]) < radius);
                let weight =
                    |r: f64| 30.0 / (std::f64::consts::PI * radius.powi(5)) * (radius - r).powi(2) / r;
                others.map(|j| (j, x[j] - x[i], weight(x[i].distance(x[j])))).collect()
            })
            .collect();
        let moment = |row: &Vec<(usize, DVec2, f64)>| {
            row.iter()
                .fold(DMat2::ZERO, |m, &(j, d, w)| m + DMat2::from_cols(d * d.x, d * d.y) * (volume[j] * w))
        };
        let inverse = pairs.iter().map(|row| moment(row).inverse()).collect();
        Self { volume, pairs, inverse, alpha }
    }

    /// Force per mass at a small displacement.
    fn acceleration(&self, u: &[DVec2]) -> Vec<DVec2> {
        let n = u.len();
        let lambda = YOUNG * POISSON / ((1.0 + POISSON) * (1.0 - 2.0 * POISSON));
        let mu = YOUNG / (2.0 * (1.0 + POISSON));
        let gradient: Vec<DMat2> = (0..n)
            .map(|i| {
                let sum = self.pairs[i].iter().fold(DMat2::ZERO, |h, &(j, d, w)| {
                    let du = u[j] - u[i];
                    h + DMat2::from_cols(du * d.x, du * d.y) * (self.volume[j] * w)
                });
                sum * self.inverse[i]
            })
            .collect();
        let stress: Vec<DMat2> = gradient
            .iter()
            .map(|h| {
                let strain = (*h + h.transpose()) * 0.5;
                DMat2::IDENTITY * (lambda * (strain.x_axis.x + strain.y_axis.y)) + strain * (2.0 * mu)
            })
            .collect();
        (0..n)
            .map(|i| {
                let mut force = DVec2::ZERO;
                for &(j, d, w) in &self.pairs[i] {
                    let traction = stress[i] * (self.inverse[i] * d) + stress[j] * (self.inverse[j] * d);
                    let error = (gradient[i] + gradient[j]) * d - 2.0 * (u[j] - u[i]);
                    force += (traction - error * (self.alpha / 6.0 * YOUNG)) * (w * self.volume[j]);
                }
                force / DENSITY
            })
            .collect()
    }

    /// Critical step 2 / omega of the highest mode, s.
    fn critical_step(&self) -> f64 {
        let n = self.volume.len();
        let mut u: Vec<DVec2> =
            (0..n).map(|k| DVec2::new((k as f64 * 7.3).sin(), (k as f64 * 3.1).cos())).collect();
        let mut omega_squared = 0.0;
        for _ in 0..600 {
            let a = self.acceleration(&u);
            omega_squared = a.iter().map(|a| a.length_squared()).sum::<f64>().sqrt()
                / u.iter().map(|u| u.length_squared()).sum::<f64>().sqrt();
            u = a.iter().map(|a| *a / -omega_squared).collect();
        }
        2.0 / omega_squared.sqrt()
    }
}

#[test]
fn the_step_is_a_safe_and_fair_share_of_the_critical_one() {
    for lattice in ["Regular", "Relaxed(seed: 5)", "Relaxed(seed: 9, iterations: 2)"] {
        for support in [2.0001, 2.41, 3.0] {
            for alpha in [0.0, 2.0, 5.0, 10.0, 50.0] {
                let sim = simulation(support, alpha, lattice);
                let proposed = sim.limit().expect("a limit").dt;
                let share = proposed / Naive::new(&sim, support, alpha).critical_step();
                println!("{lattice} support {support} alpha {alpha}: {share:.3}");
                assert!((0.3..0.75).contains(&share), "{lattice} support {support} alpha {alpha}: {share}");
            }
        }
    }
}

/// A free Eulerian block of irregular particles, each displaced by `u`.
fn eulerian(dimension: usize, lattice: &str, xi: f64, u: impl Fn(usize) -> DVec3) -> Simulation {
    let (name, high) = if dimension == 2 { ("Two", "(0.6, 0.5)") } else { ("Three", "(0.4, 0.3, 0.3)") };
    let low = if dimension == 2 { "(0, 0)" } else { "(0, 0, 0)" };
    let text = format!(
        r#"(dimension: {name},
            materials: {{"m": NeoHookean(density: {DENSITY:?}, young: {YOUNG:?}, poisson: {POISSON:?})}},
            bodies: [(name: "b", material: "m", shape: Box(min: {low}, max: {high}), spacing: 0.1, lattice: {lattice},
                      formulation: Eulerian(), plugins: [hourglass_control(xi: {xi:?})])],
            time: (end: 1))"#
    );
    let (scene, source) = parse(Source::new("test.ron", text)).unwrap_or_else(|error| panic!("{error}"));
    let registry = Registry::standard().with(hourglass_control::register);
    let mut sim = build(&scene, &source, &registry).unwrap_or_else(|error| panic!("{error}"));
    {
        let (view, _) = sim.world().body_view(BodyId(0));
        let mut x = view.write::<Position>().expect("places");
        x.iter_mut().enumerate().for_each(|(k, x)| x.0 += u(k));
    }
    sim.start().expect("a start");
    sim
}

/// Critical step of the block, s: the forces of small displacements, again and again.
fn critical_step_of_eulerian(dimension: usize, lattice: &str, xi: f64) -> f64 {
    let accelerations = |u: &[DVec3]| -> Vec<DVec3> {
        let sim = eulerian(dimension, lattice, xi, |k| u.get(k).copied().unwrap_or_default());
        let (view, _) = sim.world().body_view(BodyId(0));
        let mass = view.read::<Mass>().expect("masses");
        view.read::<Force>().expect("forces").iter().zip(mass.iter()).map(|(f, m)| f.0 / m.0).collect()
    };
    let n = accelerations(&[]).len();
    let z = if dimension == 3 { 1.0 } else { 0.0 };
    let start =
        |k: usize| DVec3::new((k as f64 * 7.3).sin(), (k as f64 * 3.1).cos(), z * (k as f64 * 5.7).sin());
    let mut u: Vec<DVec3> = (0..n).map(start).collect();
    let mut omega_squared = 0.0;
    for _ in 0..200 {
        let size = 1e7 * u.iter().map(|u| u.length_squared()).sum::<f64>().sqrt();
        u.iter_mut().for_each(|u| *u /= size);
        let a = accelerations(&u);
        omega_squared = 1e7 * a.iter().map(|a| a.length_squared()).sum::<f64>().sqrt();
        u = a;
    }
    2.0 / omega_squared.sqrt()
}

#[test]
fn the_step_of_an_eulerian_body_is_a_safe_and_fair_share_of_the_critical_one() {
    for (dimension, lattice) in
        [(2, "Regular"), (2, "Relaxed(seed: 5)"), (3, "Relaxed(seed: 9, iterations: 2)")]
    {
        for xi in [0.0, 3.0, 10.0, 40.0] {
            let proposed = eulerian(dimension, lattice, xi, |_| DVec3::ZERO).limit().expect("a limit").dt;
            let share = proposed / critical_step_of_eulerian(dimension, lattice, xi);
            println!("{dimension} dimensions, {lattice} xi {xi}: {share:.3}");
            assert!((0.3..0.75).contains(&share), "{dimension} dimensions, {lattice} xi {xi}: {share}");
        }
    }
}
