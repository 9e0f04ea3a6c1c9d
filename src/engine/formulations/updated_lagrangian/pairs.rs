//! The pairs of the reference, for pair terms.

use super::phase::UpdatedRows;
use crate::formulations::total_lagrangian::{BodyKernel, BodyPairs};
use crate::pair::{PairReads, PairRows, PairSource};
use crate::scene::Dimension;
use crate::schedule::{Step, StepError};
use crate::world::{BodyId, PhaseId, SupportRadius, Velocity};

/// Gives pair terms the pairs of the phase.
pub(super) struct UpdatedPairs {
    pub phase: PhaseId,
}

impl PairSource for UpdatedPairs {
    fn with_rows(
        &self,
        step: &Step<'_>,
        body: BodyId,
        reads: PairReads,
        run: &mut dyn FnMut(&dyn PairRows) -> Result<(), StepError>,
    ) -> Result<(), StepError> {
        let packed = step.resources.solid_rows::<UpdatedRows>(self.phase);
        let view = step.world.phase(self.phase);
        let support = view.read::<SupportRadius>()?;
        let velocity = if reads.velocity { Some(view.read::<Velocity>()?) } else { None };
        let UpdatedRows { bonds, ghosts, sites, kernels, .. } = &*packed;
        let Some(BodyKernel { kernel, support: uniform, .. }) = kernels.iter().find(|of| of.body == body)
        else {
            return Ok(());
        };
        run(&BodyPairs {
            bonds,
            ghosts,
            sites,
            support: &support,
            uniform: *uniform,
            velocity: velocity.as_deref(),
            kernel: reads.kernel.then_some(kernel),
            plane: step.world.dimension() == Dimension::Two,
        })
    }
}
