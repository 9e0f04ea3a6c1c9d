//! Square and cubic lattices: counts, positions, volumes.

use std::f64::consts::PI;

use glam::DVec3;

use super::{assert_close, filled, total};
use crate::scene::Dimension::{Three, Two};
use crate::shapes::{Lattice, Site};

fn square(text: &str, spacing: f64) -> Vec<Site> {
    filled(text, Lattice::Regular, spacing, Two)
}

fn cubic(text: &str, spacing: f64) -> Vec<Site> {
    filled(text, Lattice::Regular, spacing, Three)
}

/// Each expected position occurs exactly once.
fn assert_positions(sites: &[Site], expected: &[DVec3]) {
    assert_eq!(sites.len(), expected.len());
    for &position in expected {
        let near = |site: &&Site| site.position.distance(position) < 1e-12;
        assert_eq!(sites.iter().filter(near).count(), 1, "{position}");
    }
}

#[test]
fn rectangle_has_cell_centres() {
    let sites = square("Box(min: (-1, 2), max: (-0.7, 2.2))", 0.1);
    let expected: Vec<DVec3> = (0..3)
        .flat_map(|i| (0..2).map(move |j| DVec3::new(-0.95 + 0.1 * i as f64, 2.05 + 0.1 * j as f64, 0.0)))
        .collect();
    assert_positions(&sites, &expected);
    assert!(sites.iter().all(|site| (site.volume - 0.01).abs() < 1e-15));
}

#[test]
fn whole_multiples_survive_round_off() {
    for count in 2..200 {
        for spacing in [0.1, 0.01, 0.3, 0.007, 1.0 / 3.0, 0.0025] {
            let (width, height) = (count as f64 * spacing, 3.0 * spacing);
            for corner in [0.0, 0.8, -1e3 * spacing, 17.3] {
                let text = format!("Box(min: ({corner:?}, 0), max: ({:?}, {height:?}))", corner + width);
                let sites = square(&text, spacing);
                assert_eq!(sites.len(), 3 * count, "{text} {spacing}");
                assert_close(total(&sites), width * height, 1e-12);
            }
        }
    }
}

#[test]
fn other_sides_get_the_nearest_count() {
    let sites = square("Box(min: (0, 0), max: (1.04, 0.97))", 0.1);
    assert_eq!(sites.len(), 10 * 10);
    assert_close(total(&sites), 1.04 * 0.97, 1e-12);
    let least = sites.iter().fold(DVec3::INFINITY, |least, site| least.min(site.position));
    assert!(least.distance(DVec3::new(0.052, 0.0485, 0.0)) < 1e-12);
}

#[test]
fn cuboid() {
    let sites = cubic("Box(min: (0, 0, 0), max: (0.4, 0.5, 0.6))", 0.1);
    assert_eq!(sites.len(), 4 * 5 * 6);
    assert_close(total(&sites), 0.12, 1e-12);
    let mean = sites.iter().map(|site| site.position).sum::<DVec3>() / sites.len() as f64;
    assert!(mean.distance(DVec3::new(0.2, 0.25, 0.3)) < 1e-12);
}

#[test]
fn curved_shapes_have_their_volume() {
    for spacing in [0.3, 0.11, 0.05] {
        for (text, area) in [
            ("Sphere(center: (0.3, -1), radius: 1)", PI),
            ("Ring(center: (0, 0), inner: 0.3, outer: 1.1)", PI * (1.21 - 0.09)),
            ("Polygon(points: [(0, 0), (4.8, 4.4), (4.8, 6), (0, 4.4)])", 0.5 * 4.8 * (4.4 + 1.6)),
        ] {
            let sites = square(text, spacing);
            assert_close(total(&sites), area, 1e-12);
            assert_close(sites.len() as f64 * spacing * spacing, area, 1.5 * spacing);
        }
    }
    for (text, volume) in [
        ("Sphere(center: (0, 1, 2), radius: 1)", 4.0 / 3.0 * PI),
        ("Cylinder(from: (0, 0, 0), to: (0, 0, 2), radius: 0.5)", 0.5 * PI),
        ("Cylinder(from: (0, 0, 0), to: (1, 1, 1), radius: 0.5)", 0.25 * PI * 3f64.sqrt()),
        ("Tube(from: (0, 0, 0), to: (2, 0, 0), inner: 0.5, outer: 1)", 1.5 * PI),
        ("Extrusion(polygon: [(0, 0), (1, 0), (0, 1)], from: -1, to: 1)", 1.0),
    ] {
        let sites = cubic(text, 0.1);
        assert_close(total(&sites), volume, 1e-12);
        assert_close(sites.len() as f64 * 1e-3, volume, 0.12);
    }
}

#[test]
fn disc_is_symmetric() {
    let sites = square("Sphere(center: (0, 0), radius: 1)", 0.07);
    for site in &sites {
        let mirrored = DVec3::new(site.position.y, -site.position.x, 0.0);
        assert!(sites.iter().any(|other| other.position.distance(mirrored) < 1e-12));
    }
}

#[test]
fn tank_walls_have_whole_layers() {
    // Two layers of 0.01 m on three sides of a tank; the lattice is that of the outer box.
    let text = "Difference(Box(min: (-0.02, -0.02), max: (1.02, 0.5)), Box(min: (0, 0), max: (1, 0.6)))";
    let sites = square(text, 0.01);
    assert_eq!(sites.len(), 104 * 52 - 100 * 50);
    assert_close(total(&sites), 1.04 * 0.52 - 1.0 * 0.5, 1e-12);
    assert!(sites.iter().all(|site| (site.volume - 1e-4).abs() < 1e-14));
    assert!(sites.iter().all(|site| site.position.x < 0.0 || site.position.x > 1.0 || site.position.y < 0.0));
}

#[test]
fn union_goes_on_with_the_lattice_of_the_first() {
    let text = "Union([Box(min: (0, 0), max: (0.4, 0.4)), Box(min: (0.2, 0.1), max: (1, 0.3)), Box(min: (-0.3, 0), max: (0, 0.2))])";
    let sites = square(text, 0.1);
    assert_eq!(sites.len(), 16 + 6 * 2 + 3 * 2);
    assert_close(total(&sites), 0.34, 1e-12);
    for site in &sites {
        let cell = site.position / 0.1;
        assert!((cell - cell.floor() - DVec3::new(0.5, 0.5, 0.0)).abs().max_element() < 1e-9);
    }
}

#[test]
fn combinations_without_closed_form_are_good_to_a_part_in_a_thousand() {
    // A lens of two unit circles one apart; a ball with a cylindrical hole (napkin ring: pi h^3 / 6).
    let lens = "Intersection([Sphere(center: (0, 0), radius: 1), Sphere(center: (1, 0), radius: 1)])";
    assert_close(total(&square(lens, 0.1)), 2.0 * PI / 3.0 - 0.75f64.sqrt(), 1e-5);
    let both = "Union([Sphere(center: (0, 0), radius: 1), Sphere(center: (1, 0), radius: 1)])";
    assert_close(total(&square(both, 0.1)), 4.0 * PI / 3.0 + 0.75f64.sqrt(), 1e-5);
    let ring = "Difference(Sphere(center: (0, 0, 0), radius: 1), Cylinder(from: (0, 0, -2), to: (0, 0, 2), radius: 0.6))";
    assert_close(total(&cubic(ring, 0.1)), PI * 1.6f64.powi(3) / 6.0, 2e-4);
    let plate = "Difference(Box(min: (0, 0), max: (1, 1)), Sphere(center: (0, 0), radius: 0.5))";
    assert_close(total(&square(plate, 0.05)), 1.0 - PI / 16.0, 1e-5);
    let turned = "Difference(Box(min: (0, 0), max: (1, 1)), Rotate(shape: Box(min: (0, 0), max: (1, 1)), angle_degrees: 45))";
    // Half of the square, and the corner of the other half beyond x + y = sqrt(2).
    let corner = (2.0 - 2f64.sqrt()).powi(2) / 4.0;
    assert_close(total(&square(turned, 0.05)), 0.5 + corner, 2e-5);
}

#[test]
fn transforms_take_the_lattice_along() {
    let plain = square("Box(min: (0, 0), max: (0.4, 0.2))", 0.1);
    let turned =
        square("Rotate(shape: Box(min: (0, 0), max: (0.4, 0.2)), angle_degrees: 30, about: (1, 0))", 0.1);
    let moved = square("Translate(shape: Box(min: (0, 0), max: (0.4, 0.2)), by: (3, -1))", 0.1);
    let grown = square("Scale(shape: Box(min: (0, 0), max: (0.4, 0.2)), by: (2, 2), about: (0.4, 0))", 0.2);
    let (sin, cos) = (PI / 6.0).sin_cos();
    let turn = |p: DVec3| DVec3::new(1.0 + cos * (p.x - 1.0) - sin * p.y, sin * (p.x - 1.0) + cos * p.y, 0.0);
    let expected =
        |to: &dyn Fn(DVec3) -> DVec3| plain.iter().map(|site| to(site.position)).collect::<Vec<_>>();
    assert_positions(&turned, &expected(&turn));
    assert_positions(&moved, &expected(&|p| p + DVec3::new(3.0, -1.0, 0.0)));
    assert_positions(&grown, &expected(&|p| DVec3::new(2.0 * p.x - 0.4, 2.0 * p.y, 0.0)));
    assert_close(total(&grown), 0.32, 1e-12);
    let stretched = square("Scale(shape: Box(min: (0, 0), max: (0.4, 0.2)), by: (2, 1))", 0.1);
    assert_eq!(stretched.len(), 16);
    assert_close(total(&stretched), 0.16, 1e-12);
    let standing = cubic(
        "Rotate(shape: Box(min: (0, 0, 0), max: (0.2, 0.2, 1)), axis: (0, 2, 0), angle_degrees: 90)",
        0.1,
    );
    assert!(
        standing.iter().all(|site| site.position.x > 0.0 && site.position.z < 0.0 && site.position.z > -0.2)
    );
}

#[test]
fn a_half_space_cuts_a_box() {
    let cut = "Intersection([HalfSpace(point: (0.5, 0), normal: (1, 0)), Box(min: (0, 0), max: (1, 1))])";
    let sites = filled(cut, Lattice::Regular, 0.1, Two);
    assert_eq!(sites.len(), 50);
    assert!(sites.iter().all(|site| site.position.x < 0.5));
    assert_close(total(&sites), 0.5, 1e-3);
}
