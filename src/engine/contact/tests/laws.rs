//! The laws as functions: force, stiffness and energy fit each other.

use crate::contact::{ContactLaw, ContactPair, Hertz, NormalForce, Penalty, PlaneForce, Touch};
use crate::scene::{ContactSurface, Dimension};

const RADIUS: f64 = 0.01;

fn laws() -> Vec<Box<dyn NormalForce>> {
    let pair = |dimension| ContactPair { dimension, surface: ContactSurface::Particles, modulus: 2.3e5 };
    let (two, three) = (pair(Dimension::Two), pair(Dimension::Three));
    vec![
        Penalty::default().build(&two).unwrap(),
        Penalty::default().build(&three).unwrap(),
        Penalty { stiffness: Some(3.0e3), ..Penalty::default() }.build(&three).unwrap(),
        Penalty { stiffness: Some(3.0e3), hardening: 0.0, ..Penalty::default() }.build(&three).unwrap(),
        Hertz::default().build(&two).unwrap(),
        Hertz::default().build(&three).unwrap(),
        Hertz { plane: PlaneForce::Sphere, ..Hertz::default() }.build(&two).unwrap(),
    ]
}

fn touch(overlap: f64) -> Touch {
    Touch { overlap, radius: RADIUS, length: 2.0 * RADIUS, depth: RADIUS }
}

#[test]
fn force_is_the_derivative_of_energy_and_stiffness_that_of_force() {
    for law in laws() {
        for d in [1e-6, 1e-4, 3e-3] {
            let h = 1e-4 * d;
            let (below, at, above) = (law.at(&touch(d - h)), law.at(&touch(d)), law.at(&touch(d + h)));
            let slope = |a: f64, b: f64| (b - a) / (2.0 * h);
            assert!((slope(below.energy, above.energy) / at.force - 1.0).abs() < 1e-7);
            assert!((slope(below.force, above.force) / at.stiffness - 1.0).abs() < 1e-7);
        }
        assert_eq!(law.at(&touch(0.0)).force, 0.0);
    }
}

#[test]
fn without_hardening_the_penalty_is_linear() {
    let pair = ContactPair { dimension: Dimension::Three, surface: ContactSurface::Particles, modulus: 1.0 };
    let law = Penalty { stiffness: Some(3.0e3), hardening: 0.0, ..Penalty::default() }.build(&pair).unwrap();
    for d in [1e-5, 4e-3, 9e-3] {
        assert!((law.at(&touch(d)).force - 3.0e3 * d).abs() < 1e-12 * d);
    }
}

#[test]
fn the_stiffness_of_an_impact_is_that_where_the_spring_has_all_energy() {
    let (mass, speed) = (0.3, 1.7);
    for law in laws() {
        let energy = 0.5 * mass * speed * speed;
        let (mut low, mut high) = (0.0, 10.0);
        for _ in 0..200 {
            let middle = 0.5 * (low + high);
            if law.at(&touch(middle)).energy < energy { low = middle } else { high = middle }
        }
        let expected = law.at(&touch(low)).stiffness;
        let found = law.stiffness_of_impact(&touch(0.0), mass, speed);
        assert!((found / expected - 1.0).abs() < 1e-9, "{found} {expected}");
    }
}

#[test]
fn parameters_out_of_range_are_refused() {
    let pair = ContactPair { dimension: Dimension::Three, surface: ContactSurface::Particles, modulus: 1.0 };
    assert!(Penalty { stiffness: Some(0.0), ..Penalty::default() }.build(&pair).is_err());
    assert!(Penalty { factor: -1.0, ..Penalty::default() }.build(&pair).is_err());
    assert!(Penalty { hardening: -1.0, ..Penalty::default() }.build(&pair).is_err());
    assert!(Hertz { modulus: Some(f64::NAN), ..Hertz::default() }.build(&pair).is_err());
}
