//! Records of the neighbours within the support, gathered into rows of lanes, and moments summed from them.
//!
//! Lanes hold neighbours by their order within the support, so that sums do not depend on the skin of lists.

use super::particle::EulerianParticle;
use super::within::{Center, filled_up, places, records};
use crate::correction::MomentMatrix;
use crate::linalg::Sym3;
use crate::parallel::{FourLanes, Lanes4};

/// Neighbours whose records are gathered together: they stay in the first-level cache.
pub(super) const BATCH: usize = 64;
/// The same in vectors.
pub(super) const FOURS: usize = BATCH / 4;

/// Records of at most [`BATCH`] neighbours.
pub(super) trait NeighborBatch {
    fn arms(&mut self) -> &mut Arms;

    /// Puts into vector `n` what a pass needs of four particles beyond [`Arms`].
    fn put<A: FourLanes>(&mut self, a: A, n: usize, of: [&EulerianParticle; 4]);

    /// Gathers the records of some neighbours. Returns the number of vectors.
    #[inline(always)]
    fn gather<A: FourLanes, const STRETCHED: bool>(
        &mut self,
        a: A,
        center: &Center<'_, A, STRETCHED>,
        near: &[u32],
        points: &[EulerianParticle],
    ) -> usize {
        let (fours, rest) = near.as_chunks::<4>();
        for n in 0..fours.len().min(FOURS) {
            let of = records(&fours[n], points);
            self.arms().put(a, n, center, &fours[n], of);
            self.put(a, n, of);
        }
        if rest.is_empty() {
            return fours.len().min(FOURS);
        }
        let four = filled_up(rest);
        let of = records(&four, points);
        self.arms().put(a, fours.len(), center, &four, of);
        self.put(a, fours.len(), of);
        self.arms().clear_from(rest.len(), fours.len(), center.support);
        (fours.len() + 1).min(FOURS)
    }
}

/// Velocities and present volumes of four particles.
#[inline(always)]
pub(super) fn velocities(of: [&EulerianParticle; 4]) -> [Lanes4; 4] {
    [of[0].velocity, of[1].velocity, of[2].velocity, of[3].velocity]
}

/// Pair vectors of a batch of neighbours, four in a vector.
pub(super) struct Arms {
    /// x_ij, m.
    pub arm: [[Lanes4; 3]; FOURS],
    /// V_0,j, m3.
    pub volume: [Lanes4; FOURS],
    /// Distances, m.
    pub distance: [Lanes4; FOURS],
    /// Factors of the kernel, where supports are ellipsoids.
    pub density: [Lanes4; FOURS],
}

impl Arms {
    pub const NONE: Self = Self {
        arm: [[Lanes4::ZERO; 3]; FOURS],
        volume: [Lanes4::ZERO; FOURS],
        distance: [Lanes4::ZERO; FOURS],
        density: [Lanes4::ZERO; FOURS],
    };

    /// Puts four particles into vector `n`.
    #[inline(always)]
    pub fn put<A: FourLanes, const STRETCHED: bool>(
        &mut self,
        a: A,
        n: usize,
        center: &Center<'_, A, STRETCHED>,
        four: &[u32; 4],
        of: [&EulerianParticle; 4],
    ) {
        let (arm, volume) = center.arms(a, places(of));
        let (square, density) = center.measure(a, four, &arm);
        self.distance[n] = a.sqrt(square);
        if STRETCHED {
            self.density[n] = density;
        }
        (self.arm[n], self.volume[n]) = (arm, volume);
    }

    /// The distances of the first vectors, filled up by others so that loops need no remainder.
    #[inline(always)]
    pub fn distances(&self, fours: usize) -> &[f64] {
        bytemuck::cast_slice(&self.distance[..fours.next_multiple_of(4).min(FOURS)])
    }

    /// The factors of the kernel of the first vectors.
    #[inline(always)]
    pub fn densities(&self, number: usize) -> &[f64] {
        &bytemuck::cast_slice(&self.density)[..number]
    }

    /// Lets the lanes of vector `n` from `count` on hold nothing: no volume, beyond the support.
    #[inline(always)]
    pub fn clear_from(&mut self, count: usize, n: usize, support: f64) {
        for lane in count..4 {
            self.volume[n].0[lane] = 0.0;
            self.distance[n].0[lane] = 2.0 * support;
        }
    }
}

/// Sums of `V_0,j w_ij x_ij (x) x_ij` in lanes.
#[derive(Clone, Copy)]
pub(super) struct MomentSums {
    diagonal: [Lanes4; 3],
    /// Components xy, xz, yz.
    beside: [Lanes4; 3],
}

impl MomentSums {
    pub const ZERO: Self = Self { diagonal: [Lanes4::ZERO; 3], beside: [Lanes4::ZERO; 3] };

    /// Adds four neighbours by x_ij and V_0,j w_ij x_ij.
    #[inline(always)]
    pub fn add<A: FourLanes>(&mut self, a: A, [x, y, z]: &[Lanes4; 3], weighted: &[Lanes4; 3]) {
        let [wx, wy, wz] = weighted;
        self.diagonal[0] = a.mul_add(*x, *wx, self.diagonal[0]);
        self.diagonal[1] = a.mul_add(*y, *wy, self.diagonal[1]);
        self.beside[0] = a.mul_add(*x, *wy, self.beside[0]);
        if A::AXES == 3 {
            self.diagonal[2] = a.mul_add(*z, *wz, self.diagonal[2]);
            self.beside[1] = a.mul_add(*x, *wz, self.beside[1]);
            self.beside[2] = a.mul_add(*y, *wz, self.beside[2]);
        }
    }

    /// The moment matrix, and the sum over the lanes of one more vector.
    #[inline(always)]
    pub fn sum<A: FourLanes>(&self, a: A, other: Lanes4) -> (MomentMatrix, f64) {
        let [xx, yy, zz] = self.diagonal;
        let [xy, xz, yz] = self.beside;
        let [xx, yy, xy, other] = a.sums([xx, yy, xy, other]).0;
        if A::AXES == 2 {
            return (MomentMatrix::of(Sym3 { xx, yy, xy, ..Sym3::ZERO }, 2), other);
        }
        let [zz, xz, yz, _] = a.sums([zz, xz, yz, Lanes4::ZERO]).0;
        (MomentMatrix::of(Sym3 { xx, yy, zz, xy, xz, yz }, 3), other)
    }
}

/// V_0,j w_ij x_ij of four neighbours by V_0,j w_ij and x_ij.
#[inline(always)]
pub(super) fn weighted<A: FourLanes>(a: A, weight: Lanes4, [x, y, z]: &[Lanes4; 3]) -> [Lanes4; 3] {
    let z = if A::AXES == 3 { a.mul(*z, weight) } else { Lanes4::ZERO };
    [a.mul(*x, weight), a.mul(*y, weight), z]
}
