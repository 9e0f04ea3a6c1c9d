//! Sums over the pairs of one particle with the particles of one body: what the forces of the second pass are made of.

use super::batch::{BATCH, Batch};
use super::cloud::FlowCloud;
use super::kernel::FluidKernel;
use super::record::{FILLS, Four, Own, as_rows, dot, filled_up};
use crate::pair::{FourPairs, Room};
use crate::parallel::{Arithmetic, Lanes4};

/// The pairs of particle `i` with the neighbours in `row`.
pub(super) struct Pairs<'a, const D: usize> {
    pub cloud: &'a FlowCloud,
    pub kernel: FluidKernel,
    pub i: usize,
    pub own: Own<D>,
    pub row: &'a [u32],
    /// Twice the viscosity between the two, Pa s.
    pub viscosity: f64,
}

/// Sums over the neighbours.
pub(super) struct Sums<const D: usize> {
    /// sum V_j w x_ij; zero between fluids.
    pub gradient: [Lanes4; D],
    /// sum V_j p_j w x_ij; between fluids sum V_j (p_i + p_j) w x_ij.
    pub pressure: [Lanes4; D],
    /// sum V_j 2 mu w v_ij.
    pub viscous: [Lanes4; D],
}

impl<const D: usize> Sums<D> {
    const ZERO: Self =
        Self { gradient: [Lanes4::ZERO; D], pressure: [Lanes4::ZERO; D], viscous: [Lanes4::ZERO; D] };

    #[inline(always)]
    fn add<A: Arithmetic, const FLUIDS: bool, const VISCOUS: bool>(
        &mut self,
        a: A,
        four: &Four<D>,
        weight: Lanes4,
        Pairs { own, viscosity, .. }: &Pairs<'_, D>,
    ) {
        let mut pressure = four.pressure;
        if FLUIDS {
            pressure = a.plus(pressure, own.pressure);
        }
        let pressure = a.times(weight, pressure);
        for axis in 0..D {
            self.pressure[axis] = a.times_add(pressure, four.x[axis], self.pressure[axis]);
            if !FLUIDS {
                self.gradient[axis] = a.times_add(weight, four.x[axis], self.gradient[axis]);
            }
        }
        if VISCOUS {
            let friction = a.scale(*viscosity, weight);
            for axis in 0..D {
                self.viscous[axis] = a.times_add(friction, four.v[axis], self.viscous[axis]);
            }
        }
    }
}

impl<const D: usize> Sums<D> {
    /// Adds four neighbours in fluids.
    #[inline(always)]
    fn add_fluid<A: Arithmetic, const VISCOUS: bool>(
        &mut self,
        a: A,
        FourPairs { current, velocity, weight, volume_j, .. }: &FourPairs,
        pressure: Lanes4,
        viscosity: f64,
    ) {
        let weight = a.times(*weight, *volume_j);
        let pressure = a.times(weight, pressure);
        for axis in 0..D {
            self.pressure[axis] = a.times_add(pressure, current.vector[axis], self.pressure[axis]);
        }
        if VISCOUS {
            let friction = a.scale(viscosity, weight);
            for axis in 0..D {
                self.viscous[axis] = a.times_add(friction, velocity[axis], self.viscous[axis]);
            }
        }
    }
}

impl<const D: usize> Pairs<'_, D> {
    /// The sums.
    #[inline(always)]
    pub fn sum<A: Arithmetic, const P: bool, const FLUIDS: bool>(&self, a: A) -> Sums<D> {
        if self.viscosity > 0.0 {
            self.sum_all::<A, P, FLUIDS, true>(a)
        } else {
            self.sum_all::<A, P, FLUIDS, false>(a)
        }
    }

    #[inline(always)]
    fn sum_all<A: Arithmetic, const P: bool, const FLUIDS: bool, const VISCOUS: bool>(
        &self,
        a: A,
    ) -> Sums<D> {
        let Self { cloud: FlowCloud { records, periods, .. }, kernel, own, .. } = self;
        let mut sum = Sums::ZERO;
        for chunk in self.row.chunks(4) {
            let rows = as_rows(filled_up(chunk, self.i));
            let four = Four::<D>::gather::<A, P>(a, records, own, rows, periods);
            let distance = a.sqrt(dot(a, &four.x, &four.x));
            let weight = a.times(kernel.weights(a, distance), four.volume);
            sum.add::<A, FLUIDS, VISCOUS>(a, &four, weight, self);
        }
        sum
    }

    /// The same between fluids, with the geometry of the pairs put into `room`, rows counted from `before` on.
    #[inline(always)]
    pub fn sum_and_keep<A: Arithmetic, const P: bool>(
        &self,
        a: A,
        Room { pairs, rows, .. }: Room<'_>,
        before: u32,
        batch: &mut Batch,
        with_kernel: bool,
    ) -> Sums<D> {
        let mut sum = Sums::ZERO;
        let (fours, rest) = self.row.as_chunks();
        let mut done = 0;
        // Chained iterators would be called in the loop, off the instruction path.
        while done < pairs.len() {
            let end = (done + BATCH).min(pairs.len());
            for k in done..end {
                let (four, count) =
                    if k < fours.len() { (fours[k], 4) } else { (filled_up(rest, self.i), rest.len()) };
                let (square, pressure) = self.gather::<A, P>(a, four, count, &mut pairs[k]);
                batch.put(k, square, pressure);
                rows[k] = counted_from(before, four);
            }
            for k in done..end {
                let (square, pressure) = batch.get(k);
                let distance = a.sqrt(square);
                let weight = self.kernel.weights(a, distance);
                pairs[k].current.length = distance;
                pairs[k].weight = weight;
                if self.viscosity > 0.0 {
                    sum.add_fluid::<A, true>(a, &pairs[k], pressure, self.viscosity);
                } else {
                    sum.add_fluid::<A, false>(a, &pairs[k], pressure, self.viscosity);
                }
            }
            done = end;
        }
        if with_kernel {
            for four in pairs {
                four.kernel = self.kernel.values(a, four.current.length);
            }
        }
        sum
    }

    /// Puts four neighbours into `kept`, all but lengths and weights; gives squares of the lengths and p_i + p_j.
    #[inline(always)]
    fn gather<A: Arithmetic, const P: bool>(
        &self,
        a: A,
        rows: [u32; 4],
        count: usize,
        kept: &mut FourPairs,
    ) -> (Lanes4, Lanes4) {
        let Self { cloud: FlowCloud { records, periods, .. }, kernel, own, .. } = self;
        let four = Four::<D>::gather::<A, P>(a, records, own, as_rows(rows), periods);
        let (square, volume) = kernel.within(a, dot(a, &four.x, &four.x), FILLS[count], four.volume);
        for axis in 0..D {
            kept.current.vector[axis] = four.x[axis];
            kept.velocity[axis] = four.v[axis];
        }
        kept.support = Lanes4::splat(kernel.support);
        kept.volume_j = volume;
        (square, a.plus(four.pressure, own.pressure))
    }
}

#[inline(always)]
fn counted_from(before: u32, [j, k, l, m]: [u32; 4]) -> [u32; 4] {
    [j - before, k - before, l - before, m - before]
}
