//! Identities that the decompositions must satisfy.

use super::{Eigen, ExtremeValues, Sym3, extreme_stretches, polar};
use glam::{DMat3, DQuat, DVec3};
use proptest::prelude::*;

fn number() -> impl Strategy<Value = f64> {
    -1.0..1.0_f64
}

prop_compose! {
    fn vector()(x in number(), y in number(), z in number()) -> DVec3 { DVec3::new(x, y, z) }
}

prop_compose! {
    fn rotation()(axis in vector(), angle in -3.2..3.2_f64) -> DMat3 {
        DMat3::from_quat(DQuat::from_axis_angle(axis.try_normalize().unwrap_or(DVec3::X), angle))
    }
}

prop_compose! {
    /// Deformation gradients with stretches over four decades, some of them equal.
    fn deformation()(r in rotation(), n in rotation(), e in vector(), equal in 0..4_u8) -> (DMat3, DVec3) {
        let mut stretch = DVec3::new(100_f64.powf(e.x), 100_f64.powf(e.y), 100_f64.powf(e.z));
        if equal & 1 == 1 { stretch.y = stretch.x; }
        if equal & 2 == 2 { stretch.z = stretch.x; }
        (r * n * DMat3::from_diagonal(stretch) * n.transpose(), stretch)
    }
}

fn distance(a: DMat3, b: DMat3) -> f64 {
    (a - b).to_cols_array().iter().fold(0.0, |m, c| c.abs().max(m))
}

fn sorted(v: DVec3) -> DVec3 {
    let mut v = v.to_array();
    v.sort_by(f64::total_cmp);
    DVec3::from(v)
}

proptest! {
    #![proptest_config(ProptestConfig { failure_persistence: None, ..ProptestConfig::with_cases(1000) })]

    #[test]
    fn symmetric_algebra_is_that_of_full_matrices(a in vector(), b in vector(), c in vector(), v in vector(), s in number()) {
        let m = Sym3::symmetric_part(DMat3::from_cols(a, b, c));
        let full = m.to_matrix();
        prop_assert!(distance(full, 0.5 * (DMat3::from_cols(a, b, c) + DMat3::from_cols(a, b, c).transpose())) < 1e-15);
        prop_assert!((m * v - full * v).length() < 1e-15);
        prop_assert!((m.determinant() - full.determinant()).abs() < 1e-15);
        prop_assert!((m.trace() - (full.x_axis.x + full.y_axis.y + full.z_axis.z)).abs() < 1e-15);
        let gram = Sym3::gram(DMat3::from_cols(a, b, c)).to_matrix();
        prop_assert!(distance(gram, DMat3::from_cols(a, b, c).transpose() * DMat3::from_cols(a, b, c)) < 1e-15);
        let other = Sym3::dyad(v);
        prop_assert!((m.double_dot(&other) - v.dot(full * v)).abs() < 1e-14);
        prop_assert!((m.norm() - full.to_cols_array().iter().map(|x| x * x).sum::<f64>().sqrt()).abs() < 1e-14);
        prop_assert!(m.deviator().trace().abs() < 1e-15);
        let mut sum = m * s - other;
        sum += s * other;
        let expected = full * s + other.to_matrix() * (s - 1.0);
        prop_assert!(distance(sum.to_matrix(), expected) < 1e-14);
        prop_assert_eq!(-sum + sum, Sym3::ZERO);
    }

    #[test]
    fn inverse_times_matrix_is_identity((f, stretch) in deformation()) {
        let c = Sym3::gram(f);
        let condition = (stretch.max_element() / stretch.min_element()).powi(2);
        let product = c.to_matrix() * c.inverse().to_matrix();
        prop_assert!(distance(product, DMat3::IDENTITY) < 1e-14 + 1e-14 * condition.powi(2));
    }

    #[test]
    fn eigenvectors_diagonalise((f, stretch) in deformation(), shift in number()) {
        let c = Sym3::gram(f) + Sym3::IDENTITY * shift;
        let eigen = Eigen::new(&c);
        let scale = stretch.max_element().powi(2) + 1.0;
        prop_assert!(distance(eigen.vectors.transpose() * eigen.vectors, DMat3::IDENTITY) < 1e-14);
        let diagonal = DMat3::from_diagonal(eigen.values);
        prop_assert!(distance(c.to_matrix() * eigen.vectors, eigen.vectors * diagonal) < 1e-14 * scale);
        prop_assert!(distance(eigen.map(|value| value).to_matrix(), c.to_matrix()) < 1e-14 * scale);
        let expected = sorted(stretch * stretch + DVec3::splat(shift));
        prop_assert!((eigen.values - expected).abs().max_element() < 1e-13 * scale);
    }

    #[test]
    fn logarithm_and_exponential_agree_with_jacobi(r in rotation(), e in vector(), size in 0.0..0.2_f64) {
        // On both sides of the switch from series to eigenvalues, and with coincident eigenvalues.
        for strain in [e * size, DVec3::splat(e.x * size), DVec3::new(e.x, e.x, e.y) * size] {
            let of = |f: fn(f64) -> f64| Sym3::symmetric_part(r * DMat3::from_diagonal(strain.map(f)) * r.transpose());
            let square = of(|e| (2.0 * e).exp());
            prop_assert!(distance(square.half_log().to_matrix(), of(|e| e).to_matrix()) < 1e-12);
            prop_assert!(distance((of(|e| e) * 2.0).exp().to_matrix(), square.to_matrix()) < 1e-12);
        }
    }

    #[test]
    fn closed_form_stretches_agree_with_jacobi((f, stretch) in deformation()) {
        let ExtremeValues { smallest, largest } = extreme_stretches(f);
        let squares = Eigen::new(&Sym3::gram(f)).values;
        prop_assert!((smallest * smallest - squares.x).abs() < 1e-7 * squares.z);
        prop_assert!((largest * largest - squares.z).abs() < 1e-7 * squares.z);
        // The usual range of a time-step limit.
        if stretch.min_element() > 0.2 * stretch.max_element() {
            prop_assert!((smallest / stretch.min_element() - 1.0).abs() < 1e-6);
            prop_assert!((largest / stretch.max_element() - 1.0).abs() < 1e-6);
        }
    }

    #[test]
    fn polar_factors_are_a_rotation_and_a_stretch((f, stretch) in deformation()) {
        let (r, u) = polar(f).unwrap();
        prop_assert!(distance(r.transpose() * r, DMat3::IDENTITY) < 1e-14);
        prop_assert!((r.determinant() - 1.0).abs() < 1e-14);
        prop_assert!(distance(r * u.to_matrix(), f) < 1e-13 * stretch.max_element());
        let root = Eigen::new(&Sym3::gram(f)).map(f64::sqrt);
        prop_assert!(distance(u.to_matrix(), root.to_matrix()) < 1e-10 * stretch.max_element());
    }
}

#[test]
fn undeformed_and_rigid_states_are_exact() {
    assert_eq!(extreme_stretches(DMat3::IDENTITY), ExtremeValues { smallest: 1.0, largest: 1.0 });
    let (r, u) = polar(DMat3::IDENTITY).unwrap();
    assert_eq!((r, u), (DMat3::IDENTITY, Sym3::IDENTITY));
    let eigen = Eigen::new(&Sym3::from_diagonal(DVec3::new(3.0, -1.0, 2.0)));
    assert_eq!(eigen.values, DVec3::new(-1.0, 2.0, 3.0));
    assert_eq!(eigen.vectors, DMat3::from_cols(DVec3::Y, DVec3::Z, DVec3::X));
    assert_eq!(Eigen::new(&Sym3::ZERO).values, DVec3::ZERO);
    assert_eq!(extreme_stretches(DMat3::ZERO), ExtremeValues { smallest: 0.0, largest: 0.0 });
}

#[test]
fn what_cannot_be_decomposed_is_said() {
    assert!(polar(DMat3::ZERO).is_none());
    assert!(polar(DMat3::from_diagonal(DVec3::new(1.0, 1.0, -1.0))).is_none());
    assert!(polar(DMat3::from_diagonal(DVec3::new(1.0, 1.0, 0.0))).is_none());
    assert!(polar(DMat3::from_diagonal(DVec3::new(1.0, f64::NAN, 1.0))).is_none());
    assert!(polar(DMat3::from_diagonal(DVec3::new(f64::INFINITY, 1.0, 1.0))).is_none());
    let ExtremeValues { smallest, largest } =
        extreme_stretches(DMat3::from_diagonal(DVec3::new(1.0, f64::NAN, 1.0)));
    assert!(smallest.is_nan() && largest.is_nan());
    assert!(Eigen::new(&Sym3 { xy: f64::NAN, ..Sym3::IDENTITY }).values.is_nan());
}
