//! The listed neighbours of a particle that are within its support, and their records in lanes.
//!
//! Lists have a skin, and the neighbours in it are in no order that a processor could guess. One loop
//! therefore finds the neighbours within the support, four at once and without a branch. Others gather their
//! records into rows of lanes, from which kernels and sums are evaluated four neighbours at a time. Lanes
//! hold neighbours by their order within the support, so that sums do not depend on the skin.

use super::particle::EulerianParticle;
use crate::correction::MomentMatrix;
use crate::linalg::Sym3;
use crate::parallel::{FourLanes, Lanes4};

/// Neighbours whose records are gathered together: they stay in the first-level cache.
pub(super) const BATCH: usize = 64;
/// The same in vectors.
pub(super) const FOURS: usize = BATCH / 4;

/// The particle itself in all lanes.
#[derive(Clone, Copy)]
pub(super) struct Center {
    place: [Lanes4; 3],
    /// Its support radius, m.
    support: f64,
}

impl Center {
    /// A particle at `place` with its support radius, m.
    #[inline(always)]
    pub fn new(place: Lanes4, support: f64) -> Self {
        let [x, y, z, _] = place.0;
        Self { place: [Lanes4::splat(x), Lanes4::splat(y), Lanes4::splat(z)], support }
    }

    /// Writes the neighbours in `list` within the support, in their order, to the front of `near`, which is
    /// as long: neither removed particles nor the particle itself. Returns their number.
    #[inline(always)]
    pub fn find<A: FourLanes>(
        &self,
        a: A,
        list: &[u32],
        points: &[EulerianParticle],
        near: &mut [u32],
    ) -> usize {
        let (fours, rest) = list.as_chunks::<4>();
        let mut count = 0;
        // By number, and without closures: these would be called.
        for n in 0..fours.len() {
            let bits = self.look(a, &fours[n], points);
            if let Some(next) = near[count..].first_chunk_mut() {
                *next = a.pack(fours[n], bits);
            }
            count += bits.count_ones() as usize;
        }
        if !rest.is_empty() {
            let four = filled_up(rest);
            let bits = self.look(a, &four, points);
            for lane in 0..rest.len() {
                near[count] = four[lane];
                count += bits >> lane & 1;
            }
        }
        count
    }

    /// A bit for each of four particles that is a neighbour.
    #[inline(always)]
    fn look<A: FourLanes>(&self, a: A, four: &[u32; 4], points: &[EulerianParticle]) -> usize {
        let (arm, volume) = self.arms(a, places(records(four, points)));
        let square = square(a, &arm);
        let is_there = a.below(Lanes4::ZERO, square) & a.below(Lanes4::ZERO, volume);
        a.below(square, Lanes4::splat(self.support * self.support)) & is_there
    }

    /// x_ij of four records of places, m, and the volumes in them, m3.
    #[inline(always)]
    pub fn arms<A: FourLanes>(&self, a: A, places: [Lanes4; 4]) -> ([Lanes4; 3], Lanes4) {
        let [x, y, z, volume] = a.transpose(places);
        let z = if A::AXES == 3 { a.sub(z, self.place[2]) } else { Lanes4::ZERO };
        ([a.sub(x, self.place[0]), a.sub(y, self.place[1]), z], volume)
    }
}

/// Fewer than four rows, the first of them again in the lanes that are left.
#[inline(always)]
pub(super) fn filled_up(rest: &[u32]) -> [u32; 4] {
    let mut four = [rest[0]; 4];
    four[..rest.len()].copy_from_slice(rest);
    four
}

/// Squares of the lengths of four vectors.
#[inline(always)]
fn square<A: FourLanes>(a: A, [x, y, z]: &[Lanes4; 3]) -> Lanes4 {
    let square = a.mul_add(*y, *y, a.mul(*x, *x));
    if A::AXES == 3 { a.mul_add(*z, *z, square) } else { square }
}

/// The records of four particles.
#[inline(always)]
pub(super) fn records<'a>(four: &[u32; 4], points: &'a [EulerianParticle]) -> [&'a EulerianParticle; 4] {
    let [j, k, l, m] = [four[0] as usize, four[1] as usize, four[2] as usize, four[3] as usize];
    [&points[j], &points[k], &points[l], &points[m]]
}

/// Their places and reference volumes.
#[inline(always)]
fn places(of: [&EulerianParticle; 4]) -> [Lanes4; 4] {
    [of[0].place, of[1].place, of[2].place, of[3].place]
}

/// Their velocities and present volumes.
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
}

impl Arms {
    pub const NONE: Self = Self {
        arm: [[Lanes4::ZERO; 3]; FOURS],
        volume: [Lanes4::ZERO; FOURS],
        distance: [Lanes4::ZERO; FOURS],
    };

    /// Puts four particles into vector `n`.
    #[inline(always)]
    pub fn put<A: FourLanes>(&mut self, a: A, n: usize, center: &Center, of: [&EulerianParticle; 4]) {
        let (arm, volume) = center.arms(a, places(of));
        self.distance[n] = a.sqrt(square(a, &arm));
        (self.arm[n], self.volume[n]) = (arm, volume);
    }

    /// The distances of the first vectors, filled up by others so that loops need no remainder.
    #[inline(always)]
    pub fn distances(&self, fours: usize) -> &[f64] {
        bytemuck::cast_slice(&self.distance[..fours.next_multiple_of(4).min(FOURS)])
    }

    /// Lets the lanes of vector `n` from `count` on hold nothing: no volume, beyond the support.
    #[inline(always)]
    pub fn clear_from(&mut self, count: usize, n: usize, center: &Center) {
        for lane in count..4 {
            self.volume[n].0[lane] = 0.0;
            self.distance[n].0[lane] = 2.0 * center.support;
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
