//! Body-fitted lattices: the outermost layer, evenness, volumes, repeatability.

use std::path::Path;

use super::{assert_close, filled, min_distance, shape, total};
use crate::scene::Dimension::{Three, Two};
use crate::shapes::Lattice;

const FITTED: Lattice = Lattice::BodyFitted { iterations: 20 };

#[test]
fn the_outermost_layer_is_half_a_spacing_from_any_boundary() {
    let inclined =
        "Intersection([Box(min: (0, 0), max: (2, 1)), HalfSpace(point: (1.5, 0.5), normal: (2, 1))])";
    for (text, dimension, spacing) in [
        ("Difference(Box(min: (0, 0), max: (2, 1)), Sphere(center: (1, 0.5), radius: 0.25))", Two, 0.05),
        ("Sphere(center: (0.3, 0.1), radius: 0.5)", Two, 0.04),
        ("Scale(shape: Sphere(center: (0, 0), radius: 1), by: (1, 0.6))", Two, 0.05),
        (inclined, Two, 0.05),
        (
            "Difference(Box(min: (0, 0, 0), max: (1, 1, 0.4)), Cylinder(from: (0.5, 0.5, -1), to: (0.5, 0.5, 1), radius: 0.25))",
            Three,
            0.08,
        ),
        ("Sphere(center: (0, 0, 0), radius: 0.5)", Three, 0.1),
    ] {
        let sites = filled(text, FITTED, spacing, dimension);
        let region = shape(text).region(dimension, Path::new(""), "shape").unwrap();
        let depths: Vec<f64> = sites.iter().map(|site| -region.distance(site.position) / spacing).collect();
        let first: Vec<f64> = depths.iter().copied().filter(|depth| *depth < 0.8).collect();
        assert!(first.iter().all(|depth| (depth - 0.5).abs() < 0.02), "{text}: {first:?}");
        assert!(!depths.iter().any(|depth| (0.8..1.0).contains(depth)), "{text}");
        // The layer has about one particle per spacing of the boundary.
        let mean = total(&sites) / sites.len() as f64;
        let volumes = || sites.iter().map(|site| site.volume / mean);
        let (least, most) = (volumes().fold(f64::INFINITY, f64::min), volumes().fold(0.0, f64::max));
        println!("{text}: {} {least:.3} {most:.3} {:.3}", sites.len(), min_distance(&sites) / spacing);
        assert!(least > 0.5 && most < 1.6, "{text}: {least} {most}");
        assert!(min_distance(&sites) > 0.6 * spacing, "{text}: {}", min_distance(&sites) / spacing);
    }
}

#[test]
fn a_box_keeps_its_lattice() {
    let text = "Box(min: (0, 0), max: (1, 0.5))";
    let (fitted, regular) = (filled(text, FITTED, 0.1, Two), filled(text, Lattice::Regular, 0.1, Two));
    for (a, b) in fitted.iter().zip(&regular) {
        assert!(a.position.distance(b.position) < 1e-9);
        assert_close(a.volume, b.volume, 1e-6);
    }
}

#[test]
fn volumes_add_up_and_threads_do_not_matter() {
    let text = "Difference(Sphere(center: (0, 0), radius: 1), Sphere(center: (0.2, 0), radius: 0.3))";
    let run = |threads| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        pool.install(|| filled(text, FITTED, 0.05, Two))
    };
    let one = run(1);
    assert_eq!(one, run(3));
    assert_close(total(&one), std::f64::consts::PI * (1.0 - 0.09), 1e-12);
}
