//! Bounds of stiffness and damping of the pair terms of a particle, and the stable step from them.

use bytemuck::{Pod, Zeroable};

use super::block::TermSums;
use crate::parallel::{BlockSum, EIGHT};
use crate::schedule::Step;
use crate::world::BodyId;

/// Share of the critical step that is used where a stiff pair term limits it.
const STIFFNESS_SAFETY: f64 = 0.65;

/// Share of the step at which a damping pair term would turn a velocity around.
const DAMPING_SAFETY: f64 = 0.5;

/// The largest rates of a block.
#[derive(Clone, Copy, Debug, Default, Pod, Zeroable)]
#[repr(C)]
pub(crate) struct RateBounds {
    pub(super) damping: f64,
    pub(super) stiffness: f64,
}

impl RateBounds {
    /// Limits the step.
    pub fn limit(&self, step: &mut Step<'_>, id: BodyId) {
        let name = &step.world.body(id).name;
        if self.damping > 0.0 {
            let limit = DAMPING_SAFETY / self.damping;
            step.limits.propose(limit, format_args!("viscosity of `{name}`"));
        }
        if self.stiffness > 0.0 {
            let limit = STIFFNESS_SAFETY * 2.0 / self.stiffness.sqrt();
            step.limits.propose(limit, format_args!("pair stiffness of `{name}`"));
        }
    }

    /// The largest of a block of particles.
    #[inline]
    pub fn add_block(&mut self, sums: &[TermSums]) {
        let mut of_lane = [Self::default(); EIGHT];
        for sums in sums {
            for (lane, fastest) in of_lane.iter_mut().enumerate() {
                fastest.damping += f64::from(sums.damping.0[lane]);
                fastest.stiffness += f64::from(sums.stiffness.0[lane]);
            }
        }
        of_lane.iter().for_each(|fastest| self.add(fastest));
    }
}

impl BlockSum for RateBounds {
    #[inline]
    fn add(&mut self, next: &Self) {
        self.damping = self.damping.max(next.damping);
        self.stiffness = self.stiffness.max(next.stiffness);
    }
}
