//! The pairs of a body for pair terms: those within the support, with original and present pair vectors.

use std::ops::Range;

use glam::DVec3;

use super::rows::EulerianRows;
use super::within::records;
use crate::kernels::Kernel;
use crate::pair::{
    Extras, FourVectors, PairBatch, PairReads, PairRows, PairSource, RowSlots, WeightAt, components,
};
use crate::parallel::{FourLanes, HotLoop, Lanes4, Vector, run_hot_on};
use crate::schedule::{Access, Mode, Step, StepError};
use crate::solids::PACKED_SOLID;
use crate::world::{BodyId, PhaseId};

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
        let of_body = packed.lists.bodies.iter().zip(&packed.kernels).find(|(of, _)| of.id == body);
        let Some((body, of)) = of_body else { return Ok(()) };
        let kernel = reads.kernel.then_some(of.kernel);
        run(&PairsOfEulerianBody { packed: &packed, support: body.support, kernel })
    }

    fn access(&self) -> Vec<Access> {
        vec![Access { column: PACKED_SOLID, mode: Mode::ReadsNear }]
    }
}

/// The pairs of one body.
struct PairsOfEulerianBody<'a> {
    packed: &'a EulerianRows,
    /// Support radius, m.
    support: f64,
    /// The kernel, if a term reads its values.
    kernel: Option<Kernel>,
}

impl PairRows for PairsOfEulerianBody<'_> {
    fn fill(&self, rows: Range<usize>, batch: &mut PairBatch) {
        run_hot_on(self.packed.plane, FillEulerianPairs { pairs: self, rows, batch });
    }
}

/// Fills the rows of some particles.
struct FillEulerianPairs<'a> {
    pairs: &'a PairsOfEulerianBody<'a>,
    rows: Range<usize>,
    batch: &'a mut PairBatch,
}

impl HotLoop for FillEulerianPairs<'_> {
    type Output = ();

    #[inline(always)]
    fn run<A: FourLanes>(self, a: A) {
        let Self { pairs: PairsOfEulerianBody { packed, support, kernel }, rows, batch } = self;
        let EulerianRows { lists, near, points, .. } = *packed;
        let mirrors = !lists.ghosts.is_empty();
        let extras = Extras { reference: true, weight_at: WeightAt::Current, mirrors, supports: false };
        batch.begin(extras, *support);
        for i in rows {
            if batch.is_full() {
                break;
            }
            let part = lists.pairs.offsets()[i]..lists.pairs.offsets()[i] + near.around[i].count as usize;
            let neighbors = &near.neighbors[part.clone()];
            let mut slots = batch.add_row(points[i].velocity.0[3], neighbors.len());
            let (fours, rest) = neighbors.as_chunks::<4>();
            for n in 0..fours.len() {
                let four = FourNeighbors { i, neighbors: fours[n], count: 4, first: part.start + 4 * n };
                put(a, packed, four, n, &mut slots);
            }
            if !rest.is_empty() {
                let mut four = [i as u32; 4];
                four[..rest.len()].copy_from_slice(rest);
                let n = fours.len();
                let four = FourNeighbors { i, neighbors: four, count: rest.len(), first: part.start + 4 * n };
                put(a, packed, four, n, &mut slots);
            }
            if let Some(kernel) = kernel {
                let h = kernel.smoothing_length(*support);
                for pairs in &mut *slots.pairs {
                    for lane in 0..4 {
                        // Without a weight there is no neighbour.
                        let is_there = pairs.volume_j.0[lane] > 0.0;
                        let distance = pairs.current.length.0[lane].sqrt();
                        pairs.kernel.0[lane] = if is_there { kernel.w(distance, h) } else { 0.0 };
                    }
                }
            }
        }
    }
}

/// Four neighbours of row `i`, of which `count` are there; their weights begin at `first`.
struct FourNeighbors {
    i: usize,
    neighbors: [u32; 4],
    count: usize,
    first: usize,
}

/// Puts four neighbours into place `n` of the slots.
#[inline(always)]
fn put<A: FourLanes>(a: A, packed: &EulerianRows, four: FourNeighbors, n: usize, slots: &mut RowSlots<'_>) {
    let FourNeighbors { i, neighbors: four, count, first: at } = four;
    let EulerianRows { lists, near, points, carried, .. } = packed;
    let of = records(&four, points);
    let from = records(&four, carried);
    let (own, original) = (&points[i], carried[i].original);
    let [x, y, z, _] = a.transpose([of[0].place, of[1].place, of[2].place, of[3].place]);
    let now = Vector::new(a, [x, y, z]) - Vector::splat(a, own.place.xyz());
    let [x, y, z, volume] = a.transpose([of[0].velocity, of[1].velocity, of[2].velocity, of[3].velocity]);
    let passing = Vector::new(a, [x, y, z]) - Vector::splat(a, own.velocity.xyz());
    let [x, y, z, _] = a.transpose([from[0].original, from[1].original, from[2].original, from[3].original]);
    let then = Vector::new(a, [x, y, z]) - Vector::splat(a, original.xyz());
    let (mut weight, mut volume_j) = (Lanes4::ZERO, Lanes4::ZERO);
    for lane in 0..count {
        weight.0[lane] = near.weights[at + lane];
        volume_j.0[lane] = volume.0[lane];
    }
    let pairs = &mut slots.pairs[n];
    pairs.current = FourVectors::squared(a, now);
    pairs.velocity = components(passing);
    (pairs.weight, pairs.kernel, pairs.volume_j) = (weight, Lanes4::ZERO, volume_j);
    slots.reference[n] = FourVectors::squared(a, then);
    slots.rows[n] = four;
    if !slots.mirrors.is_empty() {
        for lane in 0..4 {
            slots.mirrors[n][lane] = lists.ghosts.mirror(four[lane] as usize).unwrap_or(DVec3::ONE);
            slots.rows[n][lane] = lists.ghosts.source(four[lane] as usize) as u32;
        }
    }
}
