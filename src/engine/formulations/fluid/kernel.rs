//! The kernel of fluids, Wendland C2, for four neighbours at once.

use crate::kernels::{Kernel, KernelName};
use crate::parallel::{Arithmetic, Lanes4};

/// Square of the distance of particles in one place, over that of the support.
const NO_LENGTH: f64 = 1e-24;

/// Wendland C2 of one smoothing length: functions of the distance r, m.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FluidKernel {
    /// Support radius H = 2 h, m.
    pub support: f64,
    inverse_support: f64,
    /// W(0), 1/m^d.
    value_scale: f64,
    /// Pair weight at r = 0, 1/m^(d+2).
    weight_scale: f64,
}

impl FluidKernel {
    /// The kernel of support radius H, m, in two or three dimensions.
    pub fn new(support: f64, dimension: usize) -> Self {
        let Some(kernel) = Kernel::new(KernelName::WendlandC2, dimension) else {
            unreachable!("every kernel has a two- and a three-dimensional form");
        };
        let h = kernel.smoothing_length(support);
        Self {
            support,
            inverse_support: 1.0 / support,
            value_scale: kernel.w(0.0, h),
            weight_scale: kernel.pair_weight(0.0, h),
        }
    }

    /// Smoothing length h, m.
    pub fn smoothing_length(&self) -> f64 {
        0.5 * self.support
    }

    /// Pair weights w = |W'| / r = w(0) (1 - r/H)^3 of four neighbours.
    #[inline(always)]
    pub fn weights<A: Arithmetic>(&self, a: A, r: Lanes4) -> Lanes4 {
        a.scale(self.weight_scale, self.shapes(a, r))
    }

    /// Pair weights of four neighbours over that of r = 0: for sums that are multiplied with [`Self::weight_scale`] once.
    #[inline(always)]
    pub(super) fn shapes<A: Arithmetic>(&self, a: A, r: Lanes4) -> Lanes4 {
        let s = a.or_zero(a.scale_add(-self.inverse_support, r, Lanes4::splat(1.0)));
        a.times(a.times(s, s), s)
    }

    /// Pair weight at r = 0, 1/m^(d+2).
    #[inline(always)]
    pub(super) fn weight_scale(&self) -> f64 {
        self.weight_scale
    }

    /// Kernel values W = W(0) (1 - r/H)^4 (1 + 4 r/H) of four neighbours.
    #[inline(always)]
    pub fn values<A: Arithmetic>(&self, a: A, r: Lanes4) -> Lanes4 {
        let s = a.or_zero(a.scale_add(-self.inverse_support, r, Lanes4::splat(1.0)));
        let square = a.times(s, s);
        let slope = a.scale_add(4.0 * self.inverse_support, r, Lanes4::splat(1.0));
        a.scale(self.value_scale, a.times(a.times(square, square), slope))
    }

    /// Squared distances above zero, and beyond the support where there is no neighbour; volumes of the neighbours within the
    /// support.
    #[inline(always)]
    pub(super) fn within<A: Arithmetic>(
        &self,
        a: A,
        square: Lanes4,
        fill: Lanes4,
        volume: Lanes4,
    ) -> (Lanes4, Lanes4) {
        let limit = self.support * self.support;
        let square = a.scale_add(limit, fill, square);
        let volume = a.where_below(square, Lanes4::splat(limit), volume);
        (a.larger(square, Lanes4::splat(self.least_square())), volume)
    }

    /// Square of the length of pairs in one place, m2: one may divide by it.
    #[inline(always)]
    pub(super) fn least_square(&self) -> f64 {
        NO_LENGTH * self.support * self.support
    }

    /// Pair weight of one neighbour.
    #[inline]
    pub fn weight(&self, r: f64) -> f64 {
        let s = (1.0 - r * self.inverse_support).max(0.0);
        self.weight_scale * (s * s * s)
    }

    /// Kernel value of one neighbour.
    #[inline]
    pub fn value(&self, r: f64) -> f64 {
        let s = (1.0 - r * self.inverse_support).max(0.0);
        self.value_scale * (s * s) * (s * s) * (1.0 + 4.0 * r * self.inverse_support)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::parallel::{HotLoop, run_hot};

    struct Four<'a>(&'a FluidKernel, Lanes4);

    impl HotLoop for Four<'_> {
        type Output = (Lanes4, Lanes4);

        fn run<A: Arithmetic>(self, a: A) -> (Lanes4, Lanes4) {
            (self.0.values(a, self.1), self.0.weights(a, self.1))
        }
    }

    #[test]
    fn it_is_the_kernel_of_that_name() {
        for dimension in [2, 3] {
            let (fast, kernel) = (
                FluidKernel::new(0.3, dimension),
                Kernel::new(KernelName::WendlandC2, dimension).expect("a kernel"),
            );
            for k in 0..40 {
                let r = 0.01 * f64::from(k);
                let (w, weight) = (kernel.w(r, 0.15), kernel.pair_weight(r, 0.15));
                assert!((fast.value(r) - w).abs() <= 1e-13 * kernel.w(0.0, 0.15), "{r}");
                assert!((fast.weight(r) - weight).abs() <= 1e-13 * kernel.pair_weight(0.0, 0.15), "{r}");
                let (values, weights) = run_hot(Four(&fast, Lanes4([0.0, r, 0.1, 1.0])));
                assert!((values.0[1] - w).abs() <= 1e-13 * kernel.w(0.0, 0.15), "{r}");
                assert!((weights.0[1] - weight).abs() <= 1e-13 * kernel.pair_weight(0.0, 0.15), "{r}");
                assert_eq!((values.0[3], weights.0[3]), (0.0, 0.0));
            }
        }
    }
}
