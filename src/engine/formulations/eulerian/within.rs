//! The listed neighbours of a particle that are within its support.
//!
//! Lists have a skin, and the neighbours in it are in no order that a processor could guess. One loop
//! therefore finds the neighbours within the support, four at once and without a branch.

use super::particle::EulerianParticle;
use crate::formulations::bonded::{OwnEllipsoid, SeenEllipsoid};
use crate::parallel::{FourLanes, Lanes4, Vector};

/// The particle itself in all lanes; `STRETCHED` where supports are ellipsoids.
#[derive(Clone, Copy)]
pub(super) struct Center<'a, A: FourLanes, const STRETCHED: bool> {
    place: [Lanes4; 3],
    /// Its support radius, m.
    pub support: f64,
    ellipsoid: OwnEllipsoid<A>,
    ellipsoids: &'a [SeenEllipsoid],
}

impl<'a, A: FourLanes, const STRETCHED: bool> Center<'a, A, STRETCHED> {
    /// The particle in `row` at `place` with its support radius, m, and the ellipsoids of all.
    #[inline(always)]
    pub fn new(a: A, (row, place): (usize, Lanes4), support: f64, ellipsoids: &'a [SeenEllipsoid]) -> Self {
        let [x, y, z, _] = place.0;
        let own = if STRETCHED { ellipsoids[row] } else { SeenEllipsoid::default() };
        Self {
            place: [Lanes4::splat(x), Lanes4::splat(y), Lanes4::splat(z)],
            support,
            ellipsoid: OwnEllipsoid::new(a, &own),
            ellipsoids,
        }
    }

    /// Writes the neighbours in `list` within the support, in their order, to the front of `near`, which is
    /// as long: neither removed particles nor the particle itself. Returns their number.
    #[inline(always)]
    pub fn find(&self, a: A, list: &[u32], points: &[EulerianParticle], near: &mut [u32]) -> usize {
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
    fn look(&self, a: A, four: &[u32; 4], points: &[EulerianParticle]) -> usize {
        let (arm, volume) = self.arms(a, places(records(four, points)));
        let square = self.measure(a, four, &arm).0;
        let is_there = a.below(Lanes4::ZERO, square) & a.below(Lanes4::ZERO, volume);
        a.below(square, Lanes4::splat(self.support * self.support)) & is_there
    }

    /// Squares of four distances, m2, and the factors of the kernel.
    #[inline(always)]
    pub fn measure(&self, a: A, four: &[u32; 4], arm: &[Lanes4; 3]) -> (Lanes4, Lanes4) {
        if !STRETCHED {
            return (square(a, arm), Lanes4::splat(1.0));
        }
        let seen = self.ellipsoid.measure(a, Vector::new(a, *arm), records(four, self.ellipsoids));
        (seen.square.lanes(), seen.density.lanes())
    }

    /// x_ij of four records of places, m, and the volumes in them, m3.
    #[inline(always)]
    pub fn arms(&self, a: A, places: [Lanes4; 4]) -> ([Lanes4; 3], Lanes4) {
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

/// The records of four particles. The map of an array would be called.
#[inline(always)]
pub(super) fn records<'a, T>(four: &[u32; 4], all: &'a [T]) -> [&'a T; 4] {
    let [j, k, l, m] = [four[0] as usize, four[1] as usize, four[2] as usize, four[3] as usize];
    [&all[j], &all[k], &all[l], &all[m]]
}

/// Their places and reference volumes.
#[inline(always)]
pub(super) fn places(of: [&EulerianParticle; 4]) -> [Lanes4; 4] {
    [of[0].place, of[1].place, of[2].place, of[3].place]
}
