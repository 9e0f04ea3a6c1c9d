//! The trait of a pair term: geometry of one pair and columns of both particles in, rates out.

use glam::DVec3;

use super::read::{FourOf, ReadSet};
use super::weight_at::WeightAt;
use crate::parallel::{Arithmetic, FourLanes, Number, Vector};

/// Geometry of pairs, one a lane: of particle i with four neighbours j, or of eight particles i with one
/// neighbour j (flows in single precision). In formulations without a reference configuration the reference
/// vector is the current one. Lanes without a neighbour have `volume_j` zero: every contribution must be
/// proportional to the volume of j, as in sums over neighbours.
#[derive(Clone, Copy)]
pub struct Pair<A: Arithmetic> {
    /// Current pair vector x_ij = x_j - x_i, m.
    pub x_ij: Vector<A>,
    /// Reference pair vector X_ij, m.
    pub reference_x_ij: Vector<A>,
    /// Pair weight w_ij = |W'(r)| / r of the formulation's kernel, at the length that `weight_at` says:
    /// grad_i W = w_ij x_ij where it is the current one.
    pub weight: Number<A>,
    /// Kernel value W_ij, 1/m2 or 1/m3; not a number unless a term of the phase reads it
    /// ([`PairTerm::READS_KERNEL`]).
    pub kernel: Number<A>,
    /// Relative velocity v_ij = v_j - v_i, m/s; not a number unless a term of the phase reads it
    /// ([`PairTerm::READS_VELOCITY`]).
    pub v_ij: Vector<A>,
    /// Mean support radius of the two particles, m.
    pub support: Number<A>,
    /// Volume of i in the formulation's sums, m3.
    pub volume_i: Number<A>,
    /// Volume of j, m3.
    pub volume_j: Number<A>,
    /// Lengths of x_ij, m; where there is a reference, their squares, m2.
    pub(super) length: Number<A>,
    /// The same of X_ij.
    pub(super) reference_length: Number<A>,
    /// Whether the current configuration is the reference; the same for all pairs of a batch.
    pub(super) is_reference: bool,
    /// The configuration to whose length `weight` and `kernel` belong; the same for all pairs of a batch.
    pub weight_at: WeightAt,
}

impl<A: Arithmetic> Pair<A> {
    /// Smoothing length h for artificial viscosity and similar terms: half the support radius, m.
    #[inline(always)]
    pub fn smoothing_length(&self) -> Number<A> {
        0.5 * self.support
    }

    /// Length of x_ij, m; a tiny number in place of zero, so that one may divide by it.
    #[inline(always)]
    pub fn distance(&self) -> Number<A> {
        if self.is_reference { self.length } else { self.length.sqrt() }
    }

    /// Square of the length of x_ij, m2; a tiny number in place of zero. Cheaper than the length where there
    /// is a reference.
    #[inline(always)]
    pub fn distance_squared(&self) -> Number<A> {
        if self.is_reference { self.length.squared() } else { self.length }
    }

    /// Length of X_ij, m.
    #[inline(always)]
    pub fn reference_distance(&self) -> Number<A> {
        if self.is_reference { self.length } else { self.reference_length.sqrt() }
    }

    /// Square of the length of X_ij, m2.
    #[inline(always)]
    pub fn reference_distance_squared(&self) -> Number<A> {
        if self.is_reference { self.length.squared() } else { self.reference_length }
    }

    /// Slope |W'_ij| of the kernel, where its weight was taken: `weight` times the length there.
    #[inline(always)]
    pub fn slope(&self) -> Number<A> {
        match self.weight_at {
            WeightAt::Current => self.weight * self.distance(),
            WeightAt::Reference => self.weight * self.reference_distance(),
        }
    }

    /// Slope of the kernel, where its weight was taken, over the current length: |W'_ij| / |x_ij|.
    #[inline(always)]
    pub fn slope_per_length(&self) -> Number<A> {
        if self.is_reference || self.weight_at == WeightAt::Current {
            self.weight
        } else {
            self.weight * (self.reference_length / self.length).sqrt()
        }
    }
}

/// Contribution of a term to particle i, lane by lane; the lanes are added up once the row is done.
#[derive(Clone, Copy)]
pub struct Rates<A: Arithmetic> {
    /// Force on i, N. The force on j must be its exact opposite when the roles are swapped.
    pub force: Vector<A>,
    /// Rate of change of the density of i, kg/(m3 s), in fluids; of a term with
    /// [`PairTerm::CHANGES_DENSITY`].
    pub density: Number<A>,
    /// Heat of i, W, of a term with [`PairTerm::HEATS`]: half of what the pair dissipates, so that i and j
    /// have all of it.
    pub heat: Number<A>,
    /// Rate at which the term damps the velocity of i against fixed neighbours, 1/s: limits the time step.
    pub damping: Number<A>,
    /// Stiffness per mass that the term gives i against fixed neighbours, 1/s2: limits the time step.
    pub stiffness: Number<A>,
}

/// Rates of a whole row.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct RowRates {
    pub force: DVec3,
    pub density: f64,
    pub heat: f64,
    pub damping: f64,
    pub stiffness: f64,
}

impl<A: Arithmetic> Rates<A> {
    #[inline(always)]
    pub(super) fn zero(a: A) -> Self {
        let zero = Number::zero(a);
        Self { force: Vector::zero(a), density: zero, heat: zero, damping: zero, stiffness: zero }
    }
}

impl<A: FourLanes> Rates<A> {
    #[inline(always)]
    pub(super) fn sum(self) -> RowRates {
        let Vector { x, y, z } = self.force;
        let sums = self.density.arithmetic().sums([x.lanes(), y.lanes(), z.lanes(), self.density.lanes()]);
        RowRates {
            force: sums.xyz(),
            density: sums.0[3],
            heat: self.heat.sum(),
            damping: self.damping.sum(),
            stiffness: self.stiffness.sum(),
        }
    }
}

/// Contribution of neighbours j to particle i, written as a function of one pair that runs for four
/// neighbours, or eight particles, at a time: numbers and vectors have their usual operators, and a branch is
/// [`Number::if_below`], [`Number::min`] or [`Number::max`].
pub trait PairTerm: Send + Sync + 'static {
    /// Columns it needs of i: a tuple of columns.
    type ReadI: ReadSet;
    /// Columns it needs of j.
    type ReadJ: ReadSet;

    /// Whether it reads [`Pair::kernel`]. If no term does, the kernel of pairs is not computed.
    const READS_KERNEL: bool = true;
    /// Whether it reads [`Pair::v_ij`]. If no term does, the velocities of pairs are not computed.
    const READS_VELOCITY: bool = true;
    /// Whether it needs reference pair vectors, which solids have and fluids do not. Its loops over fluids
    /// are then not compiled, and the term on a fluid is an error of the scene.
    const NEEDS_REFERENCE: bool = false;
    /// Whether the term changes the density.
    const CHANGES_DENSITY: bool = false;
    /// Whether what the term dissipates heats the particles of solids.
    const HEATS: bool = false;

    /// Adds the contribution of j to the rates of i. Mark it `#[inline(always)]`: it is then compiled for the
    /// instruction path of the loop around it.
    fn pair<A: Arithmetic>(
        &self,
        pair: &Pair<A>,
        i: FourOf<Self::ReadI, A>,
        j: FourOf<Self::ReadJ, A>,
        rates: &mut Rates<A>,
    );
}

/// Reads of the terms of a phase from its pairs.
#[derive(Clone, Copy, Debug, Default)]
pub struct PairReads {
    /// Kernel values.
    pub kernel: bool,
    /// Relative velocities.
    pub velocity: bool,
}
