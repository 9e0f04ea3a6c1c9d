//! Sums over the pairs of one particle with the particles of one body: the forces of the second pass.

use super::cloud::FlowCloud;
use super::kernel::FluidKernel;
use super::record::{Four, MASKS, Own, as_rows, dot, filled_up};
use crate::pair::{FourPairs, Room};
use crate::parallel::{Arithmetic, Lanes4};

/// The pairs of a particle with the neighbours in `row`.
pub(super) struct Pairs<'a, const D: usize> {
    pub cloud: &'a FlowCloud,
    pub kernel: FluidKernel,
    pub own: Own<D>,
    pub row: &'a [u32],
    /// Twice the viscosity between the two, Pa s.
    pub viscosity: f64,
}

/// What the neighbours of a particle do to it, per volume of it and in the lanes of the fours.
pub(super) struct Forces<const D: usize> {
    /// Of the pressures of fluids.
    pub pressure: [Lanes4; D],
    /// Of friction.
    pub viscous: [Lanes4; D],
    /// Of the pressures of boundaries.
    pub wall: [Lanes4; D],
}

impl<const D: usize> Forces<D> {
    pub const ZERO: Self =
        Self { pressure: [Lanes4::ZERO; D], viscous: [Lanes4::ZERO; D], wall: [Lanes4::ZERO; D] };

    /// Adds four neighbours: V_j (p_i + p_j) w x_ij and V_j 2 mu w v_ij between fluids.
    #[inline(always)]
    fn add_fluid<A: Arithmetic, const VISCOUS: bool>(
        &mut self,
        a: A,
        FourPairs { current, velocity, weight, volume_j, kept: pressure, .. }: &FourPairs,
        viscosity: f64,
    ) {
        let weight = a.times(*weight, *volume_j);
        let pressure = a.times(weight, *pressure);
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

/// Whose pressures act between a particle and its neighbours.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(super) enum Between {
    /// Both are fluids.
    Fluids,
    /// The neighbours bound the fluid.
    FluidAndBoundary,
    /// The particle bounds the fluid.
    BoundaryAndFluid,
}

impl<const D: usize> Pairs<'_, D> {
    /// Adds all neighbours.
    #[inline(always)]
    pub fn add<A: Arithmetic, const P: bool>(&self, a: A, between: Between, forces: &mut Forces<D>) {
        if self.viscosity > 0.0 {
            self.add_all::<A, P, true>(a, between, forces);
        } else {
            self.add_all::<A, P, false>(a, between, forces);
        }
    }

    #[inline(always)]
    fn add_all<A: Arithmetic, const P: bool, const VISCOUS: bool>(
        &self,
        a: A,
        between: Between,
        Forces { pressure, viscous, wall }: &mut Forces<D>,
    ) {
        // sum V_j w x_ij, and the same with p_j.
        let (mut gradient, mut of_j) = ([Lanes4::ZERO; D], [Lanes4::ZERO; D]);
        let (fours, rest) = self.row.as_chunks();
        for k in 0..fours.len() + usize::from(!rest.is_empty()) {
            let (rows, count) = if k < fours.len() { (fours[k], 4) } else { (filled_up(rest), rest.len()) };
            let Self { cloud: FlowCloud { records, periods, .. }, kernel, own, .. } = self;
            let four = Four::<D>::gather::<A, P>(a, records, own, as_rows(rows), periods);
            let distance = a.sqrt(dot(a, &four.x, &four.x));
            let weight = a.times(kernel.weights(a, distance), a.times(four.volume, MASKS[count]));
            let weight_j = a.times(weight, four.pressure);
            let friction = a.scale(self.viscosity, weight);
            for axis in 0..D {
                gradient[axis] = a.times_add(weight, four.x[axis], gradient[axis]);
                of_j[axis] = a.times_add(weight_j, four.x[axis], of_j[axis]);
                if VISCOUS {
                    viscous[axis] = a.times_add(friction, four.v[axis], viscous[axis]);
                }
            }
        }
        for axis in 0..D {
            let of_i = a.times(gradient[axis], self.own.pressure);
            let (of_fluid, of_wall) = match between {
                Between::Fluids => (a.plus(of_i, of_j[axis]), Lanes4::ZERO),
                Between::FluidAndBoundary => (of_i, of_j[axis]),
                Between::BoundaryAndFluid => (of_j[axis], of_i),
            };
            pressure[axis] = a.plus(pressure[axis], of_fluid);
            wall[axis] = a.plus(wall[axis], of_wall);
        }
    }

    /// The same between fluids, and puts the geometry of the pairs into `room`.
    ///
    /// Two loops: in one, a neighbour takes some ninety cycles from its index to its sum, and a processor looks ahead two or three fours.
    /// Taken apart, one gathers and one takes roots, each with short chains of instructions that wait for each other.
    #[inline(always)]
    pub fn add_and_keep<A: Arithmetic, const P: bool>(
        &self,
        a: A,
        Room { pairs, rows, .. }: Room<'_>,
        with_kernel: bool,
        forces: &mut Forces<D>,
    ) {
        let (fours, rest) = self.row.as_chunks();
        for k in 0..fours.len() {
            rows[k] = fours[k];
            self.gather::<A, P>(a, fours[k], &mut pairs[k]);
        }
        let full = fours.len();
        if !rest.is_empty() {
            rows[full] = filled_up(rest);
            self.gather::<A, P>(a, rows[full], &mut pairs[full]);
            pairs[full].volume_j = a.times(pairs[full].volume_j, MASKS[rest.len()]);
        }
        if self.viscosity > 0.0 {
            self.weigh::<A, true>(a, pairs, forces);
        } else {
            self.weigh::<A, false>(a, pairs, forces);
        }
        if with_kernel {
            for k in 0..pairs.len() {
                pairs[k].kernel = self.kernel.values(a, pairs[k].current.length);
            }
        }
        if !rest.is_empty() {
            let (last, mask) = (&mut pairs[full], MASKS[rest.len()]);
            last.weight = a.times(last.weight, mask);
            last.kernel = a.times(last.kernel, mask);
        }
    }

    /// Puts four neighbours into `kept`, all but lengths and weights: in place of the lengths their squares.
    #[inline(always)]
    fn gather<A: Arithmetic, const P: bool>(&self, a: A, rows: [u32; 4], kept: &mut FourPairs) {
        let Self { cloud: FlowCloud { records, periods, .. }, own, .. } = self;
        let four = Four::<D>::gather::<A, P>(a, records, own, as_rows(rows), periods);
        for axis in 0..D {
            kept.current.vector[axis] = four.x[axis];
            kept.velocity[axis] = four.v[axis];
        }
        kept.current.length = dot(a, &four.x, &four.x);
        kept.volume_j = four.volume;
        kept.kept = a.plus(four.pressure, own.pressure);
    }

    /// Takes roots, and adds up the forces.
    #[inline(always)]
    fn weigh<A: Arithmetic, const VISCOUS: bool>(
        &self,
        a: A,
        pairs: &mut [FourPairs],
        forces: &mut Forces<D>,
    ) {
        let least = Lanes4::splat(self.kernel.least_square());
        for k in 0..pairs.len() {
            let four = &mut pairs[k];
            let distance = a.sqrt(a.larger(four.current.length, least));
            let weight = self.kernel.weights(a, distance);
            four.current.length = distance;
            four.weight = weight;
            forces.add_fluid::<A, VISCOUS>(a, four, self.viscosity);
        }
    }
}
