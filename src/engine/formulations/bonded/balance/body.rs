//! A body whose shares are computed.

use crate::kernels::Kernel;
use crate::plugin::BodyPlan;
use crate::symmetry::Repeat;

/// A body before the first step.
#[derive(Clone, Copy)]
pub(in crate::formulations) struct HeldBody<'a> {
    pub plan: &'a BodyPlan,
    pub kernel: Kernel,
    /// Support radius, m, or the mean of those of the particles.
    pub support: f64,
    /// Number of neighbours for which the support radius of each particle is chosen.
    pub neighbors: Option<u32>,
    pub repeats: &'a [Repeat],
    /// Whether its neighbours and weights are meant to stay those of the start: what balances there balances
    /// later.
    pub stays: bool,
}
