//! A kernel as a type parameter, for hot loops.

use super::profile::KernelProfile;
use std::marker::PhantomData;

/// [`Kernel`](super::Kernel) as a type: the argument of a [`KernelVisitor`](super::KernelVisitor).
#[derive(Debug, Clone, Copy)]
pub struct ProfiledKernel<K: KernelProfile> {
    dimension: u32,
    normalisation: f64,
    profile: PhantomData<K>,
}

impl<K: KernelProfile> ProfiledKernel<K> {
    pub(super) fn new(dimension: u32, normalisation: f64) -> Self {
        Self { dimension, normalisation, profile: PhantomData }
    }

    /// The kernel of one smoothing length (m). It costs two divisions, so it is computed outside the loop
    /// where h is uniform.
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

/// Kernel of one smoothing length, whose functions depend on the distance r (m) alone.
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
