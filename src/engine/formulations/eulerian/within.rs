//! The listed neighbours of a particle that are within its support, and their distances.
//!
//! Lists have a skin, so that almost half of the listed neighbours are farther away, in no order that a
//! processor could guess. One loop therefore finds the neighbours within the support, four at once and
//! without a branch; kernels are then evaluated for these alone, by loops over contiguous rows.

use super::particle::EulerianParticle;
use crate::parallel::{FourLanes, Lanes4};

/// Listed neighbours that are examined together: their values stay in the first-level cache.
pub(super) const CHUNK: usize = 64;

/// Neighbours within the support, and the squares of their distances, m2: as many as the list has at most.
pub(super) struct Within<'r> {
    pub neighbors: &'r mut [u32],
    pub squares: &'r mut [f64],
}

/// The particle itself in all lanes, and the square of its support radius, m2.
#[derive(Clone, Copy)]
struct Center {
    place: [Lanes4; 3],
    limit: Lanes4,
}

impl Within<'_> {
    /// Finds the neighbours in `list` within the support of the particle at `own`, whose square is `limit`,
    /// m2, in the order of the list: neither removed particles nor the particle itself. Returns their number.
    #[inline(always)]
    pub fn find<A: FourLanes>(
        self,
        a: A,
        list: &[u32],
        (own, limit): (Lanes4, f64),
        points: &[EulerianParticle],
    ) -> usize {
        let Self { neighbors, squares } = self;
        let place = [Lanes4::splat(own.0[0]), Lanes4::splat(own.0[1]), Lanes4::splat(own.0[2])];
        let center = Center { place, limit: Lanes4::splat(limit) };
        let (fours, rest) = list.as_chunks::<4>();
        let mut count = 0;
        // By number, and without closures: these would be called.
        for n in 0..fours.len() {
            let (square, near) = center.look(a, &fours[n], points);
            for lane in 0..4 {
                neighbors[count] = fours[n][lane];
                squares[count] = square.0[lane];
                count += near >> lane & 1;
            }
        }
        if !rest.is_empty() {
            let mut four = [rest[0]; 4];
            four[..rest.len()].copy_from_slice(rest);
            let (square, near) = center.look(a, &four, points);
            for lane in 0..rest.len() {
                neighbors[count] = four[lane];
                squares[count] = square.0[lane];
                count += near >> lane & 1;
            }
        }
        count
    }
}

impl Center {
    /// Squares of the distances of four particles, m2, and a bit for each that is a neighbour.
    #[inline(always)]
    fn look<A: FourLanes>(&self, a: A, four: &[u32; 4], points: &[EulerianParticle]) -> (Lanes4, usize) {
        let [j, k, l, m] = [four[0] as usize, four[1] as usize, four[2] as usize, four[3] as usize];
        let [x, y, z, volume] =
            a.transpose([points[j].place, points[k].place, points[l].place, points[m].place]);
        let (x, y) = (a.sub(x, self.place[0]), a.sub(y, self.place[1]));
        let mut square = a.mul_add(y, y, a.mul(x, x));
        if A::AXES == 3 {
            let z = a.sub(z, self.place[2]);
            square = a.mul_add(z, z, square);
        }
        let is_there = a.below(Lanes4::ZERO, square) & a.below(Lanes4::ZERO, volume);
        (square, a.below(square, self.limit) & is_there)
    }
}
