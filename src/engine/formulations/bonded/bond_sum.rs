//! Sums over the bonds of a particle of records of its neighbours, such as their stresses.

use super::bonds::Bonds;
use crate::parallel::{FourLanes, Lanes4};
use crate::solids::CorrectedStress;

/// Sums of stresses over the neighbours of a particle, weighted with V_j w_ij.
pub(in crate::formulations) struct BondSum<const D: usize> {
    /// `sum_j V_j w_ij A_j`, with `sum_j V_j w_ij k_j` in the last lane of the first column.
    pub columns: [Lanes4; D],
    /// `sum_j V_j w_ij q_j`.
    pub traction: Lanes4,
}

/// Prefetch distance in bonds: some hundred cycles, about the latency of a row.
const AHEAD: usize = 32;

/// A sum over the neighbours of a particle of records of theirs. There are two of them in the loop, for every
/// other bond, so that additions need not wait for each other.
pub(in crate::formulations) trait SumOverBonds: Sized {
    /// What each neighbour adds to.
    type Record;
    const ZERO: Self;

    /// Adds a neighbour, with w_ij.
    fn add<A: FourLanes>(&mut self, a: A, other: &Self::Record, weight: f32);

    /// This sum and another one.
    fn combined<A: FourLanes>(self, a: A, other: &Self) -> Self;

    /// The sums over the bonds of row `i`.
    #[inline(always)]
    fn over<A: FourLanes>(a: A, bonds: &Bonds, records: &[Self::Record], i: usize) -> Self {
        let row = bonds.offsets[i] as usize..bonds.offsets[i + 1] as usize;
        let first = row.start;
        let (mut even, mut odd) = (Self::ZERO, Self::ZERO);
        let (pairs, last) = bonds.neighbors[row.clone()].as_chunks::<2>();
        let (weights, last_weight) = bonds.weights[row].as_chunks::<2>();
        // By number: zipped iterators would be called, off the instruction path.
        let ahead = &bonds.neighbors[(first + AHEAD).min(bonds.neighbors.len())..];
        for n in 0..pairs.len() {
            let (j, weight) = (pairs[n], weights[n]);
            if 2 * n + 1 < ahead.len() {
                a.prefetch(records, ahead[2 * n] as usize);
                a.prefetch(records, ahead[2 * n + 1] as usize);
            }
            even.add(a, &records[j[0] as usize], weight[0]);
            odd.add(a, &records[j[1] as usize], weight[1]);
        }
        if let ([j], [weight]) = (last, last_weight) {
            even.add(a, &records[*j as usize], *weight);
        }
        even.combined(a, &odd)
    }
}

impl<const D: usize> SumOverBonds for BondSum<D> {
    type Record = CorrectedStress;
    const ZERO: Self = Self { columns: [Lanes4::ZERO; D], traction: Lanes4::ZERO };

    #[inline(always)]
    fn add<A: FourLanes>(&mut self, a: A, other: &CorrectedStress, weight: f32) {
        let weight = f64::from(weight) * other.traction.0[3];
        for axis in 0..D {
            self.columns[axis] = a.scale_add(weight, other.columns[axis], self.columns[axis]);
        }
        self.traction = a.scale_add(weight, other.traction, self.traction);
    }

    #[inline(always)]
    fn combined<A: FourLanes>(mut self, a: A, other: &Self) -> Self {
        for axis in 0..D {
            self.columns[axis] = a.add(self.columns[axis], other.columns[axis]);
        }
        self.traction = a.add(self.traction, other.traction);
        self
    }
}
