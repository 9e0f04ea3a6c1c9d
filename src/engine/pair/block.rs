//! The pairs of a block of particles with some neighbours: what a formulation whose lanes are particles
//! fills, and pair terms read.

use super::term::{Pair, Rates};
use super::weight_at::WeightAt;
use crate::parallel::{Arithmetic, EIGHT, EightLanes, Lanes8, Number, Vector};

/// Maximum number of neighbours: their pairs fit the first-level cache.
pub(crate) const CHUNK: usize = 48;

/// One neighbour of all particles of a block. Where it is beyond the support, or the particle itself, its
/// volume is zero.
#[derive(Clone, Copy, Debug)]
pub(crate) struct EightPairs {
    /// Row in the phase.
    pub row: u32,
    /// x_ij, m.
    pub x: [Lanes8; 3],
    /// v_ij, m/s.
    pub v: [Lanes8; 3],
    /// Length of x_ij, m, above zero.
    pub length: Lanes8,
    /// Pair weights w_ij.
    pub weight: Lanes8,
    /// Kernel values W_ij.
    pub kernel: Lanes8,
    /// Volumes V_j, m3.
    pub volume: Lanes8,
}

/// Some neighbours of a block.
pub(crate) struct BlockPairs {
    /// Rows of the particles in the phase.
    pub(super) rows: [u32; EIGHT],
    /// Their volumes V_i, m3.
    volume: Lanes8,
    /// Support radius, m.
    support: f64,
    count: usize,
    pairs: [EightPairs; CHUNK],
}

impl EightPairs {
    const ZERO: Self = Self {
        row: 0,
        x: [Lanes8::ZERO; 3],
        v: [Lanes8::ZERO; 3],
        length: Lanes8::ZERO,
        weight: Lanes8::ZERO,
        kernel: Lanes8::ZERO,
        volume: Lanes8::ZERO,
    };
}

impl BlockPairs {
    /// No neighbours. Make it once for many blocks.
    pub const EMPTY: Self = Self {
        rows: [0; EIGHT],
        volume: Lanes8::ZERO,
        support: 0.0,
        count: 0,
        pairs: [EightPairs::ZERO; CHUNK],
    };

    /// Begins with a block of particles of these rows and volumes V_i, m3; `support` is the support radius,
    /// m.
    #[inline(always)]
    pub fn begin(&mut self, rows: [u32; EIGHT], volume: Lanes8, support: f64) {
        (self.rows, self.volume, self.support) = (rows, volume, support);
        self.count = 0;
    }

    /// Room for that many neighbours, up to [`CHUNK`], in the place of those that were there; to be filled by
    /// the caller.
    #[inline(always)]
    pub fn slots(&mut self, count: usize) -> &mut [EightPairs] {
        self.count = count;
        &mut self.pairs[..count]
    }

    /// The neighbours.
    #[inline(always)]
    pub fn pairs(&self) -> &[EightPairs] {
        &self.pairs[..self.count]
    }

    /// The neighbours, to be changed.
    #[inline(always)]
    pub fn pairs_mut(&mut self) -> &mut [EightPairs] {
        &mut self.pairs[..self.count]
    }

    /// What all pairs of the block share. It is computed before the loop over them: within, a bound that is
    /// checked keeps the compiler from doing so.
    #[inline(always)]
    pub(super) fn shared<A: EightLanes>(&self, a: A) -> SharedByPairs<A> {
        SharedByPairs { support: Number::splat(a, self.support), volume_i: Number::new(a, self.volume) }
    }
}

/// The support radius, m, and the volumes V_i, m3, of the pairs of a block.
#[derive(Clone, Copy)]
pub(super) struct SharedByPairs<A: Arithmetic> {
    support: Number<A>,
    volume_i: Number<A>,
}

impl<A: EightLanes> SharedByPairs<A> {
    /// The pair with a neighbour, as a term reads it.
    #[inline(always)]
    pub fn with(self, a: A, pair: &EightPairs) -> Pair<A> {
        let length = Number::new(a, pair.length);
        let x_ij = Vector::new(a, pair.x);
        Pair {
            x_ij,
            reference_x_ij: x_ij,
            weight: Number::new(a, pair.weight),
            kernel: Number::new(a, pair.kernel),
            v_ij: Vector::new(a, pair.v),
            support: self.support,
            volume_i: self.volume_i,
            volume_j: Number::new(a, pair.volume),
            length,
            reference_length: length,
            is_reference: true,
            weight_at: WeightAt::Current,
        }
    }
}

/// Sums of a term for the particles of a block.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct TermSums {
    /// Force on each, N.
    pub force: [Lanes8; 3],
    /// Rate of change of the density of each, kg/(m3 s).
    pub density: Lanes8,
    /// Rates that limit the step ([`Rates`]).
    pub damping: Lanes8,
    pub stiffness: Lanes8,
}

impl TermSums {
    #[inline(always)]
    pub(super) fn rates<A: EightLanes>(&self, a: A) -> Rates<A> {
        Rates {
            force: Vector::new(a, self.force),
            density: Number::new(a, self.density),
            // Blocks are of fluids, which have no temperature.
            heat: Number::zero(a),
            damping: Number::new(a, self.damping),
            stiffness: Number::new(a, self.stiffness),
        }
    }

    #[inline(always)]
    pub(super) fn keep<A: EightLanes>(&mut self, rates: &Rates<A>) {
        let Vector { x, y, z } = rates.force;
        self.force = [x.lanes(), y.lanes(), z.lanes()];
        (self.density, self.damping, self.stiffness) =
            (rates.density.lanes(), rates.damping.lanes(), rates.stiffness.lanes());
    }
}
