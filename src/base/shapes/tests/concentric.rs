//! Concentric lattices: volumes, centre of mass, distances.

use std::f64::consts::PI;

use glam::DVec3;

use super::{assert_close, filled, min_distance, total, try_fill};
use crate::scene::Dimension::{Three, Two};
use crate::shapes::{FillErrorKind, Lattice, Site};

fn moment(sites: &[Site]) -> DVec3 {
    sites.iter().map(|site| site.volume * site.position).sum()
}

#[test]
fn rings_of_a_disc() {
    for radius in [0.1, 0.2, 0.55, 1.0] {
        let text = format!("Sphere(center: (2, 1), radius: {radius:?})");
        let sites = filled(&text, Lattice::Concentric, 0.1, Two);
        assert_close(total(&sites), PI * radius * radius, 1e-12);
        let center = moment(&sites) / total(&sites);
        assert!(center.distance(DVec3::new(2.0, 1.0, 0.0)) < 1e-12);
        assert!(min_distance(&sites) > 0.07, "{radius}");
        for site in &sites {
            assert!(site.position.distance(center) < radius);
            assert_close(site.volume, 0.01, 0.25);
        }
    }
}

#[test]
fn ring_and_tube_have_their_second_moment() {
    // The polar moment of area pi (R^4 - r^4) / 2, with an error that decreases with the square of the
    // spacing.
    let exact = 0.5 * PI * (1.0 - 0.5f64.powi(4));
    let error = |spacing: f64| {
        let sites = filled("Ring(center: (0, 0), inner: 0.5, outer: 1)", Lattice::Concentric, spacing, Two);
        assert_close(total(&sites), 0.75 * PI, 1e-12);
        let polar: f64 = sites.iter().map(|site| site.volume * site.position.length_squared()).sum();
        (polar / exact - 1.0).abs()
    };
    assert!(error(0.1) < 1e-2);
    assert_close(error(0.05), 0.25 * error(0.1), 0.2);

    let tube =
        filled("Tube(from: (0, 0, 0), to: (2, 2, 1), inner: 0.5, outer: 1)", Lattice::Concentric, 0.1, Three);
    assert_close(total(&tube), 2.25 * PI, 1e-12);
    assert!((moment(&tube) / total(&tube)).distance(DVec3::new(1.0, 1.0, 0.5)) < 1e-12);
    assert!(min_distance(&tube) > 0.07);
    let axis = DVec3::new(2.0, 2.0, 1.0) / 3.0;
    for site in &tube {
        let along = site.position.dot(axis);
        let radius = (site.position - along * axis).length();
        assert!(along > 0.0 && along < 3.0 && radius > 0.5 && radius < 1.0);
    }
}

#[test]
fn cylinder() {
    let sites =
        filled("Cylinder(from: (0, 0, 0), to: (0, 0, 0.5), radius: 0.3)", Lattice::Concentric, 0.1, Three);
    assert_close(total(&sites), 0.045 * PI, 1e-12);
    assert_eq!(sites.len() % 5, 0);
}

#[test]
fn shells_of_a_ball() {
    let sites = filled("Sphere(center: (1, 0, 0), radius: 0.6)", Lattice::Concentric, 0.1, Three);
    let volume = 4.0 / 3.0 * PI * 0.6f64.powi(3);
    assert_close(total(&sites), volume, 1e-12);
    assert!((moment(&sites) / total(&sites)).distance(DVec3::X) < 5e-3);
    assert!(min_distance(&sites) > 0.06);
    for site in &sites {
        assert!(site.position.distance(DVec3::X) < 0.6);
        assert_close(site.volume, 1e-3, 0.1);
    }
}

#[test]
fn transforms_and_refusals() {
    let turned = "Translate(shape: Scale(shape: Sphere(center: (0, 0), radius: 1), by: (2, 2)), by: (5, 0))";
    let sites = filled(turned, Lattice::Concentric, 0.2, Two);
    assert_close(total(&sites), 4.0 * PI, 1e-12);
    assert!(sites.iter().all(|site| site.position.distance(DVec3::new(5.0, 0.0, 0.0)) < 2.0));
    let error = try_fill("Box(min: (0, 0), max: (1, 1))", Lattice::Concentric, 0.1, Two).unwrap_err();
    assert_eq!(error.path, "lattice");
    assert!(matches!(error.kind, FillErrorKind::NotConcentric));
    let error =
        try_fill("Ring(center: (0, 0), inner: 1, outer: 1.1)", Lattice::Concentric, 0.1, Two).unwrap_err();
    assert!(matches!(error.kind, FillErrorKind::Thin { direction: "the radius", .. }));
}

#[test]
fn shells_of_a_hollow_sphere() {
    let text = "Shell(center: (1, 0, 0), inner: 0.3, outer: 0.6)";
    let sites = filled(text, Lattice::Concentric, 0.075, Three);
    assert_close(total(&sites), 4.0 / 3.0 * PI * (0.6f64.powi(3) - 0.3f64.powi(3)), 1e-12);
    assert!((moment(&sites) / total(&sites)).distance(DVec3::X) < 5e-3);
    assert!(min_distance(&sites) > 0.045);
    for site in &sites {
        assert!((0.3..0.6).contains(&site.position.distance(DVec3::X)));
        assert_close(site.volume, 0.075f64.powi(3), 0.1);
    }
}

#[test]
fn differences_of_like_shapes() {
    for (difference, single, dimension) in [
        (
            "Difference(Sphere(center: (1, 0), radius: 1), Sphere(center: (1, 0), radius: 0.5))",
            "Ring(center: (1, 0), inner: 0.5, outer: 1)",
            Two,
        ),
        (
            "Difference(Sphere(center: (0, 0, 0), radius: 1), Translate(shape: Sphere(center: (1, 0, 0), radius: 0.5), by: (-1, 0, 0)))",
            "Shell(center: (0, 0, 0), inner: 0.5, outer: 1)",
            Three,
        ),
        (
            "Difference(Cylinder(from: (0, 0, 0), to: (0, 0, 1), radius: 1), Cylinder(from: (0, 0, 2), to: (0, 0, -1), radius: 0.5))",
            "Tube(from: (0, 0, 0), to: (0, 0, 1), inner: 0.5, outer: 1)",
            Three,
        ),
    ] {
        let (found, expected) = (
            filled(difference, Lattice::Concentric, 0.1, dimension),
            filled(single, Lattice::Concentric, 0.1, dimension),
        );
        assert_eq!(found, expected, "{difference}");
    }
    for text in [
        "Difference(Sphere(center: (1, 0), radius: 1), Sphere(center: (1.1, 0), radius: 0.5))",
        "Difference(Sphere(center: (1, 0), radius: 1), Box(min: (0.9, -0.1), max: (1.1, 0.1)))",
    ] {
        let error = try_fill(text, Lattice::Concentric, 0.1, Two).unwrap_err();
        assert!(matches!(error.kind, FillErrorKind::NotConcentric), "{text}");
    }
    let blind = "Difference(Cylinder(from: (0, 0, 0), to: (0, 0, 1), radius: 1), Cylinder(from: (0, 0, 0.5), to: (0, 0, 2), radius: 0.5))";
    assert!(try_fill(blind, Lattice::Concentric, 0.1, Three).is_err());
}
