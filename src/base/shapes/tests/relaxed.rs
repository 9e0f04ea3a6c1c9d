//! Irregular packings: uniformity, volumes, reproducibility.

use std::f64::consts::PI;

use glam::DVec3;

use super::{assert_close, filled, min_distance, total};
use crate::scene::Dimension::{self, Three, Two};
use crate::shapes::{Lattice, Site};

fn relaxed(text: &str, seed: u64, iterations: u32, spacing: f64, dimension: Dimension) -> Vec<Site> {
    filled(text, Lattice::Relaxed { seed, iterations }, spacing, dimension)
}

const SQUARE: &str = "Box(min: (0, 0), max: (1, 1))";

#[test]
fn particles_keep_apart_and_volumes_even() {
    let spacing = (1.0f64 / 444.0).sqrt();
    let waist = "Difference(Box(min: (0, 0), max: (4, 1)), Sphere(center: (2, -1), radius: 1.3))";
    let ball = "Sphere(center: (0, 0, 0), radius: 1)";
    for (text, spacing, dimension) in [
        (SQUARE, spacing, Two),
        (waist, 0.1, Two),
        ("Ring(center: (0, 0), inner: 0.5, outer: 1)", 0.1, Two),
        ("Box(min: (0, 0, 0), max: (1, 1, 2))", 0.125, Three),
        (ball, 0.2, Three),
    ] {
        for iterations in [0, 2, 6] {
            let sites = relaxed(text, 1, iterations, spacing, dimension);
            let mean = total(&sites) / sites.len() as f64;
            let limits = if iterations == 0 { (0.25, 3.0) } else { (0.4, 2.2) };
            let volumes = || sites.iter().map(|site| site.volume / mean);
            let (least, most) = (volumes().fold(f64::INFINITY, f64::min), volumes().fold(0.0, f64::max));
            println!(
                "{text} {iterations} {}: {:.3} {least:.3} {most:.3}",
                sites.len(),
                min_distance(&sites) / spacing
            );
            assert!(min_distance(&sites) > 0.5 * spacing, "{text} {iterations}");
            assert!(least > limits.0 && most < limits.1, "{text} {iterations}: {least} {most}");
        }
    }
    assert_eq!(relaxed(SQUARE, 1, 6, spacing, Two).len(), 444);
}

#[test]
fn volumes_add_up_to_the_shape() {
    assert_close(total(&relaxed(SQUARE, 3, 4, 0.05, Two)), 1.0, 1e-12);
    assert_close(total(&relaxed("Sphere(center: (0, 0), radius: 1)", 3, 4, 0.1, Two)), PI, 1e-12);
    let ball = relaxed("Sphere(center: (0, 0, 0), radius: 1)", 3, 4, 0.2, Three);
    assert_close(total(&ball), 4.0 / 3.0 * PI, 1e-12);
    assert!(ball.iter().all(|site| site.position.length() < 1.0));
}

#[test]
fn volumes_are_those_of_voronoi_cells() {
    // Compared with a search over all points for every sample of a much finer grid.
    let cube = "Box(min: (0, 0, 0), max: (1, 1, 1))";
    for (sites, samples, layers) in
        [(relaxed(SQUARE, 5, 3, 0.1, Two), 500, 1), (relaxed(cube, 5, 3, 0.25, Three), 80, 80)]
    {
        let mut volumes = vec![0.0; sites.len()];
        let height = if layers == 1 { 0.0 } else { 1.0 };
        for n in 0..samples * samples * layers {
            let (i, j, k) = (n % samples, n / samples % samples, n / (samples * samples));
            let parts =
                DVec3::new(i as f64 + 0.5, j as f64 + 0.5, height * (k as f64 + 0.5)) / samples as f64;
            let distance = |n: &usize| sites[*n].position.distance(parts);
            let nearest = (0..sites.len()).min_by(|a, b| distance(a).total_cmp(&distance(b)));
            volumes[nearest.unwrap()] += 1.0 / (samples * samples * layers) as f64;
        }
        for (site, volume) in sites.iter().zip(volumes) {
            assert_close(site.volume, volume, 0.02);
        }
    }
}

#[test]
fn lloyd_moves_particles_towards_their_centroids() {
    // The functional that Lloyd's method reduces: the integral of the squared distance to the nearest
    // particle.
    let energy = |iterations| {
        let sites = relaxed(SQUARE, 2, iterations, 0.1, Two);
        let point = |n: usize| DVec3::new((n % 200) as f64 + 0.5, (n / 200) as f64 + 0.5, 0.0) / 200.0;
        let squared =
            |p: DVec3| sites.iter().map(|site| site.position.distance_squared(p)).fold(9.0, f64::min);
        (0..40_000).map(|n| squared(point(n))).sum::<f64>()
    };
    let energies = [0, 1, 3, 10].map(energy);
    assert!(energies.windows(2).all(|pair| pair[1] < pair[0]), "{energies:?}");
}

#[test]
fn same_for_a_seed_and_any_threads() {
    let run = |threads, seed| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        pool.install(|| relaxed("Sphere(center: (0, 0, 0), radius: 1)", seed, 3, 0.15, Three))
    };
    let one = run(1, 11);
    assert_eq!(one, run(2, 11));
    assert_eq!(one, run(7, 11));
    assert_ne!(one, run(1, 12));
}
