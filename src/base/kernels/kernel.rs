//! A kernel chosen at run time.

use super::profile::KernelProfile;
use super::profiled::ProfiledKernel;
use super::registry::{KernelName, KernelVisitor};

/// Kernel of a given dimension, chosen at run time.
///
/// Its functions branch on the name in each call, so loops over pairs use [`Kernel::dispatch`] instead.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Kernel {
    name: KernelName,
    dimension: u32,
    normalisation: f64,
}

impl Kernel {
    /// The kernel normalised for `dimension` 1, 2 or 3; `None` for any other.
    pub fn new(name: KernelName, dimension: usize) -> Option<Self> {
        Some(Self { name, dimension: dimension as u32, normalisation: name.normalisation(dimension)? })
    }

    /// The kernel registered as `name`; `None` if there is none or `dimension` is not 1, 2 or 3.
    pub fn named(name: &str, dimension: usize) -> Option<Self> {
        let name = KernelName::ALL.iter().find(|known| known.as_str() == name)?;
        Self::new(*name, dimension)
    }

    /// All registered names, in the order of registration.
    pub fn names() -> impl Iterator<Item = &'static str> {
        KernelName::ALL.iter().map(|name| name.as_str())
    }

    /// Name of the kernel.
    pub const fn name(&self) -> KernelName {
        self.name
    }

    /// Dimension that the kernel is normalised for.
    pub const fn dimension(&self) -> usize {
        self.dimension as usize
    }

    /// Support radius H (m) of a smoothing length (m).
    pub fn support_radius(&self, smoothing_length: f64) -> f64 {
        self.name.support() * smoothing_length
    }

    /// Smoothing length h (m) of a support radius (m).
    pub fn smoothing_length(&self, support_radius: f64) -> f64 {
        support_radius / self.name.support()
    }

    /// `W(r, h)` (1/m^d).
    pub fn w(&self, r: f64, smoothing_length: f64) -> f64 {
        struct ValueOf(f64, f64);
        impl KernelVisitor for ValueOf {
            type Output = f64;
            fn visit<K: KernelProfile>(self, kernel: ProfiledKernel<K>) -> f64 {
                kernel.scaled(self.1).w(self.0)
            }
        }
        self.dispatch(ValueOf(r, smoothing_length))
    }

    /// `dW/dr <= 0` (1/m^(d+1)).
    pub fn dw_dr(&self, r: f64, smoothing_length: f64) -> f64 {
        struct Slope(f64, f64);
        impl KernelVisitor for Slope {
            type Output = f64;
            fn visit<K: KernelProfile>(self, kernel: ProfiledKernel<K>) -> f64 {
                kernel.scaled(self.1).dw_dr(self.0)
            }
        }
        self.dispatch(Slope(r, smoothing_length))
    }

    /// `d2W/dr2` (1/m^(d+2)).
    pub fn d2w_dr2(&self, r: f64, smoothing_length: f64) -> f64 {
        struct Curvature(f64, f64);
        impl KernelVisitor for Curvature {
            type Output = f64;
            fn visit<K: KernelProfile>(self, kernel: ProfiledKernel<K>) -> f64 {
                kernel.scaled(self.1).d2w_dr2(self.0)
            }
        }
        self.dispatch(Curvature(r, smoothing_length))
    }

    /// Pair weight `w = |dW/dr| / r >= 0` (1/m^(d+2)), so that `grad_i W = w x_ij`. At r = 0 it is the limit,
    /// or zero for the spiky kernel, whose limit is infinite.
    pub fn pair_weight(&self, r: f64, smoothing_length: f64) -> f64 {
        struct Weight(f64, f64);
        impl KernelVisitor for Weight {
            type Output = f64;
            fn visit<K: KernelProfile>(self, kernel: ProfiledKernel<K>) -> f64 {
                kernel.scaled(self.1).pair_weight(self.0)
            }
        }
        self.dispatch(Weight(r, smoothing_length))
    }

    /// Runs `visitor` in the version compiled for this kernel: one branch per call, none per pair.
    #[inline]
    pub fn dispatch<V: KernelVisitor>(&self, visitor: V) -> V::Output {
        self.name.dispatch(self.dimension, self.normalisation, visitor)
    }
}
