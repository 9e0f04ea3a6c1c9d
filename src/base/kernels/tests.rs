//! Case K1: values, normalisation, derivatives, support.

use super::{Kernel, KernelName, KernelProfile, KernelVisitor, ProfiledKernel};
use std::f64::consts::PI;

fn every_kernel() -> impl Iterator<Item = Kernel> {
    KernelName::ALL.iter().flat_map(|&name| (1..=3).map(move |dim| Kernel::new(name, dim).unwrap()))
}

fn kernel(name: &str, dim: usize) -> Kernel {
    Kernel::named(name, dim).unwrap()
}

/// Five-point Gauss-Legendre rule on [a, b].
fn gauss(a: f64, b: f64, f: impl Fn(f64) -> f64) -> f64 {
    let (s, c) = (0.5 * (b - a), 0.5 * (a + b));
    let (x1, x2) = (
        (5.0 - 2.0 * (10.0_f64 / 7.0).sqrt()).sqrt() / 3.0,
        (5.0 + 2.0 * (10.0_f64 / 7.0).sqrt()).sqrt() / 3.0,
    );
    let (w1, w2) = ((322.0 + 13.0 * 70.0_f64.sqrt()) / 900.0, (322.0 - 13.0 * 70.0_f64.sqrt()) / 900.0);
    s * (128.0 / 225.0 * f(c) + w1 * (f(c - s * x1) + f(c + s * x1)) + w2 * (f(c - s * x2) + f(c + s * x2)))
}

#[test]
fn central_values_are_the_published_ones() {
    for (name, two, three) in [
        ("cubic_spline", 10.0 / (7.0 * PI), 1.0 / PI),
        ("wendland_c2", 7.0 / (4.0 * PI), 21.0 / (16.0 * PI)),
        ("wendland_c4", 9.0 / (4.0 * PI), 495.0 / (256.0 * PI)),
        ("wendland_c6", 78.0 / (28.0 * PI), 1365.0 / (512.0 * PI)),
        ("quintic_spline", 66.0 * 7.0 / (478.0 * PI), 66.0 / (120.0 * PI)),
        ("spiky", 10.0 / (4.0 * PI), 15.0 / (8.0 * PI)),
    ] {
        assert!((kernel(name, 2).w(0.0, 1.0) - two).abs() < 1e-14, "{name}");
        assert!((kernel(name, 3).w(0.0, 1.0) - three).abs() < 1e-14, "{name}");
    }
    assert!((kernel("cubic_spline", 1).w(0.0, 1.0) - 2.0 / 3.0).abs() < 1e-14);
}

#[test]
fn spiky_is_written_in_the_support_radius() {
    let (support, r) = (0.7_f64, 0.31);
    for (dim, expected) in [
        (2, 10.0 / (PI * support.powi(5)) * (support - r).powi(3)),
        (3, 15.0 / (PI * support.powi(6)) * (support - r).powi(3)),
    ] {
        let k = kernel("spiky", dim);
        let w = k.w(r, k.smoothing_length(support));
        assert!((w / expected - 1.0).abs() < 1e-13);
    }
}

#[test]
fn integral_over_space_is_one() {
    for k in every_kernel() {
        for h in [1.0, 0.37] {
            let panels = 120;
            let width = k.support_radius(h) / panels as f64;
            let integral: f64 = (0..panels)
                .map(|i| {
                    gauss(i as f64 * width, (i + 1) as f64 * width, |r| {
                        let shell = [2.0, 2.0 * PI * r, 4.0 * PI * r * r][k.dimension() - 1];
                        shell * k.w(r, h)
                    })
                })
                .sum();
            assert!((integral - 1.0).abs() < 1e-12, "{k:?}: {integral}");
        }
    }
}

#[test]
fn derivatives_agree_with_differences() {
    for k in every_kernel() {
        let h = 0.8;
        let (step, w0) = (1e-5, k.w(0.0, h));
        for i in 1..400 {
            let r = k.support_radius(h) * (i as f64 + 0.123) / 402.0;
            let first = (k.w(r + step, h) - k.w(r - step, h)) / (2.0 * step);
            let second = (k.dw_dr(r + step, h) - k.dw_dr(r - step, h)) / (2.0 * step);
            assert!((first - k.dw_dr(r, h)).abs() < 1e-8 * w0, "{k:?} r {r}");
            assert!((second - k.d2w_dr2(r, h)).abs() < 1e-7 * w0, "{k:?} r {r}");
            assert!((k.pair_weight(r, h) * r + k.dw_dr(r, h)).abs() < 1e-12 * w0, "{k:?} r {r}");
        }
    }
}

#[test]
fn pair_weight_at_the_centre_is_the_limit() {
    for k in every_kernel() {
        let (at_zero, h) = (k.pair_weight(0.0, 1.3), 1.3);
        if k.name() == KernelName::Spiky {
            assert_eq!(at_zero, 0.0);
        } else {
            // f is even and smooth at the centre: -W'(r)/r tends to -W''(0).
            assert!((at_zero + k.d2w_dr2(0.0, h)).abs() < 1e-13 * at_zero, "{k:?}");
        }
    }
}

#[test]
fn zero_at_and_beyond_the_support_and_falling_inside() {
    for k in every_kernel() {
        let edge = k.support_radius(1.0);
        for r in [edge, edge * (1.0 + 1e-15), 1.5 * edge, 1e6] {
            assert_eq!(k.w(r, 1.0), 0.0, "{k:?}");
            assert_eq!(k.dw_dr(r, 1.0).abs(), 0.0, "{k:?}");
            assert_eq!(k.d2w_dr2(r, 1.0).abs(), 0.0, "{k:?}");
            assert_eq!(k.pair_weight(r, 1.0), 0.0, "{k:?}");
        }
        let mut previous = k.w(0.0, 1.0);
        for i in 1..1000 {
            let r = edge * i as f64 / 1000.0;
            let w = k.w(r, 1.0);
            assert!(w < previous && w > 0.0 && k.dw_dr(r, 1.0) < 0.0, "{k:?} r {r}");
            previous = w;
        }
    }
}

#[test]
fn lengths_are_inverse_of_each_other() {
    for (name, ratio) in
        [("cubic_spline", 2.0), ("quartic_spline", 2.5), ("quintic_spline", 3.0), ("spiky", 2.0)]
    {
        let k = kernel(name, 3);
        assert_eq!(k.support_radius(1.5), 1.5 * ratio);
        assert!((k.smoothing_length(k.support_radius(0.3)) - 0.3).abs() < 1e-16);
    }
}

#[test]
fn names_are_the_ones_of_scenes() {
    assert!(Kernel::named("gaussian", 2).is_none());
    assert!(Kernel::named("spiky", 0).is_none() && Kernel::named("spiky", 4).is_none());
    for (&name, text) in KernelName::ALL.iter().zip(Kernel::names()) {
        assert_eq!(ron::from_str::<KernelName>(text).unwrap(), name);
        assert_eq!(ron::to_string(&name).unwrap(), text);
        assert!(!name.reference().is_empty());
    }
    let error = ron::from_str::<KernelName>("wendland_c3").unwrap_err().to_string();
    for text in Kernel::names().chain(["wendland_c3"]) {
        assert!(error.contains(text), "{error}");
    }
}

#[test]
fn dispatch_runs_the_same_kernel() {
    struct Sum(f64);
    impl KernelVisitor for Sum {
        type Output = (&'static str, f64);
        fn visit<K: KernelProfile>(self, kernel: ProfiledKernel<K>) -> Self::Output {
            let scaled = kernel.scaled(self.0);
            (K::NAME, (0..20).map(|i| scaled.w(0.1 * i as f64)).sum())
        }
    }
    for k in every_kernel() {
        let expected: f64 = (0..20).map(|i| k.w(0.1 * i as f64, 0.9)).sum();
        assert_eq!(k.dispatch(Sum(0.9)), (k.name().as_str(), expected));
    }
}
