//! Sums over the neighbours of a block: the forces of the second pass.
//!
//! Some neighbours are taken at a time: one loop adds the forces of the flow and leaves the geometry of the
//! pairs in the first-level cache for those of the terms of plugins, one each. So the sums of every loop stay
//! in registers. Products of volumes and sums of pressures are the same from both sides of a pair, and
//! differences are exact opposites: so the forces are exact opposites.

use glam::DVec3;

use super::super::pair_sums::Between;
use crate::formulations::fluid::cloud::{FlowCloud, NONE, PLAIN, WITH_SPIN};
use crate::formulations::fluid::lanes::PairShape;
use crate::formulations::fluid::lists::blocks::{Blocks, Other, OwnBlock, Packed, Rows, SEEN, dot};
use crate::pair::EightPairs;
use crate::parallel::{EIGHT, EightLanes, Lanes8};

/// The pairs of a block.
pub struct PairsOfBlock<'a, K> {
    packed: &'a [Packed],
    kernel: K,
    unit: [Lanes8; 3],
    /// The particles of the block.
    pub own: OwnBlock,
    cloud: &'a FlowCloud,
    /// Spins of the particles, 1/s; zero where friction goes without.
    spin: [Lanes8; 3],
    /// Viscosity between the two bodies with the factor of friction, Pa s.
    pub viscosity: f64,
}

/// Forces of neighbours on the particles of a block, N.
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

/// Some neighbours of a block, all of one body.
#[derive(Clone, Copy)]
pub struct Chunk<'c> {
    /// Their rows in the cloud.
    pub row: &'c [u32],
    /// The bits of the particles of the block that see each; none where all see it.
    pub seen: Option<&'c [u8]>,
    /// Whose pressures act.
    pub between: Between,
}

/// A neighbour of the particles of a block with which they have friction.
struct FrictionPair<'x> {
    /// Its row in the cloud.
    row: u32,
    /// Share of the spin of the particle in that of the pair; the rest is that of the neighbour.
    share: f64,
    x: &'x [Lanes8; 3],
    v: &'x [Lanes8; 3],
    weight: Lanes8,
}

/// Values of [`Between`].
const FLUIDS: u8 = 0;
const AND_BOUNDARY: u8 = 1;
const AND_FLUID: u8 = 2;

impl<'a, K: PairShape> PairsOfBlock<'a, K> {
    #[inline(always)]
    pub fn new<A: EightLanes>(
        a: A,
        blocks: &'a Blocks,
        kernel: K,
        cloud: &'a FlowCloud,
        rows: &Rows,
    ) -> Self {
        let Blocks { packed, units, .. } = blocks;
        let own = OwnBlock::new(packed, rows);
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

    /// Adds some neighbours to the forces, and puts the geometry of the pairs into `kept`, if there are slots
    /// to keep it.
    #[inline(always)]
    pub fn add<A: EightLanes>(
        &self,
        a: A,
        chunk: Chunk<'_>,
        kept: Option<&mut [EightPairs]>,
        sums: &mut BlockForces,
    ) {
        match (chunk.between, self.friction()) {
            (Between::Fluids, NONE) => self.sum::<A, FLUIDS, NONE>(a, chunk, kept, sums),
            (Between::Fluids, PLAIN) => self.sum::<A, FLUIDS, PLAIN>(a, chunk, kept, sums),
            (Between::Fluids, _) => self.sum::<A, FLUIDS, WITH_SPIN>(a, chunk, kept, sums),
            (Between::FluidAndBoundary, NONE) => self.sum::<A, AND_BOUNDARY, NONE>(a, chunk, kept, sums),
            (Between::FluidAndBoundary, PLAIN) => self.sum::<A, AND_BOUNDARY, PLAIN>(a, chunk, kept, sums),
            (Between::FluidAndBoundary, _) => self.sum::<A, AND_BOUNDARY, WITH_SPIN>(a, chunk, kept, sums),
            (Between::BoundaryAndFluid, NONE) => self.sum::<A, AND_FLUID, NONE>(a, chunk, kept, sums),
            (Between::BoundaryAndFluid, PLAIN) => self.sum::<A, AND_FLUID, PLAIN>(a, chunk, kept, sums),
            (Between::BoundaryAndFluid, _) => self.sum::<A, AND_FLUID, WITH_SPIN>(a, chunk, kept, sums),
        }
    }

    /// The pressure force is `V_i V_j (p_i + p_j) w x_ij`; the pressures of what bounds a fluid are kept
    /// apart.
    #[inline(always)]
    fn sum<A: EightLanes, const BETWEEN: u8, const FRICTION: u8>(
        &self,
        a: A,
        Chunk { row, seen, between }: Chunk<'_>,
        mut kept: Option<&mut [EightPairs]>,
        sums: &mut BlockForces,
    ) {
        let Self { packed, unit, own, cloud: FlowCloud { kernel, .. }, .. } = self;
        let (scale, limit) = (a.splat(kernel.weight_scale()), a.splat(kernel.support * kernel.support));
        let least = a.splat(kernel.min_square());
        let share = between.shares()[0];
        let BlockForces { mut pressure, mut viscous, mut wall } = *sums;
        for n in 0..row.len() {
            let other = &packed[row[n] as usize];
            let Other { x, v } = own.to(a, other, unit);
            let square = dot(a, &x, &x);
            let distance = a.sqrt(a.max(square, least));
            let mut weight = a.mul(self.kernel.shape(a, distance), scale);
            let mut volume = a.same(other.volume);
            if let Some(seen) = seen {
                let seen = SEEN[usize::from(seen[n])];
                (weight, volume) = (a.mul(weight, seen), a.mul(volume, seen));
            }
            if let Some(kept) = &mut kept {
                // Neither what is beyond the support nor the particle itself.
                let near = a.where_below(square, limit, volume);
                let volume = a.where_below(Lanes8::ZERO, square, near);
                let kept = &mut kept[n];
                (kept.row, kept.length, kept.weight, kept.volume) = (row[n], distance, weight, volume);
                for axis in 0..A::AXES {
                    (kept.x[axis], kept.v[axis]) = (x[axis], v[axis]);
                }
            }
            let weight = a.mul(weight, a.mul(own.volume, a.same(other.volume)));
            if BETWEEN == FLUIDS {
                let push = a.mul(weight, a.add(own.pressure, a.same(other.pressure)));
                for axis in 0..A::AXES {
                    pressure[axis] = a.mul_add(push, x[axis], pressure[axis]);
                }
            } else {
                let (of_i, of_j) = (a.mul(weight, own.pressure), a.mul(weight, a.same(other.pressure)));
                let (of_fluid, of_wall) = if BETWEEN == AND_BOUNDARY { (of_i, of_j) } else { (of_j, of_i) };
                for axis in 0..A::AXES {
                    pressure[axis] = a.mul_add(of_fluid, x[axis], pressure[axis]);
                    wall[axis] = a.mul_add(of_wall, x[axis], wall[axis]);
                }
            }
            let rubbing = FrictionPair { row: row[n], share, x: &x, v: &v, weight };
            self.rub::<A, FRICTION>(a, rubbing, &mut viscous);
        }
        *sums = BlockForces { pressure, viscous, wall };
    }

    /// Adds the kernel values of kept pairs.
    #[inline(always)]
    pub fn add_kernel<A: EightLanes>(&self, a: A, kept: &mut [EightPairs]) {
        for pair in kept {
            pair.kernel = self.cloud.kernel.values(a, pair.length);
        }
    }

    /// Adds the friction with a neighbour: `mu w (v_ij - omega_ij x x_ij)`.
    #[inline(always)]
    fn rub<A: EightLanes, const FRICTION: u8>(
        &self,
        a: A,
        pair: FrictionPair<'_>,
        viscous: &mut [Lanes8; 3],
    ) {
        if FRICTION == NONE {
            return;
        }
        let FrictionPair { row, share, x, v, weight } = pair;
        let friction = a.scale(self.viscosity, weight);
        let mut relative = *v;
        if FRICTION == WITH_SPIN {
            let others =
                if share < 1.0 { self.cloud.spins[row as usize].xyz() * (1.0 - share) } else { DVec3::ZERO };
            let mut omega = self.spin;
            for axis in 0..3 {
                omega[axis] = a.scale_add(share, self.spin[axis], a.splat(others[axis]));
            }
            if A::AXES == 3 {
                for axis in 0..3 {
                    let (n, o) = ((axis + 1) % 3, (axis + 2) % 3);
                    let turning = a.sub(a.mul(omega[n], x[o]), a.mul(omega[o], x[n]));
                    relative[axis] = a.sub(v[axis], turning);
                }
            } else {
                relative[0] = a.mul_add(omega[2], x[1], v[0]);
                relative[1] = a.sub(v[1], a.mul(omega[2], x[0]));
            }
        }
        for axis in 0..A::AXES {
            viscous[axis] = a.mul_add(friction, relative[axis], viscous[axis]);
        }
    }
}
