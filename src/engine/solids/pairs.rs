//! The pairs of any phase of solids for pair terms, neighbour by neighbour: for formulations that do not fill
//! the lanes of a batch themselves. It gives no kernel values.

use std::ops::Range;

use glam::DVec3;

use super::phase::{PACKED_SOLID, SolidPhase};
use crate::pair::{Extras, Neighbor, PairBatch, PairReads, PairRows, PairSource, WeightAt};
use crate::schedule::{Access, Mode, Step, StepError};
use crate::world::{
    BodyId, PhaseId, Position, ReferencePosition, ReferenceVolume, Removed, SupportRadius, Velocity,
};

/// Gives pair terms the neighbours of a phase of solids.
pub struct SolidPairs {
    /// The phase.
    pub phase: PhaseId,
    /// Where its weights were taken.
    pub weight_at: WeightAt,
}

impl PairSource for SolidPairs {
    fn with_rows(
        &self,
        step: &Step<'_>,
        _: BodyId,
        _: PairReads,
        run: &mut dyn FnMut(&dyn PairRows) -> Result<(), StepError>,
    ) -> Result<(), StepError> {
        let view = step.world.phase(self.phase);
        let Some(solid) = step.resources.solid(self.phase) else { return Ok(()) };
        run(&SolidPairRows {
            solid: &*solid,
            weight_at: self.weight_at,
            reference: bytemuck::cast_slice(&view.read_near::<ReferencePosition>()?),
            position: bytemuck::cast_slice(&view.read_near::<Position>()?),
            velocity: &view.read_near::<Velocity>()?,
            volume: &view.read_near::<ReferenceVolume>()?,
            removed: &view.read_near::<Removed>()?,
            support: &view.read_near::<SupportRadius>()?,
        })
    }

    fn access(&self) -> Vec<Access> {
        vec![Access { column: PACKED_SOLID, mode: Mode::ReadsNear }]
    }
}

struct SolidPairRows<'a> {
    solid: &'a dyn SolidPhase,
    weight_at: WeightAt,
    reference: &'a [DVec3],
    position: &'a [DVec3],
    velocity: &'a [Velocity],
    volume: &'a [ReferenceVolume],
    removed: &'a [Removed],
    support: &'a [SupportRadius],
}

impl SolidPairRows<'_> {
    fn neighbor(&self, i: usize, j: usize, weight: f64) -> Neighbor {
        let ghosts = self.solid.ghosts();
        let (row, signs) = (ghosts.source(j), ghosts.mirror(j).unwrap_or(DVec3::ONE));
        Neighbor {
            row: row as u32,
            signs,
            reference: ghosts.pair(self.reference, i, j),
            current: ghosts.pair(self.position, i, j),
            velocity: signs * self.velocity[row].0 - self.velocity[i].0,
            weight,
            kernel: f64::NAN,
            volume: self.volume[row].0,
            support: 0.5 * (self.support[i].0 + self.support[row].0),
        }
    }
}

impl PairRows for SolidPairRows<'_> {
    fn fill(&self, rows: Range<usize>, batch: &mut PairBatch) {
        let mirrors = !self.solid.ghosts().is_empty();
        batch.begin(Extras { reference: true, weight_at: self.weight_at, mirrors, supports: true }, 0.0);
        for i in rows {
            if batch.is_full() {
                break;
            }
            let is_there = self.removed[i] == Removed::NO;
            let mut count = 0;
            self.solid.neighbors(i, &mut |_, _| count += 1);
            let mut slots = batch.add_row(self.volume[i].0, if is_there { count } else { 0 });
            let mut k = 0;
            self.solid.neighbors(i, &mut |j, weight| {
                if is_there {
                    slots.put(k, self.neighbor(i, j, weight));
                    k += 1;
                }
            });
            slots.close(k);
        }
    }
}
