//! The Morton order.

use glam::DVec3;

use super::filled;
use crate::scene::Dimension::Three;
use crate::shapes::{Lattice, morton_order};

#[test]
fn visits_octants_one_after_another() {
    let points: Vec<DVec3> = (0..8 * 8 * 8)
        .map(|n| 0.1 * DVec3::new((n / 64) as f64, (n / 8 % 8) as f64, (n % 8) as f64) + DVec3::splat(-0.3))
        .collect();
    let order = morton_order(&points, 0.1);
    let mut seen = order.clone();
    seen.sort_unstable();
    assert!(seen.into_iter().eq(0..512));
    // Bitwise: position n of the curve has x in bits 0, 3, 6 of n, y in 1, 4, 7, z in 2, 5, 8.
    for (n, &point) in order.iter().enumerate() {
        let axis = |k: usize| (0..3).map(|bit| (n >> (3 * bit + k) & 1) << bit).sum::<usize>() as f64;
        let expected = 0.1 * DVec3::new(axis(0), axis(1), axis(2)) - DVec3::splat(0.3);
        assert!(points[point as usize].distance(expected) < 1e-12);
    }
}

#[test]
fn any_points() {
    assert!(morton_order(&[], 1.0).is_empty());
    assert_eq!(morton_order(&[DVec3::X; 3], 1.0), [0, 1, 2]);
    // Points far apart compared with the cell: still a permutation, ordered by x alone.
    assert_eq!(morton_order(&[DVec3::X * 1e30, DVec3::ZERO, DVec3::X * 5e29], 1e-3), [1, 2, 0]);
}

#[test]
fn neighbours_in_space_are_near_in_memory() {
    // Blocks of 64 particles in a row fill cubes of 4 x 4 x 4.
    let sites = filled("Box(min: (0, 0, 0), max: (1.6, 1.6, 1.6))", Lattice::Regular, 0.1, Three);
    assert_eq!(sites.len(), 4096);
    for block in sites.chunks(64) {
        let far = block
            .iter()
            .map(|site| (site.position - block[0].position).abs().max_element())
            .fold(0.0, f64::max);
        assert!(far < 0.31);
    }
}

#[test]
fn same_for_any_threads() {
    let run = |threads| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        let shape =
            "Difference(Sphere(center: (0, 0, 0), radius: 1), Sphere(center: (1, 0, 0), radius: 0.5))";
        pool.install(|| filled(shape, Lattice::Regular, 0.05, Three))
    };
    let one = run(1);
    assert_eq!(one, run(2));
    assert_eq!(one, run(7));
}
