//! The trait that a kernel file implements.

/// Profile of a kernel, `f(q)` with `q = r / h >= 0`, and its constants.
///
/// Every function of q is exactly zero for `q >= SUPPORT` and has no branch that would prevent the
/// vectorisation of a loop over neighbours.
pub trait KernelProfile: Copy + Default + Send + Sync + 'static {
    /// Name in scenes, in snake case.
    const NAME: &'static str;
    /// Support radius over smoothing length, `H / h`.
    const SUPPORT: f64;
    /// Normalisation factors sigma_d in one, two and three dimensions.
    const NORMALISATION: [f64; 3];
    /// Source of the kernel; printed in the run log.
    const REFERENCE: &'static str;

    /// `f(q)`.
    fn value(q: f64) -> f64;

    /// `f'(q) <= 0`.
    fn derivative(q: f64) -> f64;

    /// `f''(q)`.
    fn second_derivative(q: f64) -> f64;

    /// `-f'(q) / q >= 0`: at q = 0 the limit where it exists, else zero, because a pair of coincident
    /// particles has no direction. Kernels with a closed form avoid the division.
    #[inline]
    fn weight(q: f64) -> f64 {
        if q > 0.0 { -Self::derivative(q) / q } else { 0.0 }
    }

    /// sigma_d of `dimension` 1, 2 or 3; `None` for any other.
    #[inline]
    fn normalisation(dimension: usize) -> Option<f64> {
        Self::NORMALISATION.get(dimension.wrapping_sub(1)).copied()
    }
}

/// `max(edge - q, 0)`: the factor from which all compact profiles are built.
#[inline]
pub(super) fn below(edge: f64, q: f64) -> f64 {
    if q < edge { edge - q } else { 0.0 }
}
