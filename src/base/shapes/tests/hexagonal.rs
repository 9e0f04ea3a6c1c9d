//! Hexagonal lattices: neighbours, volumes.

use super::{assert_close, filled, total};
use crate::scene::Dimension::{Three, Two};
use crate::shapes::{Lattice, Site};

/// Number of particles with `count` others within the distance `reach`.
fn with_neighbours(sites: &[Site], reach: f64, count: usize) -> usize {
    let near = |a: &Site| sites.iter().filter(|b| a.position.distance(b.position) < reach).count() - 1;
    sites.iter().filter(|site| near(site) == count).count()
}

#[test]
fn triangles() {
    // Sides that are integer multiples of the cells: a = 1.0746 spacings along x, 0.9306 spacings along y.
    let (a, row) = (1.074569931823542, 0.930604859102100);
    let text = format!("Box(min: (0, 0), max: ({:?}, {:?}))", 20.0 * a, 20.0 * row);
    let sites = filled(&text, Lattice::Hexagonal, 1.0, Two);
    assert_eq!(sites.len(), 400);
    assert_close(total(&sites), 400.0, 1e-12);
    // All but the particles at the rim have six neighbours at the distance a, and none is nearer.
    assert_eq!(with_neighbours(&sites, 0.999 * a, 0), 400);
    assert_eq!(with_neighbours(&sites, 1.001 * a, 6), 18 * 18);
}

#[test]
fn close_packing() {
    let a = 2f64.powf(1.0 / 6.0);
    let sides = [8.0 * a, 8.0 * a * 0.75f64.sqrt(), 8.0 * a * (2.0f64 / 3.0).sqrt()];
    let text = format!("Box(min: (0, 0, 0), max: ({:?}, {:?}, {:?}))", sides[0], sides[1], sides[2]);
    let sites = filled(&text, Lattice::Hexagonal, 1.0, Three);
    assert_eq!(sites.len(), 512);
    assert_close(total(&sites), 512.0, 1e-12);
    assert_eq!(with_neighbours(&sites, 0.999 * a, 0), 512);
    assert!(with_neighbours(&sites, 1.001 * a, 12) >= 6 * 6 * 6);
    // Layers ABAB: every second layer lies exactly above.
    let top = 2.0 * a * (2.0f64 / 3.0).sqrt();
    let above = |a: &Site| {
        sites.iter().any(|b| (b.position - a.position - glam::DVec3::new(0.0, 0.0, top)).length() < 1e-9)
    };
    assert_eq!(sites.iter().filter(|site| above(site)).count(), 6 * 64);
}

#[test]
fn any_shape() {
    let sites = filled("Sphere(center: (0, 0), radius: 1)", Lattice::Hexagonal, 0.1, Two);
    assert_close(total(&sites), std::f64::consts::PI, 1e-12);
    assert_close(sites.len() as f64, 314.0, 0.1);
}
