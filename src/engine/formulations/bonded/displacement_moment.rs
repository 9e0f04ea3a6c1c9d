//! Weighted sums over the bonds of a particle, and the fit of its deformation gradient to them.

use super::bonds::Bonds;
use super::rows::PackedParticle;
use crate::parallel::{FourLanes, Lanes4};

/// Sums over the bonds of a particle. There are two of them in the loop, for every other bond, so that
/// additions need not wait for each other.
pub(in crate::formulations) struct DisplacementMoment<const D: usize> {
    /// Columns of `sum_j V_j w_ij u_ij (x) X_ij`: X_i is taken off behind the loop. u_ij is made first, so
    /// that a body that has moved as a whole has no gradient, to the bit.
    pub spread: [Lanes4; D],
    /// `sum_j V_j w_ij u_ij`.
    pub stretched: Lanes4,
    /// `sum_j V_j w_ij u_ij^2` per component.
    pub square: Lanes4,
}

impl<const D: usize> DisplacementMoment<D> {
    const ZERO: Self = Self { spread: [Lanes4::ZERO; D], stretched: Lanes4::ZERO, square: Lanes4::ZERO };

    /// The sums over the bonds of row `i`.
    #[inline(always)]
    pub fn over<A: FourLanes>(a: A, bonds: &Bonds, sites: &[PackedParticle], i: usize) -> Self {
        let site = sites[i];
        let row = bonds.offsets[i] as usize..bonds.offsets[i + 1] as usize;
        let (mut even, mut odd) = (Self::ZERO, Self::ZERO);
        let (pairs, last) = bonds.neighbors[row.clone()].as_chunks::<2>();
        let (weights, last_weight) = bonds.weights[row].as_chunks::<2>();
        // By number: zipped iterators would be called, off the instruction path.
        for n in 0..pairs.len() {
            let (j, weight) = (pairs[n], weights[n]);
            even.add(a, site.displacement, &sites[j[0] as usize], weight[0]);
            odd.add(a, site.displacement, &sites[j[1] as usize], weight[1]);
        }
        if let ([j], [weight]) = (last, last_weight) {
            even.add(a, site.displacement, &sites[*j as usize], *weight);
        }
        let mut sums = even.combined(a, &odd);
        for axis in 0..D {
            sums.spread[axis] = a.scale_add(-site.reference.0[axis], sums.stretched, sums.spread[axis]);
        }
        sums
    }

    #[inline(always)]
    fn add<A: FourLanes>(&mut self, a: A, displacement: Lanes4, other: &PackedParticle, weight: f32) {
        let displacement = a.sub(other.displacement, displacement);
        let weighted = a.scale(f64::from(weight) * other.reference.0[3], displacement);
        for axis in 0..D {
            self.spread[axis] = a.scale_add(other.reference.0[axis], weighted, self.spread[axis]);
        }
        self.stretched = a.add(self.stretched, weighted);
        self.square = a.mul_add(displacement, weighted, self.square);
    }

    #[inline(always)]
    fn combined<A: FourLanes>(mut self, a: A, other: &Self) -> Self {
        for axis in 0..D {
            self.spread[axis] = a.add(self.spread[axis], other.spread[axis]);
        }
        self.stretched = a.add(self.stretched, other.stretched);
        self.square = a.add(self.square, other.square);
        self
    }
}
