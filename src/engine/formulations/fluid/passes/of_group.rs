//! The force of a flow on the particles of one body, by the pass in blocks or by the pass over single
//! particles.

use glam::DVec3;

use super::blocks::BlockForce;
use super::pair_force::PairForce;
use crate::formulations::fluid::cloud::{FlowCloud, Group, PARTS};
use crate::formulations::fluid::lists::blocks::Blocks;
use crate::pair::PhaseTerms;
use crate::parallel::{share_rows, share_wide_rows};
use crate::schedule::{Step, StepError};
use crate::world::Force;

impl FlowCloud {
    /// The blocks of the particles of a body: boundaries have none where thin bodies hide near particles from
    /// some.
    fn blocks_of(&self, group: &Group) -> Option<&Blocks> {
        self.blocks.as_deref().filter(|blocks| group.fluid().is_some() || !blocks.hides)
    }

    /// Writes the forces on all particles of a body and [`PARTS`] parts of each, N.
    pub(in crate::formulations::fluid) fn force(
        &self,
        group: &Group,
        total: &mut [Force],
        parts: &mut [DVec3],
    ) {
        self.own_force(group, false, total, parts);
        share_rows(total);
        share_wide_rows(parts, PARTS);
    }

    /// The same for the particles that this rank computes; the force `adds` to the present values, or
    /// replaces them.
    pub(in crate::formulations::fluid) fn own_force(
        &self,
        group: &Group,
        adds: bool,
        total: &mut [Force],
        parts: &mut [DVec3],
    ) {
        match self.blocks_of(group) {
            Some(blocks) => BlockForce { cloud: self, group, blocks, adds }.run(total, parts),
            None => PairForce { cloud: self, group, adds }.run(total, parts),
        }
    }

    /// [`FlowCloud::own_force`] on a fluid, replacing the present values, with the pair terms of the body.
    pub(in crate::formulations::fluid) fn force_with(
        &self,
        group: &Group,
        terms: &mut PhaseTerms,
        step: &mut Step<'_>,
        total: &mut [Force],
        parts: &mut [DVec3],
    ) -> Result<(), StepError> {
        match self.blocks_of(group) {
            Some(blocks) => {
                BlockForce { cloud: self, group, blocks, adds: false }.run_with(terms, step, total, parts)
            }
            None => PairForce { cloud: self, group, adds: false }.run_with(terms, step, total, parts),
        }
    }
}
