//! The bonds of a total-Lagrangian body as pairs for pair terms.

use std::marker::PhantomData;
use std::ops::Range;

use glam::DVec3;

use super::bonds::Bonds;
use super::rows::PackedParticle;
use crate::kernels::Kernel;
use crate::pair::{
    Extras, FourVectors, PairBatch, PairReads, PairRows, PairSource, RowSlots, WeightAt, components,
};
use crate::parallel::{FourLanes, HotLoop, Lanes4, Vector, run_hot_on};
use crate::scene::Dimension;
use crate::schedule::{Access, Mode, Step, StepError};
use crate::solids::{PACKED_SOLID, SolidPhase};
use crate::symmetry::Ghosts;
use crate::world::{BodyId, PhaseId, SupportRadius, Velocity};

/// The kernel of a body.
pub(in crate::formulations) struct BodyKernel {
    pub body: BodyId,
    pub kernel: Kernel,
    /// Support radius, m, where all particles have the same.
    pub support: Option<f64>,
}

/// Packed rows whose neighbours are bonds.
pub(in crate::formulations) trait BondedRows: SolidPhase {
    /// Neighbours and weights.
    fn bonds(&self) -> &Bonds;
    /// Original place, volume in the configuration of the weights, and displacement since the start of every
    /// row.
    fn pair_sites(&self) -> &[PackedParticle];
    /// Kernel of every body.
    fn kernels(&self) -> &[BodyKernel];
}

impl Bonds {
    /// Calls `f` with the row and the weight of every neighbour of a row that has not been removed.
    pub(in crate::formulations) fn for_each_present(
        &self,
        sites: &[PackedParticle],
        row: usize,
        f: &mut dyn FnMut(usize, f64),
    ) {
        self.row(row).filter(|(j, _)| sites[*j].is_present()).for_each(|(j, weight)| f(j, f64::from(weight)));
    }
}

/// Gives pair terms the bonds of a phase whose packed rows are of that type.
pub(in crate::formulations) struct BondPairs<R> {
    phase: PhaseId,
    rows: PhantomData<fn() -> R>,
}

impl<R> BondPairs<R> {
    /// The bonds of a phase.
    pub fn of(phase: PhaseId) -> Self {
        Self { phase, rows: PhantomData }
    }
}

impl<R: BondedRows> PairSource for BondPairs<R> {
    fn with_rows(
        &self,
        step: &Step<'_>,
        body: BodyId,
        reads: PairReads,
        run: &mut dyn FnMut(&dyn PairRows) -> Result<(), StepError>,
    ) -> Result<(), StepError> {
        let packed = step.resources.solid_rows::<R>(self.phase);
        let view = step.world.phase(self.phase);
        let support = view.read_near::<SupportRadius>()?;
        let velocity = if reads.velocity { Some(view.read_near::<Velocity>()?) } else { None };
        let Some(BodyKernel { kernel, support: uniform, .. }) =
            packed.kernels().iter().find(|of| of.body == body)
        else {
            return Ok(());
        };
        run(&BodyPairs {
            bonds: packed.bonds(),
            ghosts: packed.ghosts(),
            sites: packed.pair_sites(),
            support: &support,
            uniform: *uniform,
            velocity: velocity.as_deref(),
            kernel: reads.kernel.then_some(kernel),
            plane: step.world.dimension() == Dimension::Two,
        })
    }

    fn access(&self) -> Vec<Access> {
        vec![Access { column: PACKED_SOLID, mode: Mode::ReadsNear }]
    }
}

/// The pairs of one body.
struct BodyPairs<'a> {
    bonds: &'a Bonds,
    ghosts: &'a Ghosts,
    sites: &'a [PackedParticle],
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
        run_hot_on(self.plane, FillBonds { pairs: self, rows, batch });
    }
}

/// Fills the rows of some particles.
struct FillBonds<'a> {
    pairs: &'a BodyPairs<'a>,
    rows: Range<usize>,
    batch: &'a mut PairBatch,
}

impl HotLoop for FillBonds<'_> {
    type Output = ();

    #[inline(always)]
    fn run<A: FourLanes>(self, a: A) {
        let Self { pairs, rows, batch } = self;
        let extras = Extras {
            reference: true,
            weight_at: WeightAt::Reference,
            mirrors: !pairs.ghosts.is_empty(),
            supports: pairs.uniform.is_none(),
        };
        batch.begin(extras, pairs.uniform.unwrap_or(0.0));
        for i in rows {
            if batch.is_full() {
                break;
            }
            if extras.mirrors {
                pairs.fill_row::<A, true>(a, i, batch);
            } else {
                pairs.fill_row::<A, false>(a, i, batch);
            }
        }
    }
}

/// Four bonds of a row.
struct FourBonds {
    neighbors: [u32; 4],
    weights: [f32; 4],
}

/// The particle of a row in every lane.
struct OwnSite<A: FourLanes> {
    reference: Vector<A>,
    displacement: Vector<A>,
    velocity: Vector<A>,
    support: f64,
}

impl BodyPairs<'_> {
    /// Adds the row of one particle; `GHOSTS` where there are ghosts.
    #[inline(always)]
    fn fill_row<A: FourLanes, const GHOSTS: bool>(&self, a: A, i: usize, batch: &mut PairBatch) {
        let Self { bonds, sites, velocity, support, .. } = *self;
        let site = &sites[i];
        let own = OwnSite {
            reference: Vector::splat(a, site.reference.xyz()),
            displacement: Vector::splat(a, site.displacement.xyz()),
            velocity: Vector::splat(a, velocity.map_or(DVec3::ZERO, |v| v[i].0)),
            support: support[i].0,
        };
        let list =
            if site.is_present() { bonds.offsets[i] as usize..bonds.offsets[i + 1] as usize } else { 0..0 };
        let (neighbors, weights) = (&bonds.neighbors[list.clone()], &bonds.weights[list]);
        let mut slots = batch.add_row(site.reference.0[3], neighbors.len());
        let (fours, rest) = neighbors.as_chunks();
        let (weights, rest_weights) = weights.as_chunks();
        for n in 0..fours.len() {
            let four = FourBonds { neighbors: fours[n], weights: weights[n] };
            self.put::<A, GHOSTS>(a, &own, four, n, &mut slots);
        }
        if !rest.is_empty() {
            let (mut four, mut weight) = ([i as u32; 4], [0.0; 4]);
            four[..rest.len()].copy_from_slice(rest);
            weight[..rest.len()].copy_from_slice(rest_weights);
            let four = FourBonds { neighbors: four, weights: weight };
            self.put::<A, GHOSTS>(a, &own, four, fours.len(), &mut slots);
        }
        if let Some(kernel) = self.kernel {
            put_kernel(kernel, self.uniform, slots);
        }
    }

    /// Puts four neighbours into the slots, all but kernel values.
    #[inline(always)]
    fn put<A: FourLanes, const GHOSTS: bool>(
        &self,
        a: A,
        own: &OwnSite<A>,
        four: FourBonds,
        n: usize,
        slots: &mut RowSlots<'_>,
    ) {
        let FourBonds { neighbors: four, weights: weight } = four;
        let Self { ghosts, sites, support, uniform, velocity, .. } = *self;
        let mut rows = [four[0] as usize, four[1] as usize, four[2] as usize, four[3] as usize];
        let [j, k, l, m] = rows;
        let of = [&sites[j], &sites[k], &sites[l], &sites[m]];
        let [x, y, z, volume] =
            a.transpose([of[0].reference, of[1].reference, of[2].reference, of[3].reference]);
        let then = Vector::new(a, [x, y, z]) - own.reference;
        let [x, y, z, _] =
            a.transpose([of[0].displacement, of[1].displacement, of[2].displacement, of[3].displacement]);
        let now = then + (Vector::new(a, [x, y, z]) - own.displacement);
        let weight =
            Lanes4([f64::from(weight[0]), f64::from(weight[1]), f64::from(weight[2]), f64::from(weight[3])]);
        // Removed particles, and lanes without a neighbour, have neither weight nor volume.
        let volume_j = a.where_below(Lanes4::ZERO, weight, volume);
        if GHOSTS {
            for lane in 0..4 {
                slots.mirrors[n][lane] = ghosts.mirror(rows[lane]).unwrap_or(DVec3::ONE);
                rows[lane] = ghosts.source(rows[lane]);
            }
        }
        let [j, k, l, m] = rows;
        slots.rows[n] = [j as u32, k as u32, l as u32, m as u32];
        slots.reference[n] = FourVectors::squared(a, then);
        let pairs = &mut slots.pairs[n];
        pairs.current = FourVectors::squared(a, now);
        pairs.volume_j = volume_j;
        pairs.weight = a.where_below(Lanes4::ZERO, volume_j, weight);
        if let Some(v) = velocity {
            let mut of = [v[j].0, v[k].0, v[l].0, v[m].0];
            if GHOSTS {
                let signs = &slots.mirrors[n];
                of = [of[0] * signs[0], of[1] * signs[1], of[2] * signs[2], of[3] * signs[3]];
            }
            pairs.velocity = components(Vector::from_rows(a, of) - own.velocity);
        }
        if uniform.is_none() {
            let other = Lanes4([support[j].0, support[k].0, support[l].0, support[m].0]);
            slots.supports[n] = a.scale(0.5, a.add(Lanes4::splat(own.support), other));
        }
    }
}

/// Puts kernel values of the reference lengths into a row.
fn put_kernel(kernel: &Kernel, uniform: Option<f64>, slots: RowSlots<'_>) {
    for (k, (pairs, reference)) in slots.pairs.iter_mut().zip(slots.reference).enumerate() {
        for lane in 0..4 {
            let support = uniform.unwrap_or_else(|| slots.supports[k].0[lane]);
            let h = kernel.smoothing_length(support);
            let value = kernel.w(reference.length.0[lane].sqrt(), h);
            pairs.kernel.0[lane] = if pairs.volume_j.0[lane] > 0.0 { value } else { 0.0 };
        }
    }
}
