//! Second pass over pairs: the force of pressure and viscosity.
//!
//! `f_i = -V_i sum_j V_j (p_i + p_j) w_ij x_ij + V_i sum_j V_j 4 mu_ij w_ij (v_ij - omega_ij x x_ij)`, with
//! the harmonic mean mu_ij of the two viscosities and the mean omega_ij of the two spins (`rotation`), that
//! of the fluid at a wall. Swapping i and j changes the sign of every product. Friction without spins is `2
//! mu_ij w_ij v_ij`.
//!
//! The part of the pressure force that comes from the pressure of a boundary is summed separately: the energy
//! of a boundary is not that of a compressed fluid, so that its work has an account of its own, together with
//! that of the repulsion (`walls::repulsion`).

use glam::DVec3;

use super::pair_sums::{Between, Forces, PairsOfRow};
use crate::formulations::fluid::cloud::{FlowCloud, Group, PARTS, take_until};
use crate::formulations::fluid::lanes::{FluidKernel, OwnRecord, sums};
use crate::pair::{BoundTerms, Extras, PairBatch, PhaseTerms, RateBounds, TermRows, with_batch};
use crate::parallel::{BlockSum, FourLanes, PlaneOrSpace, Split, for_each_own_block, run_hot_in};
use crate::schedule::{Step, StepError};
use crate::world::Force;

/// The pass over the particles of one group.
pub struct PairForce<'a> {
    pub cloud: &'a FlowCloud,
    pub group: &'a Group,
    /// Whether the force is added to the present values.
    pub adds: bool,
}

/// Output of the pass: the force, forces of pair terms, and [`PARTS`] parts of the force for every particle.
pub struct ForceRows<'a> {
    pub written: TermRows<'a>,
    pub parts: &'a mut [DVec3],
}

impl Split for ForceRows<'_> {
    fn rows(&self) -> usize {
        self.written.rows()
    }

    fn split(self, at: usize) -> (Self, Self) {
        let (written, written_rest) = self.written.split(at);
        let (parts, parts_rest) = self.parts.split_at_mut(PARTS * at);
        (Self { written, parts }, Self { written: written_rest, parts: parts_rest })
    }
}

impl PairForce<'_> {
    /// Writes the forces on the particles of the group that this rank computes and [`PARTS`] parts of each,
    /// N.
    pub fn run(&self, total: &mut [Force], parts: &mut [DVec3]) {
        let rows = ForceRows { written: TermRows::without_terms(total), parts };
        for_each_own_block(rows, &mut Vec::new(), &|first, rows| {
            run_hot_in(self.cloud.plane, PairForceRows { pass: self, first, rows, terms: None });
        });
    }

    /// [`PairForce::run`] with the pair terms of the body, which get the geometry of each row as the pass has
    /// computed it.
    pub fn run_with(
        &self,
        terms: &mut PhaseTerms,
        step: &mut Step<'_>,
        total: &mut [Force],
        parts: &mut [DVec3],
    ) -> Result<(), StepError> {
        let body = self.group.body;
        let fastest = terms.on_body(step, body, total, &mut |terms, written, sums| {
            let rows = ForceRows { written, parts: &mut *parts };
            for_each_own_block(rows, sums, &|first, rows| {
                let mut fastest = RateBounds::default();
                with_batch(|batch| {
                    let terms = Some(Terms { terms, batch, fastest: &mut fastest });
                    run_hot_in(self.cloud.plane, PairForceRows { pass: self, first, rows, terms });
                });
                fastest
            })
        })?;
        fastest.limit(step, body);
        Ok(())
    }
}

struct PairForceRows<'a> {
    pass: &'a PairForce<'a>,
    first: usize,
    rows: ForceRows<'a>,
    terms: Option<Terms<'a>>,
}

/// The pair terms of the group, and the pairs that they are given.
struct Terms<'a> {
    terms: &'a BoundTerms<'a>,
    batch: &'a mut PairBatch,
    fastest: &'a mut RateBounds,
}

impl PlaneOrSpace for PairForceRows<'_> {
    #[inline(always)]
    fn run<A: FourLanes, const D: usize>(self, a: A) {
        if self.pass.cloud.periods.any() { self.rows::<A, D, true>(a) } else { self.rows::<A, D, false>(a) }
    }
}

impl PairForceRows<'_> {
    #[inline(always)]
    fn rows<A: FourLanes, const D: usize, const P: bool>(self, a: A) {
        let PairForce { cloud, group, adds } = *self.pass;
        let ForceRows { mut written, parts } = self.rows;
        let mut terms = self.terms;
        let row = RowConstants::of_group(cloud, group);
        let first = group.cloud.start + self.first;
        let count = written.total.len();
        // Rows whose terms have not been run begin here.
        let mut open = 0;
        for k in 0..count {
            let i = first + k;
            if let Some(Terms { batch, .. }) = &mut terms
                && k == open
            {
                batch.begin(Extras::default(), row.kernel.support);
            }
            let (forces, is_in_batch) = row.sums::<A, D, P>(a, i, &mut terms);
            let volume = cloud.records[i].volume();
            let Forces { pressure, viscous, wall } = &forces;
            let (pressure, viscous, wall) = (sums(a, pressure), sums(a, viscous), sums(a, wall));
            let force = (viscous - pressure - wall) * volume;
            let total = &mut written.total[k];
            total.0 = if adds { total.0 + force } else { force };
            parts[PARTS * k] = viscous * volume;
            parts[PARTS * k + 1] = wall * -volume;
            if let Some(Terms { terms, batch, fastest }) = &mut terms {
                if !is_in_batch {
                    batch.add_row(volume, 0);
                }
                if batch.is_full() || k + 1 == count {
                    fastest.add(&terms.run(first + open, batch, open, &mut written));
                    open = k + 1;
                }
            }
        }
    }
}

/// Data common to the sums over the neighbours of all particles of a group.
struct RowConstants<'a> {
    cloud: &'a FlowCloud,
    group: &'a Group,
    kernel: FluidKernel,
    viscosities: &'a [f64],
    factor: f64,
    is_fluid: bool,
}

impl<'a> RowConstants<'a> {
    #[inline(always)]
    fn of_group(cloud: &'a FlowCloud, group: &'a Group) -> Self {
        Self {
            cloud,
            group,
            kernel: cloud.kernel,
            viscosities: cloud.viscosities.of(group),
            factor: cloud.viscosities.factor(),
            is_fluid: group.fluid().is_some(),
        }
    }

    /// The sums over the neighbours of particle `i`, and whether the batch of the terms has its pairs within
    /// its body.
    #[inline(always)]
    fn sums<A: FourLanes, const D: usize, const P: bool>(
        &self,
        a: A,
        i: usize,
        terms: &mut Option<Terms<'_>>,
    ) -> (Forces<D>, bool) {
        let Self { cloud, group, kernel, viscosities, factor, is_fluid } = *self;
        let own = &cloud.records[i];
        let lanes = OwnRecord::<D>::new(own);
        let mut rest = cloud.near_row(i);
        let (groups, mut forces, mut is_in_batch) = (&cloud.groups[..], Forces::<D>::ZERO, false);
        // By number: zipped iterators would be called.
        for n in 0..groups.len() {
            if rest.is_empty() {
                break;
            }
            let (other, viscosity) = (&groups[n], factor * viscosities[n]);
            let row = take_until(&mut rest, other.cloud.end);
            if row.is_empty() {
                continue;
            }
            let pairs = PairsOfRow { cloud, kernel, own: lanes, i, row, viscosity };
            match terms {
                Some(Terms { terms, batch, .. })
                    if other.cloud.start == group.cloud.start && own.volume() > 0.0 =>
                {
                    is_in_batch = true;
                    let slots = batch.add_row(own.volume(), row.len());
                    pairs.add_and_keep::<A, P>(a, slots, terms.reads.kernel, &mut forces);
                }
                _ => {
                    let between = Between::of(is_fluid, other.fluid().is_some());
                    pairs.add::<A, P>(a, between, &mut forces);
                }
            }
        }
        (forces, is_in_batch)
    }
}
