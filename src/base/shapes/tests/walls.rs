//! Lattices of walls: cells end at the cavity.

use std::path::Path;

use glam::DVec3;

use super::shape;
use crate::scene::Dimension;
use crate::shapes::{Filling, Lattice, Site, fill};

fn wall(text: &str, dimension: Dimension) -> Vec<Site> {
    fill(
        &shape(text),
        Filling {
            lattice: Lattice::default(),
            spacing: 0.02,
            dimension,
            folder: Path::new("."),
            limit: 1_000_000,
            is_wall: true,
        },
    )
    .unwrap()
}

/// Distance along an axis of the particle that is nearest to a point of the surface.
fn first(sites: &[Site], at: DVec3, axis: usize) -> f64 {
    let beside = |site: &&Site| {
        let x = site.position - at;
        (x - x[axis] * DVec3::AXES[axis]).length() < 0.03
    };
    sites.iter().filter(beside).map(|site| (site.position - at)[axis].abs()).fold(f64::INFINITY, f64::min)
}

#[test]
fn cells_end_at_the_cavity_whatever_is_outside() {
    for outside in ["(-0.08, -0.08), max: (0.68, 0.55)", "(-0.0707, -0.09), max: (0.671, 0.561)"] {
        let text = format!("Difference(Box(min: {outside}), Box(min: (0, 0), max: (0.6, 1)))");
        let sites = wall(&text, Dimension::Two);
        for (at, axis) in [((0.3, 0.0), 1), ((0.0, 0.2), 0), ((0.6, 0.2), 0)] {
            let distance = first(&sites, DVec3::new(at.0, at.1, 0.0), axis);
            assert!((distance - 0.01).abs() < 1e-9, "{outside} {at:?}: {distance}");
        }
        assert!(sites.iter().all(|site| (site.volume - 4e-4).abs() < 1e-12));
    }
    let text = "Rotate(shape: Difference(Box(min: (-0.07, -0.07, -0.07), max: (0.37, 0.4, 0.27)), Box(min: (0, 0, 0), max: (0.3, 0.3, 0.2))), axis: (0, 0, 1), angle_degrees: 90)";
    let sites = wall(text, Dimension::Three);
    // The floor y = 0 of the cavity is the plane x = 0 after the rotation.
    let distance = first(&sites, DVec3::new(0.0, 0.15, 0.1), 0);
    assert!((distance - 0.01).abs() < 1e-9, "{distance}");
}

#[test]
fn a_cavity_that_fits_the_outer_box_changes_nothing() {
    let text = "Difference(Box(min: (-0.06, -0.06), max: (0.66, 0.6)), Box(min: (0, 0), max: (0.6, 1)))";
    let as_any_shape = fill(
        &shape(text),
        Filling {
            lattice: Lattice::Regular,
            spacing: 0.02,
            dimension: Dimension::Two,
            folder: Path::new("."),
            limit: 1_000_000,
            is_wall: false,
        },
    )
    .unwrap();
    assert_eq!(wall(text, Dimension::Two), as_any_shape);
}

/// Two vessels joined by a pipe, as one hole of three boxes and cut out one after the other.
#[test]
fn cells_end_at_all_cavities_that_have_one_lattice() {
    let outer = "Box(min: (-0.07, -0.07), max: (1.07, 0.7))";
    let [left, pipe, right] = [
        "Box(min: (0, 0), max: (0.3, 2))",
        "Box(min: (0.3, 0), max: (0.7, 0.1))",
        "Box(min: (0.7, 0), max: (1, 2))",
    ];
    for text in [
        format!("Difference({outer}, Union([{left}, {pipe}, {right}]))"),
        format!("Difference(Difference(Difference({outer}, {left}), {right}), {pipe})"),
    ] {
        let sites = wall(&text, Dimension::Two);
        for (at, axis) in [
            ((0.15, 0.0), 1),
            ((0.0, 0.2), 0),
            ((0.3, 0.3), 0),
            ((0.5, 0.1), 1),
            ((0.7, 0.4), 0),
            ((1.0, 0.2), 0),
        ] {
            let distance = first(&sites, DVec3::new(at.0, at.1, 0.0), axis);
            assert!((distance - 0.01).abs() < 1e-9, "{text} {at:?}: {distance}");
        }
    }
    // No lattice ends at both, so the lattice remains that of the outer box.
    let slit = "Box(min: (0.111, -1), max: (0.2, 0))";
    let sites = wall(&format!("Difference({outer}, Union([{left}, {slit}]))"), Dimension::Two);
    assert!((first(&sites, DVec3::new(-0.07, 0.2, 0.0), 0) - 0.01).abs() < 1e-9);
}
