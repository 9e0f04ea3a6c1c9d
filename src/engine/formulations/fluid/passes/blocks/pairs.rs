//! Sums over the neighbours of a block: the forces of the second pass.
//!
//! Some neighbours are taken at a time: one loop makes their geometry, which stays in the first-level cache, one adds the forces of the flow, and one each the terms of plugins. So
//! the sums of every loop stay in registers. Products of volumes, and sums of pressures, are the same from both sides of a pair, and differences exact opposites: so is the force.

use glam::DVec3;

use crate::formulations::fluid::cloud::{FlowCloud, NONE, PLAIN, WITH_SPIN};
use crate::formulations::fluid::lanes::PairShape;
use crate::formulations::fluid::lists::blocks::{Other, OwnBlock, Packed, Rows, SEEN, Units, dot};
use crate::pair::{BlockPairs, EightPairs};
use crate::parallel::{EIGHT, EightLanes, Lanes8};

/// The pairs of a block.
pub struct PairsOfBlock<'a, K> {
    packed: &'a [Packed],
    kernel: K,
    unit: [Lanes8; 3],
    own: OwnBlock,
    cloud: &'a FlowCloud,
    /// Spins of the particles, 1/s; zero where friction goes without.
    spin: [Lanes8; 3],
    /// Viscosity between the two bodies with the factor of friction, Pa s.
    pub viscosity: f64,
}

/// What neighbours do to the particles of a block, N.
#[derive(Clone, Copy)]
pub struct BlockForces {
    /// Of the pressures of fluids.
    pub pressure: [Lanes8; 3],
    /// Of friction.
    pub viscous: [Lanes8; 3],
    /// Of the pressures of boundaries.
    pub wall: [Lanes8; 3],
}

impl BlockForces {
    pub const ZERO: Self =
        Self { pressure: [Lanes8::ZERO; 3], viscous: [Lanes8::ZERO; 3], wall: [Lanes8::ZERO; 3] };
}

/// Takes the pairs that particles of the block do not see, whose bits are zero, out of what is summed.
#[inline(always)]
pub fn hide<A: EightLanes>(a: A, seen: &[u8], pairs: &mut BlockPairs) {
    for (pair, &seen) in pairs.pairs_mut().iter_mut().zip(seen) {
        let seen = SEEN[usize::from(seen)];
        (pair.weight, pair.volume) = (a.times(pair.weight, seen), a.times(pair.volume, seen));
    }
}

impl<'a, K: PairShape> PairsOfBlock<'a, K> {
    #[inline(always)]
    pub fn new<A: EightLanes>(
        a: A,
        (packed, kernel, units): (&'a [Packed], K, &'a Units),
        own: OwnBlock,
        cloud: &'a FlowCloud,
        rows: &Rows,
    ) -> Self {
        let unit = [a.splat(units.length.x), a.splat(units.length.y), a.splat(units.length.z)];
        let mut spin = [Lanes8::ZERO; 3];
        if cloud.viscosities.spin {
            for lane in 0..EIGHT {
                let of_lane = cloud.spins[rows[lane] as usize].xyz();
                for axis in 0..3 {
                    spin[axis].0[lane] = of_lane[axis] as f32;
                }
            }
        }
        Self { packed, kernel, unit, own, cloud, spin, viscosity: 0.0 }
    }

    #[inline(always)]
    fn friction(&self) -> u8 {
        self.cloud.viscosities.friction(self.viscosity)
    }

    /// Puts the geometry of the pairs with some neighbours into `kept`.
    #[inline(always)]
    pub fn fill<A: EightLanes>(&self, a: A, row: &[u32], with_kernel: bool, kept: &mut BlockPairs) {
        let Self { packed, unit, own, cloud: FlowCloud { kernel, .. }, .. } = self;
        let (scale, limit) = (a.splat(kernel.weight_scale()), a.splat(kernel.support * kernel.support));
        let least = a.splat(kernel.least_square());
        let kept = kept.room(row.len());
        for (&j, kept) in row.iter().zip(&mut *kept) {
            let other = &packed[j as usize];
            let Other { x, v } = own.to(a, other, unit);
            let square = dot(a, &x, &x);
            let distance = a.sqrt(a.larger(square, least));
            kept.row = j;
            for axis in 0..A::AXES {
                (kept.x[axis], kept.v[axis]) = (x[axis], v[axis]);
            }
            kept.length = distance;
            kept.weight = a.times(self.kernel.shape(a, distance), scale);
            // Neither what is beyond the support nor the particle itself.
            let near = a.where_below(square, limit, a.same(other.volume));
            kept.volume = a.where_below(Lanes8::ZERO, square, near);
        }
        if with_kernel {
            for pair in kept {
                pair.kernel = kernel.values(a, pair.length);
            }
        }
    }

    /// Adds the friction with a neighbour: `mu w (v_ij - omega_ij x x_ij)`, where `share` is that of the spin of the particle in that of the pair, the rest that of the neighbour.
    #[inline(always)]
    fn rub<A: EightLanes, const FRICTION: u8>(
        &self,
        a: A,
        (j, share): (u32, f64),
        EightPairs { x, v, .. }: &EightPairs,
        weight: Lanes8,
        viscous: &mut [Lanes8; 3],
    ) {
        if FRICTION == NONE {
            return;
        }
        let friction = a.scale(self.viscosity, weight);
        let mut relative = *v;
        if FRICTION == WITH_SPIN {
            let others =
                if share < 1.0 { self.cloud.spins[j as usize].xyz() * (1.0 - share) } else { DVec3::ZERO };
            let mut omega = self.spin;
            for axis in 0..3 {
                omega[axis] = a.scale_add(share, self.spin[axis], a.splat(others[axis]));
            }
            if A::AXES == 3 {
                for axis in 0..3 {
                    let (n, o) = ((axis + 1) % 3, (axis + 2) % 3);
                    let turning = a.minus(a.times(omega[n], x[o]), a.times(omega[o], x[n]));
                    relative[axis] = a.minus(v[axis], turning);
                }
            } else {
                relative[0] = a.times_add(omega[2], x[1], v[0]);
                relative[1] = a.minus(v[1], a.times(omega[2], x[0]));
            }
        }
        for axis in 0..A::AXES {
            viscous[axis] = a.times_add(friction, relative[axis], viscous[axis]);
        }
    }

    /// Adds neighbours of a fluid: `V_i V_j (p_i + p_j) w x_ij`, and the friction.
    #[inline(always)]
    pub fn add_fluid<A: EightLanes>(&self, a: A, pairs: &BlockPairs, sums: &mut BlockForces) {
        match self.friction() {
            NONE => self.fluid::<A, NONE>(a, pairs, sums),
            PLAIN => self.fluid::<A, PLAIN>(a, pairs, sums),
            _ => self.fluid::<A, WITH_SPIN>(a, pairs, sums),
        }
    }

    #[inline(always)]
    fn fluid<A: EightLanes, const FRICTION: u8>(&self, a: A, pairs: &BlockPairs, sums: &mut BlockForces) {
        let BlockForces { mut pressure, mut viscous, .. } = *sums;
        for pair in pairs.pairs() {
            let other = &self.packed[pair.row as usize];
            let weight = a.times(pair.weight, a.times(self.own.volume, a.same(other.volume)));
            let push = a.times(weight, a.plus(self.own.pressure, a.same(other.pressure)));
            for axis in 0..A::AXES {
                pressure[axis] = a.times_add(push, pair.x[axis], pressure[axis]);
            }
            self.rub::<A, FRICTION>(a, (pair.row, 0.5), pair, weight, &mut viscous);
        }
        (sums.pressure, sums.viscous) = (pressure, viscous);
    }

    /// Adds neighbours that bound the fluid, or, if the particles are those that bound it (`BOUND`), the fluid: the pressures of what bounds it are kept apart.
    #[inline(always)]
    pub fn add_walls<A: EightLanes, const BOUND: bool>(
        &self,
        a: A,
        pairs: &BlockPairs,
        sums: &mut BlockForces,
    ) {
        match self.friction() {
            NONE => self.walls::<A, BOUND, NONE>(a, pairs, sums),
            PLAIN => self.walls::<A, BOUND, PLAIN>(a, pairs, sums),
            _ => self.walls::<A, BOUND, WITH_SPIN>(a, pairs, sums),
        }
    }

    #[inline(always)]
    fn walls<A: EightLanes, const BOUND: bool, const FRICTION: u8>(
        &self,
        a: A,
        pairs: &BlockPairs,
        sums: &mut BlockForces,
    ) {
        let BlockForces { mut pressure, mut viscous, mut wall } = *sums;
        for pair in pairs.pairs() {
            let other = &self.packed[pair.row as usize];
            let weight = a.times(pair.weight, a.times(self.own.volume, a.same(other.volume)));
            let (of_i, of_j) = (a.times(weight, self.own.pressure), a.times(weight, a.same(other.pressure)));
            let (of_fluid, of_wall) = if BOUND { (of_j, of_i) } else { (of_i, of_j) };
            for axis in 0..A::AXES {
                pressure[axis] = a.times_add(of_fluid, pair.x[axis], pressure[axis]);
                wall[axis] = a.times_add(of_wall, pair.x[axis], wall[axis]);
            }
            // The spin of the pair is that of the fluid.
            let share = if BOUND { 0.0 } else { 1.0 };
            self.rub::<A, FRICTION>(a, (pair.row, share), pair, weight, &mut viscous);
        }
        *sums = BlockForces { pressure, viscous, wall };
    }
}
