//! The pairs of a body for pair terms: those within the support, with original and present pair vectors.

use std::ops::Range;

use glam::DVec3;

use super::rows::EulerianRows;
use crate::kernels::Kernel;
use crate::pair::{Extras, Neighbor, PairBatch, PairReads, PairRows, PairSource, WeightAt};
use crate::schedule::{Step, StepError};
use crate::world::{BodyId, PhaseId, ReferencePosition};

/// Gives pair terms the neighbours of the phase.
pub(super) struct EulerianPairs(pub PhaseId);

impl PairSource for EulerianPairs {
    fn with_rows(
        &self,
        step: &Step<'_>,
        body: BodyId,
        reads: PairReads,
        run: &mut dyn FnMut(&dyn PairRows) -> Result<(), StepError>,
    ) -> Result<(), StepError> {
        let packed = step.resources.solid_rows::<EulerianRows>(self.0);
        let reference = step.world.phase(self.0).read::<ReferencePosition>()?;
        let Some(k) = packed.lists.bodies.iter().position(|of| of.id == body) else { return Ok(()) };
        run(&BodyPairs {
            packed: &packed,
            reference: bytemuck::cast_slice(&reference),
            support: packed.lists.bodies[k].support,
            kernel: reads.kernel.then_some(packed.kernels[k].kernel),
        })
    }
}

/// The pairs of one body.
struct BodyPairs<'a> {
    packed: &'a EulerianRows,
    reference: &'a [DVec3],
    /// Support radius, m.
    support: f64,
    /// Kernel, where its values are read.
    kernel: Option<Kernel>,
}

impl BodyPairs<'_> {
    #[inline]
    fn neighbor(&self, i: usize, j: usize, weight: f64) -> Neighbor {
        let EulerianRows { lists, points, .. } = self.packed;
        let (own, other) = (&points[i], &points[j]);
        let current = other.place.xyz() - own.place.xyz();
        let kernel = |kernel: Kernel| kernel.w(current.length(), kernel.smoothing_length(self.support));
        Neighbor {
            row: lists.ghosts.source(j) as u32,
            signs: lists.ghosts.mirror(j).unwrap_or(DVec3::ONE),
            current,
            reference: lists.ghosts.pair(self.reference, i, j),
            velocity: other.velocity.xyz() - own.velocity.xyz(),
            weight,
            kernel: self.kernel.map_or(0.0, kernel),
            volume: other.place.0[3],
            support: self.support,
        }
    }
}

impl PairRows for BodyPairs<'_> {
    fn fill(&self, rows: Range<usize>, batch: &mut PairBatch) {
        let EulerianRows { lists, near, points, .. } = self.packed;
        let extras = Extras {
            reference: true,
            weight_at: WeightAt::Current,
            mirrors: !lists.ghosts.is_empty(),
            supports: false,
        };
        batch.begin(extras, self.support);
        for i in rows {
            if batch.is_full() {
                break;
            }
            let (neighbors, weights) = near.row(lists.offsets[i], i);
            let mut room = batch.add_row(points[i].place.0[3], neighbors.len());
            for (k, (&j, &weight)) in neighbors.iter().zip(weights).enumerate() {
                room.put(k, self.neighbor(i, j as usize, weight));
            }
            room.close(neighbors.len());
        }
    }
}
