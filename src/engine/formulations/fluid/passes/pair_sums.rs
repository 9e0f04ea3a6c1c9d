//! Sums over the pairs of one particle with the particles of one body: the forces of the second pass.

use crate::formulations::fluid::cloud::{FlowCloud, NONE, PLAIN, WITH_SPIN};
use crate::formulations::fluid::lanes::{FluidKernel, Four, MASKS, OwnRecord, as_rows, dot, filled_up};
use crate::pair::{FourPairs, RowSlots};
use crate::parallel::{FourLanes, Lanes4};

/// The pairs of a particle with the neighbours in `row`.
pub struct PairsOfRow<'a, const D: usize> {
    pub cloud: &'a FlowCloud,
    pub kernel: FluidKernel,
    pub own: OwnRecord<D>,
    /// The particle, as a row of the cloud.
    pub i: usize,
    pub row: &'a [u32],
    /// Viscosity between the two with the factor of friction, Pa s.
    pub viscosity: f64,
}

/// Forces of the neighbours on a particle, per volume of it and in the lanes of the fours.
pub struct Forces<const D: usize> {
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

    /// Adds four neighbours: V_j (p_i + p_j) w x_ij and V_j 4 mu w (v_ij - omega_ij x x_ij) between fluids.
    #[inline(always)]
    fn add_fluid<A: FourLanes, const FRICTION: u8>(
        &mut self,
        a: A,
        FourPairs { current, velocity, weight, volume_j, kept: pressure, .. }: &FourPairs,
        viscosity: f64,
        turning: &[Lanes4; D],
    ) {
        let weight = a.mul(*weight, *volume_j);
        let pressure = a.mul(weight, *pressure);
        for axis in 0..D {
            self.pressure[axis] = a.mul_add(pressure, current.vector[axis], self.pressure[axis]);
        }
        if FRICTION != NONE {
            let friction = a.scale(viscosity, weight);
            for axis in 0..D {
                let relative =
                    if FRICTION == WITH_SPIN { a.sub(velocity[axis], turning[axis]) } else { velocity[axis] };
                self.viscous[axis] = a.mul_add(friction, relative, self.viscous[axis]);
            }
        }
    }
}

/// Whose pressures act between a particle and its neighbours.
#[derive(Clone, Copy, PartialEq, Eq)]
pub enum Between {
    /// Both are fluids.
    Fluids,
    /// The neighbours bound the fluid.
    FluidAndBoundary,
    /// The particle bounds the fluid.
    BoundaryAndFluid,
}

impl Between {
    /// Between a particle and a neighbour of which it is said whether they flow.
    pub fn of(flows: bool, neighbor_flows: bool) -> Self {
        match (flows, neighbor_flows) {
            (true, true) => Self::Fluids,
            (true, false) => Self::FluidAndBoundary,
            _ => Self::BoundaryAndFluid,
        }
    }

    /// Shares of the spins of the particle and of its neighbour in that of the pair.
    pub fn shares(self) -> [f64; 2] {
        match self {
            Self::Fluids => [0.5, 0.5],
            Self::FluidAndBoundary => [1.0, 0.0],
            Self::BoundaryAndFluid => [0.0, 1.0],
        }
    }
}

/// The spin of the pairs of a particle: what of it is the particle's, and the share of the neighbour in it.
#[derive(Clone, Copy)]
struct PairSpin {
    own: [f64; 3],
    share: f64,
}

impl<const D: usize> PairsOfRow<'_, D> {
    fn pair_spin(&self, between: Between) -> PairSpin {
        let [own, share] = between.shares();
        let spin = self.cloud.spins.get(self.i).map_or(glam::DVec3::ZERO, |spin| spin.xyz());
        PairSpin { own: (own * spin).to_array(), share }
    }

    /// omega_ij x x_ij of four pairs.
    #[inline(always)]
    fn turning<A: FourLanes>(
        &self,
        a: A,
        PairSpin { own, share }: PairSpin,
        [j, k, l, m]: [usize; 4],
        x: &[Lanes4; D],
    ) -> [Lanes4; D] {
        let spins = &self.cloud.spins[..];
        let mut turning = [Lanes4::ZERO; D];
        if D == 3 {
            let [s, t, u, _] = a.transpose([spins[j], spins[k], spins[l], spins[m]]);
            let mut omega = [s, t, u];
            for axis in 0..D {
                omega[axis] = a.scale_add(share, omega[axis], Lanes4::splat(own[axis]));
            }
            for axis in 0..D {
                let (n, o) = ((axis + 1) % 3, (axis + 2) % 3);
                turning[axis] = a.sub(a.mul(omega[n], x[o]), a.mul(omega[o], x[n]));
            }
        } else {
            let others = Lanes4([spins[j].0[2], spins[k].0[2], spins[l].0[2], spins[m].0[2]]);
            let omega = a.scale_add(share, others, Lanes4::splat(own[2]));
            turning[0] = a.scale(-1.0, a.mul(omega, x[1]));
            turning[1] = a.mul(omega, x[0]);
        }
        turning
    }

    /// The friction with these neighbours.
    fn friction(&self) -> u8 {
        self.cloud.viscosities.friction(self.viscosity)
    }

    /// Adds all neighbours.
    #[inline(always)]
    pub fn add<A: FourLanes, const P: bool>(&self, a: A, between: Between, forces: &mut Forces<D>) {
        match self.friction() {
            NONE => self.add_all::<A, P, NONE>(a, between, forces),
            PLAIN => self.add_all::<A, P, PLAIN>(a, between, forces),
            _ => self.add_all::<A, P, WITH_SPIN>(a, between, forces),
        }
    }

    #[inline(always)]
    fn add_all<A: FourLanes, const P: bool, const FRICTION: u8>(
        &self,
        a: A,
        between: Between,
        Forces { pressure, viscous, wall }: &mut Forces<D>,
    ) {
        // sum V_j w x_ij, and the same with p_j.
        let (mut gradient, mut of_j) = ([Lanes4::ZERO; D], [Lanes4::ZERO; D]);
        let spin = self.pair_spin(between);
        let (fours, rest) = self.row.as_chunks();
        for k in 0..fours.len() + usize::from(!rest.is_empty()) {
            let (rows, count) = if k < fours.len() { (fours[k], 4) } else { (filled_up(rest), rest.len()) };
            let Self { cloud: FlowCloud { records, periods, .. }, kernel, own, .. } = self;
            let four = Four::<D>::gather::<A, P>(a, records, own, as_rows(rows), periods);
            let distance = a.sqrt(dot(a, &four.x, &four.x));
            let weight = a.mul(kernel.weights(a, distance), a.mul(four.volume, MASKS[count]));
            let weight_j = a.mul(weight, four.pressure);
            let friction = a.scale(self.viscosity, weight);
            let mut relative = four.v;
            if FRICTION == WITH_SPIN {
                let turning = self.turning(a, spin, as_rows(rows), &four.x);
                for axis in 0..D {
                    relative[axis] = a.sub(four.v[axis], turning[axis]);
                }
            }
            for axis in 0..D {
                gradient[axis] = a.mul_add(weight, four.x[axis], gradient[axis]);
                of_j[axis] = a.mul_add(weight_j, four.x[axis], of_j[axis]);
                if FRICTION != NONE {
                    viscous[axis] = a.mul_add(friction, relative[axis], viscous[axis]);
                }
            }
        }
        for axis in 0..D {
            let of_i = a.mul(gradient[axis], self.own.pressure);
            let (of_fluid, of_wall) = match between {
                Between::Fluids => (a.add(of_i, of_j[axis]), Lanes4::ZERO),
                Between::FluidAndBoundary => (of_i, of_j[axis]),
                Between::BoundaryAndFluid => (of_j[axis], of_i),
            };
            pressure[axis] = a.add(pressure[axis], of_fluid);
            wall[axis] = a.add(wall[axis], of_wall);
        }
    }

    /// The same between fluids, and puts the geometry of the pairs into `slots`.
    ///
    /// Two loops: in one, a neighbour takes some ninety cycles from its index to its sum, and a processor
    /// looks ahead two or three fours. Taken apart, one gathers and one takes roots, each with short chains
    /// of instructions that wait for each other.
    #[inline(always)]
    pub fn add_and_keep<A: FourLanes, const P: bool>(
        &self,
        a: A,
        RowSlots { pairs, rows, .. }: RowSlots<'_>,
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
            pairs[full].volume_j = a.mul(pairs[full].volume_j, MASKS[rest.len()]);
        }
        match self.friction() {
            NONE => self.weigh::<A, NONE>(a, pairs, rows, forces),
            PLAIN => self.weigh::<A, PLAIN>(a, pairs, rows, forces),
            _ => self.weigh::<A, WITH_SPIN>(a, pairs, rows, forces),
        }
        if with_kernel {
            for k in 0..pairs.len() {
                pairs[k].kernel = self.kernel.values(a, pairs[k].current.length);
            }
        }
        if !rest.is_empty() {
            let (last, mask) = (&mut pairs[full], MASKS[rest.len()]);
            last.weight = a.mul(last.weight, mask);
            last.kernel = a.mul(last.kernel, mask);
        }
    }

    /// Puts four neighbours into `kept`, all but lengths and weights: in place of the lengths their squares.
    #[inline(always)]
    fn gather<A: FourLanes, const P: bool>(&self, a: A, rows: [u32; 4], kept: &mut FourPairs) {
        let Self { cloud: FlowCloud { records, periods, .. }, own, .. } = self;
        let four = Four::<D>::gather::<A, P>(a, records, own, as_rows(rows), periods);
        for axis in 0..D {
            kept.current.vector[axis] = four.x[axis];
            kept.velocity[axis] = four.v[axis];
        }
        kept.current.length = dot(a, &four.x, &four.x);
        kept.volume_j = four.volume;
        kept.kept = a.add(four.pressure, own.pressure);
    }

    /// Takes roots, and adds up the forces.
    #[inline(always)]
    fn weigh<A: FourLanes, const FRICTION: u8>(
        &self,
        a: A,
        pairs: &mut [FourPairs],
        rows: &[[u32; 4]],
        forces: &mut Forces<D>,
    ) {
        let least = Lanes4::splat(self.kernel.min_square());
        let spin = self.pair_spin(Between::Fluids);
        for k in 0..pairs.len() {
            let four = &mut pairs[k];
            let distance = a.sqrt(a.max(four.current.length, least));
            let weight = self.kernel.weights(a, distance);
            four.current.length = distance;
            four.weight = weight;
            let mut turning = [Lanes4::ZERO; D];
            if FRICTION == WITH_SPIN {
                let mut x = [Lanes4::ZERO; D];
                x.copy_from_slice(&four.current.vector[..D]);
                turning = self.turning(a, spin, as_rows(rows[k]), &x);
            }
            forces.add_fluid::<A, FRICTION>(a, four, self.viscosity, &turning);
        }
    }
}
