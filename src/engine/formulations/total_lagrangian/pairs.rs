//! The bonds of a total-Lagrangian body as pairs for pair terms.

use std::ops::Range;

use glam::DVec3;

use super::bonds::Bonds;
use super::formulation::{BodyKernel, PackedRows};
use super::images::Images;
use super::rows::Site;
use crate::kernels::Kernel;
use crate::pair::{Extras, PairBatch, PairReads, PairRows, PairSource, Room};
use crate::parallel::{Arithmetic, HotLoop, Lanes4, Vector, run_hot_on};
use crate::scene::Dimension;
use crate::schedule::{Step, StepError};
use crate::world::{BodyId, PhaseId, SupportRadius, Velocity};

/// Gives pair terms the bonds of the phase.
pub(super) struct BondPairs {
    pub phase: PhaseId,
}

impl PairSource for BondPairs {
    fn with_rows(
        &self,
        step: &Step<'_>,
        body: BodyId,
        reads: PairReads,
        run: &mut dyn FnMut(&dyn PairRows) -> Result<(), StepError>,
    ) -> Result<(), StepError> {
        let packed = step.resources.get::<PackedRows>();
        let view = step.world.phase(self.phase);
        let support = view.read::<SupportRadius>()?;
        let velocity = if reads.velocity { Some(view.read::<Velocity>()?) } else { None };
        let PackedRows { bonds, images, sites, kernels, .. } = &*packed;
        let Some(BodyKernel { kernel, support: uniform, .. }) = kernels.iter().find(|of| of.body == body)
        else {
            return Ok(());
        };
        run(&BodyPairs {
            bonds,
            images,
            sites,
            support: &support,
            uniform: *uniform,
            velocity: velocity.as_deref(),
            kernel: reads.kernel.then_some(kernel),
            plane: step.world.dimension() == Dimension::Two,
        })
    }
}

struct BodyPairs<'a> {
    bonds: &'a Bonds,
    images: &'a Images,
    sites: &'a [Site],
    support: &'a [SupportRadius],
    /// Support radius of all particles, m, where it is the same.
    uniform: Option<f64>,
    /// Velocities, where they are read.
    velocity: Option<&'a [Velocity]>,
    /// Kernel, where its values are read.
    kernel: Option<&'a Kernel>,
    plane: bool,
}

impl PairRows for BodyPairs<'_> {
    fn fill(&self, rows: Range<usize>, batch: &mut PairBatch) {
        run_hot_on(self.plane, Fill { pairs: self, rows, batch });
    }
}

/// Fills the rows of some particles.
struct Fill<'a> {
    pairs: &'a BodyPairs<'a>,
    rows: Range<usize>,
    batch: &'a mut PairBatch,
}

impl HotLoop for Fill<'_> {
    type Output = ();

    #[inline(always)]
    fn run<A: Arithmetic>(self, a: A) {
        let Self { pairs, rows, batch } = self;
        let extras =
            Extras { reference: true, mirrors: !pairs.images.is_empty(), supports: pairs.uniform.is_none() };
        batch.begin(extras, pairs.uniform.unwrap_or(0.0));
        for i in rows {
            if batch.is_full() {
                break;
            }
            pairs.fill_row(a, i, batch);
        }
    }
}

impl BodyPairs<'_> {
    /// Adds the row of one particle.
    #[inline(always)]
    fn fill_row<A: Arithmetic>(&self, a: A, i: usize, batch: &mut PairBatch) {
        let Self { bonds, sites, .. } = *self;
        let site = &sites[i];
        let list =
            if site.is_present() { bonds.offsets[i] as usize..bonds.offsets[i + 1] as usize } else { 0..0 };
        let (neighbors, weights) = (&bonds.neighbors[list.clone()], &bonds.weights[list]);
        let mut room = batch.add_row(site.reference.0[3], neighbors.len());
        let (fours, rest) = neighbors.as_chunks();
        let (weights, rest_weights) = weights.as_chunks();
        for n in 0..fours.len() {
            self.put(a, (i, site), (fours[n], weights[n]), n, &mut room);
        }
        if !rest.is_empty() {
            let (mut four, mut weight) = ([i as u32; 4], [0.0; 4]);
            four[..rest.len()].copy_from_slice(rest);
            weight[..rest.len()].copy_from_slice(rest_weights);
            self.put(a, (i, site), (four, weight), fours.len(), &mut room);
        }
        if let Some(kernel) = self.kernel {
            put_kernel(kernel, self.uniform, room);
        }
    }
}

impl BodyPairs<'_> {
    /// Puts four neighbours into the room, all but kernel values.
    #[inline(always)]
    fn put<A: Arithmetic>(
        &self,
        a: A,
        (i, site): (usize, &Site),
        (four, weight): ([u32; 4], [f32; 4]),
        n: usize,
        room: &mut Room<'_>,
    ) {
        let Self { images, sites, support, uniform, velocity, .. } = *self;
        let mut rows = [four[0] as usize, four[1] as usize, four[2] as usize, four[3] as usize];
        let [j, k, l, m] = rows;
        let of = [&sites[j], &sites[k], &sites[l], &sites[m]];
        let place = a.transpose([of[0].reference, of[1].reference, of[2].reference, of[3].reference]);
        let moved =
            a.transpose([of[0].displacement, of[1].displacement, of[2].displacement, of[3].displacement]);
        let weight =
            Lanes4([f64::from(weight[0]), f64::from(weight[1]), f64::from(weight[2]), f64::from(weight[3])]);
        let pairs = &mut room.pairs[n];
        // Removed particles, and lanes without a neighbour, have neither weight nor volume.
        pairs.volume_j = a.where_below(Lanes4::ZERO, weight, place[3]);
        pairs.weight = a.where_below(Lanes4::ZERO, pairs.volume_j, weight);
        for axis in 0..A::AXES {
            let then = a.minus(place[axis], Lanes4::splat(site.reference.0[axis]));
            let u = a.minus(moved[axis], Lanes4::splat(site.displacement.0[axis]));
            room.reference[n].vector[axis] = then;
            pairs.current.vector[axis] = a.plus(then, u);
        }
        pairs.current.length = squares(a, pairs.current.vector);
        room.reference[n].length = squares(a, room.reference[n].vector);
        if !images.is_empty() {
            for lane in 0..4 {
                room.mirrors[n][lane] = images.mirror(rows[lane]).unwrap_or(DVec3::ONE);
                rows[lane] = images.source(rows[lane]);
            }
        }
        let [j, k, l, m] = rows;
        room.rows[n] = [j as u32, k as u32, l as u32, m as u32];
        if let Some(v) = velocity {
            let mut of = [v[j].0, v[k].0, v[l].0, v[m].0];
            if !images.is_empty() {
                let signs = &room.mirrors[n];
                of = [of[0] * signs[0], of[1] * signs[1], of[2] * signs[2], of[3] * signs[3]];
            }
            let (of, own) = (Vector::from_rows(a, of), Vector::splat(a, v[i].0));
            let Vector { x, y, z } = of - own;
            pairs.velocity = [x.lanes(), y.lanes(), z.lanes()];
        }
        if uniform.is_none() {
            let other = Lanes4([support[j].0, support[k].0, support[l].0, support[m].0]);
            room.supports[n] = a.scale(0.5, a.plus(Lanes4::splat(support[i].0), other));
        }
    }
}

/// Puts kernel values of the reference lengths into a row.
fn put_kernel(kernel: &Kernel, uniform: Option<f64>, room: Room<'_>) {
    for (k, (pairs, reference)) in room.pairs.iter_mut().zip(room.reference).enumerate() {
        for lane in 0..4 {
            let support = uniform.unwrap_or_else(|| room.supports[k].0[lane]);
            let h = kernel.smoothing_length(support);
            let value = kernel.w(reference.length.0[lane].sqrt(), h);
            pairs.kernel.0[lane] = if pairs.volume_j.0[lane] > 0.0 { value } else { 0.0 };
        }
    }
}

/// Squares of the lengths of four vectors, above zero.
#[inline(always)]
fn squares<A: Arithmetic>(a: A, vector: [Lanes4; 3]) -> Lanes4 {
    let square = Vector::new(a, vector).length_squared().lanes();
    a.larger(square, Lanes4::splat(f64::MIN_POSITIVE))
}
