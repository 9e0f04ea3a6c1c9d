//! Debris of Eulerian bodies: the diffusion of density beside failed particles, against a sum over all pairs
//! that is written out here.

mod common;

use common::eulerian::{Particle, particles};
use common::simulation;
use meshless::formulations::eulerian::DilatationRate;
use meshless::glam::DVec3;
use meshless::kernels::{Kernel, KernelName};
use meshless::scene::Source;
use meshless::world::{BodyId, Damage};

const SPACING: f64 = 0.05;

/// V_0,j w_ij and x_ij of the neighbours of particle `i`, by the ellipsoids of both.
fn pairs(all: &[Particle], i: usize) -> impl Iterator<Item = (usize, f64, DVec3)> {
    let kernel = Kernel::new(KernelName::CubicSpline, 2).expect("a kernel");
    let h = kernel.smoothing_length(2.6 * SPACING);
    (0..all.len()).filter(move |&j| j != i).map(move |j| {
        let x_ij = all[j].x - all[i].x;
        let mean = |of: &dyn Fn(&Particle) -> f64| 0.5 * (of(&all[i]) + of(&all[j]));
        let square = mean(&|own| x_ij.dot(own.metric.to_matrix() * x_ij));
        let weight = mean(&|own| own.metric.determinant().sqrt()) * kernel.pair_weight(square.sqrt(), h);
        (j, all[j].volume * weight, x_ij)
    })
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
