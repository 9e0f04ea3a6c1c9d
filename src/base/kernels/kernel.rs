//! A kernel chosen at run time, and the same kernel as a type for hot loops.

use super::profile::KernelProfile;
use super::registry::{KernelName, KernelVisitor};
use std::marker::PhantomData;

/// Kernel of a given dimension, chosen at run time.
///
/// Its functions branch on the name in each call: loops over pairs use [`Kernel::dispatch`] instead.
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

    /// The kernel that scenes call `name`; `None` if there is none or `dimension` is not 1, 2 or 3.
    pub fn named(name: &str, dimension: usize) -> Option<Self> {
        let name = KernelName::ALL.iter().find(|known| known.as_str() == name)?;
        Self::new(*name, dimension)
    }

    /// Every name that [`Kernel::named`] knows, in the order of registration.
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

    /// Pair weight `w = |dW/dr| / r >= 0` (1/m^(d+2)), so that `grad_i W = w x_ij`. At r = 0: the limit, and
    /// zero for the spiky kernel, which has none.
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

    pub(super) fn profiled<K: KernelProfile>(&self) -> ProfiledKernel<K> {
        ProfiledKernel { dimension: self.dimension, normalisation: self.normalisation, profile: PhantomData }
    }
}

/// [`Kernel`] as a type: the argument of a [`KernelVisitor`].
#[derive(Debug, Clone, Copy)]
pub struct ProfiledKernel<K: KernelProfile> {
    dimension: u32,
    normalisation: f64,
    profile: PhantomData<K>,
}

impl<K: KernelProfile> ProfiledKernel<K> {
    /// The kernel of one smoothing length (m). Costs two divisions: outside the loop where h is the same for
    /// all.
    #[inline]
    pub fn scaled(&self, smoothing_length: f64) -> ScaledKernel<K> {
        let inverse_h = 1.0 / smoothing_length;
        let volume = match self.dimension {
            1 => smoothing_length,
            2 => smoothing_length * smoothing_length,
            _ => smoothing_length * smoothing_length * smoothing_length,
        };
        ScaledKernel { inverse_h, scale: self.normalisation / volume, profile: PhantomData }
    }
}

/// Kernel of one smoothing length: functions of the distance r (m) alone.
#[derive(Debug, Clone, Copy)]
pub struct ScaledKernel<K: KernelProfile> {
    inverse_h: f64,
    scale: f64,
    profile: PhantomData<K>,
}

impl<K: KernelProfile> ScaledKernel<K> {
    /// `W(r)` (1/m^d).
    #[inline]
    pub fn w(&self, r: f64) -> f64 {
        self.scale * K::value(r * self.inverse_h)
    }

    /// `dW/dr <= 0` (1/m^(d+1)).
    #[inline]
    pub fn dw_dr(&self, r: f64) -> f64 {
        self.scale * self.inverse_h * K::derivative(r * self.inverse_h)
    }

    /// `d2W/dr2` (1/m^(d+2)).
    #[inline]
    pub fn d2w_dr2(&self, r: f64) -> f64 {
        self.scale * self.inverse_h * self.inverse_h * K::second_derivative(r * self.inverse_h)
    }

    /// Pair weight `|dW/dr| / r >= 0` (1/m^(d+2)).
    #[inline]
    pub fn pair_weight(&self, r: f64) -> f64 {
        self.scale * self.inverse_h * self.inverse_h * K::weight(r * self.inverse_h)
    }
}
