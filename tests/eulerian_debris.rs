//! Tips and debris of Eulerian bodies: the share of the strain rate of particles with few neighbours, what it
//! keeps, and the diffusion of density beside failed particles, against sums over all pairs that are written
//! out here.

mod common;

use common::eulerian::{Particle, particles};
use common::simulation;
use meshless::formulations::eulerian::DilatationRate;
use meshless::glam::{DMat3, DVec3};
use meshless::kernels::{Kernel, KernelName};
use meshless::linalg::Sym3;
use meshless::scene::Source;
use meshless::simulation::Simulation;
use meshless::world::{BodyId, Damage};

const SPACING: f64 = 0.05;

/// A wedge of 2 m whose tip has an angle of 18 degrees, in the plane, of unit density and modulus.
fn wedge(velocity: &str, plugins: &str) -> Simulation {
    simulation(&Source::new(
        "wedge.ron",
        format!(
            r#"(dimension: Two,
            materials: {{"rubber": NeoHookean(density: 1, young: 1, poisson: 0.3)}},
            bodies: [(name: "wedge", material: "rubber", shape: Polygon(points: [(0, 0), (2, 0), (2, 0.65)]), spacing: {SPACING},
                      formulation: Eulerian(), plugins: [{plugins}])],
            conditions: [InitialVelocity(on: Select(body: "wedge"), value: {velocity})],
            time: (end: 100.0))"#
        ),
    ))
}

/// V_0,j w_ij and x_ij of the neighbours of particle `i`.
fn pairs(all: &[Particle], i: usize) -> impl Iterator<Item = (usize, f64, DVec3)> {
    let kernel = Kernel::new(KernelName::CubicSpline, 2).expect("a kernel");
    let h = kernel.smoothing_length(2.6 * SPACING);
    (0..all.len()).filter(move |&j| j != i).map(move |j| {
        let x_ij = all[j].x - all[i].x;
        (j, all[j].volume * kernel.pair_weight(x_ij.length(), h), x_ij)
    })
}

/// M_i^-1 and the share of the strain rate.
fn inverse_and_share(all: &[Particle], i: usize) -> (DMat3, f64) {
    let mut m = pairs(all, i).fold(DMat3::ZERO, |m, (_, w, x)| m + Sym3::dyad(x).to_matrix() * w);
    let spread = m.x_axis.x * m.y_axis.y - m.x_axis.y * m.x_axis.y;
    m.z_axis.z = 1.0;
    let inverse = m.inverse();
    let mean = 0.5 * (inverse.x_axis.x + inverse.y_axis.y);
    let is_fitted = spread > 0.02 * (0.5 * (m.x_axis.x + m.y_axis.y)).powi(2);
    if is_fitted { (inverse, (12.0 / mean).min(1.0)) } else { (DMat3::ZERO, 0.0) }
}

/// `skew A + s sym A`.
fn strained(a: DMat3, share: f64) -> DMat3 {
    0.5 * (a - a.transpose()) + 0.5 * share * (a + a.transpose())
}

#[test]
fn the_force_of_a_tip_is_the_adjoint_of_its_share_of_the_strain_rate() {
    let mut sim = wedge(r#"("0.1*sin(3*x)*(1 + y)", "0.1*cos(4*x) - 0.1*y")"#, "");
    sim.run(|sim| sim.clock().step < 40).expect("a run");
    let all = particles(&sim);
    let fits: Vec<(DMat3, f64)> = (0..all.len()).map(|i| inverse_and_share(&all, i)).collect();
    let partial = fits.iter().filter(|(_, share)| *share > 0.0 && *share < 0.5).count();
    assert!(partial > 0, "no particle has a share");
    let kirchhoff = |p: &Particle| p.stress * p.deformation.transpose();
    let a: Vec<DMat3> = all
        .iter()
        .zip(&fits)
        .map(|(p, (inverse, share))| strained(kirchhoff(p), *share) * *inverse)
        .collect();
    let mut stress_power = 0.0;
    for (i, p) in all.iter().enumerate() {
        let force: DVec3 = pairs(&all, i).map(|(j, w, x)| p.volume * ((a[i] + a[j]) * x) * w).sum();
        assert!((p.f - force).length() < 1e-10 * (1e-4 + force.length()), "{} and {force}", p.f);
        let (inverse, share) = fits[i];
        let gradient = pairs(&all, i).fold(DMat3::ZERO, |sum, (j, w, x)| {
            let v = (all[j].v - p.v) * w;
            sum + DMat3::from_cols(v * x.x, v * x.y, v * x.z)
        });
        let (tau, rate) = (kirchhoff(p), strained(gradient * inverse, share));
        stress_power += p.volume * (0..3).map(|k| tau.col(k).dot(rate.col(k))).sum::<f64>();
    }
    let power: f64 = all.iter().map(|p| p.f.dot(p.v)).sum();
    assert!((power + stress_power).abs() < 1e-10 * stress_power.abs(), "{power} W, {stress_power} W");
}

/// The tip had a third of the step of the rest.
#[test]
fn a_tip_that_turns_keeps_its_momenta_and_does_not_shorten_the_step() {
    let mut sim = wedge(r#"("-0.1*(y - 0.2)", "0.1*(x - 1.2) + 0.03*cos(5*x)")"#, "hourglass_control()");
    sim.run(|sim| sim.clock().step < 1).expect("a step");
    let momenta = |sim: &Simulation| {
        let all = particles(sim);
        let linear: DVec3 = all.iter().map(|p| p.m * p.v).sum();
        (linear, all.iter().map(|p| p.x.cross(p.m * p.v)).sum::<DVec3>())
    };
    let (before, energy) = (momenta(&sim), sim.ledger().stored());
    let mut shortest = f64::INFINITY;
    sim.run(|sim| {
        shortest = shortest.min(sim.clock().dt);
        sim.clock().time < 70.0
    })
    .expect("a run");
    let now = momenta(&sim);
    assert!((now.0 - before.0).length() < 1e-11 * before.1.length());
    assert!((now.1 - before.1).length() < 1e-10 * before.1.length(), "{} and {}", before.1, now.1);
    let error = sim.ledger().balance_error();
    assert!(error.abs() < 0.01 * energy, "{error} J of {energy} J");
    // That of the inside of a body: speed of sound, and the sums over a square lattice, 1.28 / dx^2.
    let sound = (1.0 * 0.7 / (1.3 * 0.4_f64)).sqrt();
    let whole = 0.65 * 2.0 * SPACING / (sound * (1.45 * 1.28_f64).sqrt());
    assert!(shortest > 0.4 * whole, "{shortest} s of {whole} s");
}

/// What has failed and is open bears no pressure: what is intact beside it is not expanded towards a void.
#[test]
fn open_failed_particles_count_with_the_density_without_pressure() {
    let delta = 0.1;
    let mut sim = simulation(&Source::new(
        "debris.ron",
        format!(
            r#"(dimension: Two, materials: {{"m": NeoHookean(density: 1, young: 1, poisson: 0.3)}},
            bodies: [(name: "b", material: "m", shape: Box(min: (0, 0), max: (1.0, 0.6)), spacing: {SPACING}, formulation: Eulerian(),
                plugins: [density_diffusion(model: Molteni, delta: {delta}),
                    failure(criterion: MaximumPrincipalStrain(limit: 0.2), then: NoDeviator)])],
            conditions: [InitialDisplacement(on: Select(body: "b", within: Box(min: (0.5, -1), max: (2, 2))), value: ("0.5*(x - 0.5)", "0"))],
            time: (end: 100.0))"#
        ),
    ));
    sim.run(|sim| sim.clock().step < 1).expect("a step");
    let (all, (view, _)) = (particles(&sim), sim.world().body_view(BodyId(0)));
    let (rate, damage) =
        (view.read::<DilatationRate>().expect("rates"), view.read::<Damage>().expect("damage"));
    let ratio = |i: usize| all[i].deformation.determinant();
    let density = |i: usize| if damage[i].0 < 1.0 { 1.0 / ratio(i) } else { (1.0 / ratio(i)).max(1.0) };
    let open = (0..all.len()).filter(|&i| damage[i].0 >= 1.0 && ratio(i) > 1.1).count();
    assert!(open > 20, "{open} particles have failed");
    // Plane strain: K = E / (3 (1 - 2 nu)), of unit density.
    let (h, sound) = (1.3 * SPACING, (1.0 / (3.0 * 0.4_f64)).sqrt());
    let largest = rate.iter().map(|rate| rate.0.abs()).fold(0.0, f64::max);
    for i in 0..all.len() {
        let sum: f64 = pairs(&all, i).map(|(j, w, _)| w * ratio(j) * (density(j) - density(i))).sum();
        let expected = -2.0 * delta * h * sound * sum / density(i);
        assert!((rate[i].0 - expected).abs() < 1e-10 * largest, "{} and {expected}", rate[i].0);
    }
}
