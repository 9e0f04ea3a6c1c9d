//! The kernels of fluids for four neighbours at once.
//!
//! Particles pair where the Fourier transform of the kernel is negative. Those of Wendland's kernels are
//! positive whatever the number of neighbours, that of the quintic spline up to 190 in three dimensions; the
//! lower splines already pair with the supports of flows (Dehnen & Aly 2012, Monthly Notices of the Royal
//! Astronomical Society 425, 1068-1082).

use crate::kernels::{Kernel, KernelName};
use crate::parallel::Arithmetic;

/// Square of the distance of particles in one place, over that of the support.
const NO_LENGTH: f64 = 1e-24;

/// Which kernel it is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum KernelShape {
    WendlandC2,
    WendlandC4,
    WendlandC6,
    QuinticSpline,
}

/// A kernel of one support radius: functions of the distance r, m.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FluidKernel {
    shape: KernelShape,
    /// Support radius H, m.
    pub support: f64,
    inverse_support: f64,
    /// W(0), 1/m^d.
    value_scale: f64,
    /// Pair weight at r = 0, 1/m^(d+2).
    weight_scale: f64,
}

impl FluidKernel {
    /// Names of the kernels that there are for fluids.
    pub const NAMES: [KernelName; 4] =
        [KernelName::WendlandC2, KernelName::WendlandC4, KernelName::WendlandC6, KernelName::QuinticSpline];

    /// Largest support radius over spacing with which particles do not pair.
    pub fn largest_support(&self) -> f64 {
        if self.shape == KernelShape::QuinticSpline { 3.5 } else { 10.0 }
    }

    /// The kernel of that name and support radius H, m, in two or three dimensions; none if particles pair
    /// with it.
    pub fn new(name: KernelName, support: f64, dimension: usize) -> Option<Self> {
        let shape = match name {
            KernelName::WendlandC2 => KernelShape::WendlandC2,
            KernelName::WendlandC4 => KernelShape::WendlandC4,
            KernelName::WendlandC6 => KernelShape::WendlandC6,
            KernelName::QuinticSpline => KernelShape::QuinticSpline,
            _ => return None,
        };
        let kernel = Kernel::new(name, dimension)?;
        let h = kernel.smoothing_length(support);
        Some(Self {
            shape,
            support,
            inverse_support: 1.0 / support,
            value_scale: kernel.w(0.0, h),
            weight_scale: kernel.pair_weight(0.0, h),
        })
    }

    /// Smoothing length h, m: half of the support with Wendland C2, and with the others that of the Wendland
    /// C2 of the same integral of w over the plane, on which stable steps depend: 14, 18, 22.286 and 17.397
    /// over the square of the support.
    pub fn smoothing_length(&self) -> f64 {
        let share = match self.shape {
            KernelShape::WendlandC2 => 0.5,
            KernelShape::WendlandC4 => 0.440_958_551_844_098_4,
            KernelShape::WendlandC6 => 0.396_296_961_950_608_5,
            KernelShape::QuinticSpline => 0.448_529_218_995_858_5,
        };
        share * self.support
    }

    /// Pair weights w = |W'| / r of four neighbours.
    #[inline(always)]
    pub fn weights<A: Arithmetic>(&self, a: A, r: A::Lanes) -> A::Lanes {
        a.scale(self.weight_scale, self.shapes(a, r))
    }

    /// Pair weights of four neighbours over that of r = 0: for sums that are multiplied with
    /// [`Self::weight_scale`] once. With q = r/H they are (1 - q)^3, (1 - q)^5 (1 + 5 q) and (1 - q)^7 (1 + 7
    /// q + 16 q^2).
    #[inline(always)]
    pub(in crate::formulations::fluid) fn shapes<A: Arithmetic>(&self, a: A, r: A::Lanes) -> A::Lanes {
        let s = a.max_zero(a.scale_add(-self.inverse_support, r, a.splat(1.0)));
        let square = a.mul(s, s);
        let cube = a.mul(square, s);
        let q = a.scale(self.inverse_support, r);
        let one = a.splat(1.0);
        match self.shape {
            KernelShape::WendlandC2 => cube,
            KernelShape::WendlandC4 => a.mul(a.mul(cube, square), a.scale_add(5.0, q, one)),
            KernelShape::WendlandC6 => {
                let slope = a.scale_add(16.0, q, a.splat(7.0));
                a.mul(a.mul(a.mul(cube, square), square), a.mul_add(q, slope, one))
            }
            KernelShape::QuinticSpline => {
                let above_zero = a.max(q, a.splat(MIN_LENGTH));
                a.scale(QUINTIC_WEIGHT, a.div(spline::<A, 4>(a, q), above_zero))
            }
        }
    }

    /// Runs a loop over the weights of this kernel: compiled for Wendland C2 alone, which is the default, and
    /// for all others.
    pub(in crate::formulations::fluid) fn run<L: KernelLoop>(&self, hot: L) -> L::Output {
        match self.shape {
            KernelShape::WendlandC2 => hot.run(WendlandC2Lanes { slope: -self.inverse_support }),
            _ => hot.run(self),
        }
    }

    /// Pair weight at r = 0, 1/m^(d+2).
    #[inline(always)]
    pub(in crate::formulations::fluid) fn weight_scale(&self) -> f64 {
        self.weight_scale
    }

    /// Kernel values W of four neighbours; over W(0), with q = r/H, they are (1 - q)^4 (1 + 4 q), (1 - q)^6
    /// (1 + 6 q + 35/3 q^2) and (1 - q)^8 (1 + 8 q + 25 q^2 + 32 q^3).
    #[inline(always)]
    pub fn values<A: Arithmetic>(&self, a: A, r: A::Lanes) -> A::Lanes {
        let s = a.max_zero(a.scale_add(-self.inverse_support, r, a.splat(1.0)));
        let square = a.mul(s, s);
        let fourth = a.mul(square, square);
        let one = a.splat(1.0);
        let q = a.scale(self.inverse_support, r);
        let shape = match self.shape {
            KernelShape::WendlandC2 => a.mul(fourth, a.scale_add(4.0 * self.inverse_support, r, one)),
            KernelShape::WendlandC4 => {
                let slope = a.scale_add(35.0 / 3.0, q, a.splat(6.0));
                a.mul(a.mul(fourth, square), a.mul_add(q, slope, one))
            }
            KernelShape::WendlandC6 => {
                let slope = a.mul_add(q, a.scale_add(32.0, q, a.splat(25.0)), a.splat(8.0));
                a.mul(a.mul(fourth, fourth), a.mul_add(q, slope, one))
            }
            KernelShape::QuinticSpline => a.scale(1.0 / 66.0, spline::<A, 5>(a, q)),
        };
        a.scale(self.value_scale, shape)
    }

    /// Squared distances above zero, and beyond the support where there is no neighbour; volumes of the
    /// neighbours within the support.
    #[inline(always)]
    pub(in crate::formulations::fluid) fn within<A: Arithmetic>(
        &self,
        a: A,
        square: A::Lanes,
        fill: A::Lanes,
        volume: A::Lanes,
    ) -> (A::Lanes, A::Lanes) {
        let limit = self.support * self.support;
        let square = a.scale_add(limit, fill, square);
        let volume = a.where_below(square, a.splat(limit), volume);
        (a.max(square, a.splat(self.min_square())), volume)
    }

    /// Square of the length of pairs in one place, m2: one may divide by it.
    #[inline(always)]
    pub(in crate::formulations::fluid) fn min_square(&self) -> f64 {
        NO_LENGTH * self.support * self.support
    }

    /// Pair weight of one neighbour.
    #[inline]
    pub fn weight(&self, r: f64) -> f64 {
        let q = r * self.inverse_support;
        let s = (1.0 - q).max(0.0);
        let shape = match self.shape {
            KernelShape::WendlandC2 => s * s * s,
            KernelShape::WendlandC4 => s.powi(5) * (1.0 + 5.0 * q),
            KernelShape::WendlandC6 => s.powi(7) * (1.0 + q * (7.0 + 16.0 * q)),
            KernelShape::QuinticSpline if q == 0.0 => 1.0,
            KernelShape::QuinticSpline => QUINTIC_WEIGHT * truncated_powers(4, q) / q,
        };
        self.weight_scale * shape
    }

    /// Kernel value of one neighbour.
    #[inline]
    pub fn value(&self, r: f64) -> f64 {
        let q = r * self.inverse_support;
        let s = (1.0 - q).max(0.0);
        let shape = match self.shape {
            KernelShape::WendlandC2 => (s * s) * (s * s) * (1.0 + 4.0 * r * self.inverse_support),
            KernelShape::WendlandC4 => s.powi(6) * (1.0 + q * (6.0 + 35.0 / 3.0 * q)),
            KernelShape::WendlandC6 => s.powi(8) * (1.0 + q * (8.0 + q * (25.0 + 32.0 * q))),
            KernelShape::QuinticSpline => truncated_powers(5, q) / 66.0,
        };
        self.value_scale * shape
    }
}

/// Pair weights over that at r = 0, as functions of the distance r, m.
pub trait PairShape: Copy + Sync {
    /// The shape of the pairs of all lanes.
    fn shape<A: Arithmetic>(self, a: A, r: A::Lanes) -> A::Lanes;
}

/// `(1 - r/H)^3`.
#[derive(Clone, Copy)]
pub struct WendlandC2Lanes {
    /// -1/H, 1/m.
    slope: f64,
}

impl PairShape for WendlandC2Lanes {
    #[inline(always)]
    fn shape<A: Arithmetic>(self, a: A, r: A::Lanes) -> A::Lanes {
        let s = a.max_zero(a.scale_add(self.slope, r, a.splat(1.0)));
        a.mul(a.mul(s, s), s)
    }
}

impl PairShape for &FluidKernel {
    #[inline(always)]
    fn shape<A: Arithmetic>(self, a: A, r: A::Lanes) -> A::Lanes {
        self.shapes(a, r)
    }
}

/// A loop over pairs.
pub trait KernelLoop {
    /// Result.
    type Output;
    /// The loop.
    fn run<K: PairShape>(self, kernel: K) -> Self::Output;
}

/// Minimum length that a weight is divided by, over the support: a pair in one place has a weight too.
const MIN_LENGTH: f64 = 1e-12;

/// Factor of the fourth powers over q = r/H in the pair weight of the quintic spline, which is one at q = 0.
const QUINTIC_WEIGHT: f64 = 1.0 / 72.0;

/// `(3 - 3 q)^N - 6 (2 - 3 q)^N + 15 (1 - 3 q)^N` of four q = r/H, each bracket where it is positive.
#[inline(always)]
fn spline<A: Arithmetic, const N: usize>(a: A, q: A::Lanes) -> A::Lanes {
    let power = |knot: f64| {
        let s = a.max_zero(a.scale_add(-3.0, q, a.splat(knot)));
        let square = a.mul(s, s);
        let fourth = a.mul(square, square);
        if N == 5 { a.mul(fourth, s) } else { fourth }
    };
    a.scale_add(15.0, power(1.0), a.scale_add(-6.0, power(2.0), power(3.0)))
}

/// The same of one q.
fn truncated_powers(n: i32, q: f64) -> f64 {
    let power = |knot: f64| (knot - 3.0 * q).max(0.0).powi(n);
    power(3.0) - 6.0 * power(2.0) + 15.0 * power(1.0)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::parallel::{FourLanes, HotLoop, Lanes4, run_hot};

    struct Four<'a>(&'a FluidKernel, Lanes4);

    impl HotLoop for Four<'_> {
        type Output = (Lanes4, Lanes4);

        fn run<A: FourLanes>(self, a: A) -> (Lanes4, Lanes4) {
            (self.0.values(a, self.1), self.0.weights(a, self.1))
        }
    }

    #[test]
    fn they_are_the_kernels_of_their_names() {
        for name in FluidKernel::NAMES {
            for dimension in [2, 3] {
                let fast = FluidKernel::new(name, 0.3, dimension).expect("a kernel");
                let kernel = Kernel::new(name, dimension).expect("a kernel");
                let h = kernel.smoothing_length(0.3);
                let most = [1e-12 * kernel.w(0.0, h), 1e-12 * kernel.pair_weight(0.0, h)];
                for k in 0..40 {
                    let r = 0.01 * f64::from(k) + 1e-3;
                    let (w, weight) = (kernel.w(r, h), kernel.pair_weight(r, h));
                    assert!((fast.value(r) - w).abs() <= most[0], "{name:?} {r}");
                    assert!((fast.weight(r) - weight).abs() <= most[1], "{name:?} {r}");
                    let (values, weights) = run_hot(Four(&fast, Lanes4([1e-3, r, 0.1, 1.0])));
                    assert!((values.0[1] - w).abs() <= most[0], "{name:?} {r}");
                    assert!((weights.0[1] - weight).abs() <= most[1], "{name:?} {r}");
                    assert_eq!((values.0[3], weights.0[3]), (0.0, 0.0));
                }
                assert_eq!(fast.weight(0.0), kernel.pair_weight(0.0, h), "{name:?}");
            }
        }
        assert!(FluidKernel::new(KernelName::CubicSpline, 0.3, 2).is_none());
    }

    /// The integral of w over the plane, times the square of the support, by a sum over rings.
    #[test]
    fn smoothing_lengths_are_those_of_the_same_integral_of_the_weight() {
        for name in FluidKernel::NAMES {
            let kernel = FluidKernel::new(name, 1.0, 2).expect("a kernel");
            let rings = (0..4000).map(|k| (f64::from(k) + 0.5) / 4000.0);
            let integral: f64 = rings.map(|r| std::f64::consts::TAU * r * kernel.weight(r) / 4000.0).sum();
            let h = kernel.smoothing_length();
            assert!((integral * h * h - 3.5).abs() < 1e-5, "{name:?}: {}", integral * h * h);
        }
    }
}
