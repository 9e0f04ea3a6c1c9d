//! A body before its bonds are built, and the effects of supports on it.

use super::pairs::BodyKernel;
use super::{HeldBody, HeldParticles};
use crate::kernels::{Kernel, KernelName};
use crate::plugin::SimBuilder;
use crate::solids::{HessianDifference, StepEstimate};
use crate::symmetry::Repeat;
use crate::world::BodyId;

/// A body with the input of its bonds.
pub(in crate::formulations) struct BodySetUp {
    pub id: BodyId,
    pub kernel: KernelName,
    /// Support radius, m.
    pub support: f64,
    /// Number of neighbours for which the support radius of each particle is chosen instead.
    pub neighbors: Option<u32>,
    pub estimate: StepEstimate,
    pub hessian: Option<HessianDifference>,
    pub repeats: Vec<Repeat>,
    /// Whether neighbours and weights are meant to stay those of the start.
    pub stays: bool,
}

impl BodySetUp {
    /// Its kernel in that many dimensions.
    pub fn kernel(&self, dimension: usize) -> BodyKernel {
        let Some(kernel) = Kernel::new(self.kernel, dimension) else {
            unreachable!("every kernel has a two- and a three-dimensional form");
        };
        BodyKernel { body: self.id, kernel, support: self.neighbors.is_none().then_some(self.support) }
    }
}

/// Effects of supports on the bodies of a phase.
pub(in crate::formulations) fn held_of(bodies: &[BodySetUp], sim: &SimBuilder<'_>) -> HeldParticles {
    let dimension = sim.dimension().count();
    let held = bodies.iter().map(|body| {
        let plan = sim.body(body.id);
        HeldBody {
            plan,
            kernel: body.kernel(dimension).kernel,
            support: plan.support.unwrap_or(body.support),
            neighbors: body.neighbors,
            repeats: &body.repeats,
            stays: body.stays,
        }
    });
    HeldParticles::of(&held.collect::<Vec<_>>(), sim)
}
