//! Vectors of four particles, in three rows of lanes in their memory order: x0 y0 z0 x1, y1 z1 x2 y2, z2 x3
//! y3 z3.
//!
//! Operations on each component alone need no shuffle.

use glam::DVec3;

use crate::parallel::{FourLanes, Lanes4};

/// Numbers of four vectors.
const FOUR: usize = 12;

/// One vector for each of four particles.
#[derive(Clone, Copy)]
pub(super) struct FourOfColumn([Lanes4; 3]);

impl FourOfColumn {
    /// The first four vectors of a column; where there are fewer, the rest is zero.
    #[inline(always)]
    pub fn load(numbers: &[f64]) -> Self {
        if let Some(n) = numbers.first_chunk::<FOUR>() {
            return Self::of(n);
        }
        let mut all = [0.0; FOUR];
        all[..numbers.len()].copy_from_slice(numbers);
        Self::of(&all)
    }

    #[inline(always)]
    fn of(n: &[f64; FOUR]) -> Self {
        Self([
            Lanes4([n[0], n[1], n[2], n[3]]),
            Lanes4([n[4], n[5], n[6], n[7]]),
            Lanes4([n[8], n[9], n[10], n[11]]),
        ])
    }

    /// Writes them to a column, as many as fit.
    #[inline(always)]
    pub fn store(self, numbers: &mut [f64]) {
        let [a, b, c] = self.0;
        if let Some(n) = numbers.first_chunk_mut::<FOUR>() {
            *n = [
                a.0[0], a.0[1], a.0[2], a.0[3], b.0[0], b.0[1], b.0[2], b.0[3], c.0[0], c.0[1], c.0[2],
                c.0[3],
            ];
        } else {
            for (k, number) in numbers.iter_mut().enumerate() {
                *number = self.0[k / 4].0[k % 4];
            }
        }
    }

    /// The same vector four times.
    #[inline(always)]
    pub fn splat(v: DVec3) -> Self {
        Self([Lanes4([v.x, v.y, v.z, v.x]), Lanes4([v.y, v.z, v.x, v.y]), Lanes4([v.z, v.x, v.y, v.z])])
    }

    /// A number of each of four particles, in all components; where there are fewer, the rest is zero.
    #[inline(always)]
    pub fn of_numbers(numbers: &[f64]) -> Self {
        let m = if let Some(four) = numbers.first_chunk::<4>() {
            *four
        } else {
            let mut four = [0.0; 4];
            four[..numbers.len()].copy_from_slice(numbers);
            four
        };
        Self([
            Lanes4([m[0], m[0], m[0], m[1]]),
            Lanes4([m[1], m[1], m[2], m[2]]),
            Lanes4([m[2], m[3], m[3], m[3]]),
        ])
    }

    /// The bits in which any component differs.
    #[inline(always)]
    pub fn difference(self, other: Self) -> u64 {
        let mut bits = [0; 4];
        for row in 0..3 {
            for lane in 0..4 {
                bits[lane] |= self.0[row].0[lane].to_bits() ^ other.0[row].0[lane].to_bits();
            }
        }
        bits[0] | bits[1] | bits[2] | bits[3]
    }

    /// Products of components.
    #[inline(always)]
    pub fn mul<A: FourLanes>(self, a: A, other: Self) -> Self {
        let ([x, y, z], [p, q, r]) = (self.0, other.0);
        Self([a.mul(x, p), a.mul(y, q), a.mul(z, r)])
    }

    /// `self + s other`.
    #[inline(always)]
    pub fn add_scaled<A: FourLanes>(self, a: A, s: f64, other: Self) -> Self {
        let ([x, y, z], [p, q, r]) = (self.0, other.0);
        Self([a.scale_add(s, p, x), a.scale_add(s, q, y), a.scale_add(s, r, z)])
    }

    /// The components along which the mobility is zero; zero for the others.
    #[inline(always)]
    pub fn where_held<A: FourLanes>(self, a: A, mobility: Self) -> Self {
        let least = Lanes4::splat(f64::MIN_POSITIVE);
        let ([x, y, z], [p, q, r]) = (self.0, mobility.0);
        Self([a.where_below(p, least, x), a.where_below(q, least, y), a.where_below(r, least, z)])
    }

    /// `sum` and the scalar products with other vectors, spread over its lanes.
    #[inline(always)]
    pub fn dot_onto<A: FourLanes>(self, a: A, other: Self, sum: Lanes4) -> Lanes4 {
        let ([x, y, z], [p, q, r]) = (self.0, other.0);
        a.mul_add(z, r, a.mul_add(y, q, a.mul_add(x, p, sum)))
    }

    /// Squares of the lengths of the four vectors.
    #[inline(always)]
    pub fn squares<A: FourLanes>(self, a: A) -> Lanes4 {
        let Self([Lanes4(p), Lanes4(q), Lanes4(r)]) = self.mul(a, self);
        let (x, y, z) = (
            Lanes4([p[0], p[3], q[2], r[1]]),
            Lanes4([p[1], q[0], q[3], r[2]]),
            Lanes4([p[2], q[1], r[0], r[3]]),
        );
        a.add(a.add(x, y), z)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::parallel::{HotLoop, run_hot};

    struct Check;

    impl HotLoop for Check {
        type Output = ();

        fn run<A: FourLanes>(self, a: A) {
            let numbers: Vec<f64> = (0..FOUR).map(|k| (1.0 + k as f64).sin()).collect();
            let vectors: Vec<DVec3> = numbers.chunks(3).map(DVec3::from_slice).collect();
            for count in 0..=4 {
                let four = FourOfColumn::load(&numbers[..3 * count]);
                let mut out = vec![7.0; 3 * count];
                four.store(&mut out);
                assert_eq!(out, numbers[..3 * count]);
                let wanted = |k: usize| if k < count { vectors[k].length_squared() } else { 0.0 };
                let squares = four.squares(a).0;
                assert!((0..4).all(|k| (squares[k] - wanted(k)).abs() < 1e-15), "{squares:?}");

                let g = DVec3::new(0.3, -2.0, 5.0);
                let masses = [1.0, 2.0, 4.0, 8.0];
                let weights = FourOfColumn::of_numbers(&masses[..count]).mul(a, FourOfColumn::splat(g));
                let sum = four.dot_onto(a, weights, Lanes4::ZERO).sum();
                let wanted: f64 = (0..count).map(|k| masses[k] * g.dot(vectors[k])).sum();
                assert!((sum - wanted).abs() < 1e-13, "{sum} {wanted}");
            }
            let held = FourOfColumn::splat(DVec3::new(0.0, 3.0, 0.0));
            let mut out = [0.0; FOUR];
            FourOfColumn::load(&numbers).where_held(a, held).store(&mut out);
            assert!((0..FOUR).all(|k| out[k] == if k % 3 == 1 { 0.0 } else { numbers[k] }));
        }
    }

    #[test]
    fn components_stay_with_their_particles() {
        run_hot(Check);
    }
}
