//! The pass over the particles of boundaries in blocks of eight: what
//! [`WallPressure`](super::wall_pressure::WallPressure) finds four neighbours at a time.

use std::ops::Range;

use glam::DVec3;

use super::wall_pressure::{FluidBeside, share_wetted};
use crate::formulations::fluid::cloud::{FlowCloud, FluidState, MIN_SHARE, take_until};
use crate::formulations::fluid::lists::blocks::{BlockLists, Blocks, OfBlocks, OwnBlock, Packed, dot};
use crate::formulations::fluid::lists::{NearRow, NearWriter};
use crate::parallel::{
    BlockLoop, EIGHT, EightLanes, Lanes8, Split, for_each_block, for_each_own_block, run_blocks_on,
};

/// The pass over all particles that are no fluid.
pub struct WallBlocks<'a> {
    pub cloud: &'a FlowCloud,
}

impl WallBlocks<'_> {
    /// Writes the sums beside every particle of a boundary, and the neighbours within the support of every
    /// block.
    pub fn run(&self, blocks: &mut Blocks, out: &mut [FluidBeside]) {
        let cloud = self.cloud;
        // The pass over gaps needs the neighbours of every particle beside one.
        let looks_at_all = !cloud.pairs.gaps.particles.is_empty();
        let Blocks { lists, units, packed, near, .. } = blocks;
        let first_block = lists.walls.rows();
        let bodies = || cloud.groups.iter().filter(|group| group.fluid().is_none());
        let (_, mut near_rows) = near.writer().split(first_block);
        let mut rest = &mut *out;
        for group in bodies() {
            let (rows, behind) = rest.split(group.cloud.len());
            let (of_body, near_behind) = near_rows.split(lists.table.of_rows(&group.cloud).len());
            (rest, near_rows) = (behind, near_behind);
            let (start, sticks, unit) = (group.cloud.start, group.sticks(), units.length.to_array());
            let pass = Beside { cloud, lists, packed, unit, first_block, sticks };
            let body = |first, rows| {
                run_blocks_on(cloud.plane, BesideBlocks { pass: &pass, first: start + first, rows })
            };
            let rows = (rows, lists.table.beside(&group.cloud, of_body));
            match looks_at_all {
                true => for_each_block(rows, &mut Vec::new(), &body),
                false => for_each_own_block(rows, &mut Vec::new(), &body),
            }
        }
        if !looks_at_all && !cloud.is_local() {
            share_wetted(cloud, out);
        }
    }
}

/// Input of the pass over a body.
struct Beside<'a> {
    cloud: &'a FlowCloud,
    lists: &'a BlockLists,
    packed: &'a [Packed],
    /// Units of place, m.
    unit: [f64; 3],
    /// The first block of boundaries.
    first_block: usize,
    /// Whether the fluid sticks to the body.
    sticks: bool,
}

struct BesideBlocks<'a> {
    pass: &'a Beside<'a>,
    /// First row in the cloud.
    first: usize,
    rows: (&'a mut [FluidBeside], OfBlocks<'a, NearWriter<'a>>),
}

impl BlockLoop for BesideBlocks<'_> {
    type Output = ();

    #[inline(always)]
    fn run<A: EightLanes>(self, a: A) {
        if self.pass.sticks { self.blocks::<A, true>(a) } else { self.blocks::<A, false>(a) }
    }
}

impl BesideBlocks<'_> {
    /// `STICKS`: with the velocity of the fluid.
    #[inline(always)]
    fn blocks<A: EightLanes, const STICKS: bool>(self, a: A) {
        let Self { pass, first, rows: (out, near) } = self;
        let Beside { cloud, lists, packed, unit, first_block, .. } = *pass;
        let unit = [a.splat(unit[0]), a.splat(unit[1]), a.splat(unit[2])];
        let mut writer = near.blocks;
        let blocks: Range<usize> = lists.table.of_rows(&(first..first + out.len()));
        for (k, block) in blocks.enumerate() {
            let rows = &lists.table.rows[block];
            let list = lists.boundary.row(block - first_block);
            let beside = OwnFluid { cloud, packed, own: OwnBlock::new(packed, rows), unit };
            let mut rest = beside.take_near(a, list, writer.row(k));
            let mut sums = BlockSums::ZERO;
            // By number: zipped iterators would be called.
            for n in 0..cloud.groups.len() {
                let Some(state) = cloud.groups[n].fluid().filter(|_| !rest.is_empty()) else { break };
                for &j in take_until(&mut rest, cloud.groups[n].cloud.end) {
                    beside.add::<A, STICKS>(a, state, j as usize, &mut sums);
                }
            }
            for lane in 0..EIGHT {
                out[rows[lane] as usize - first] = sums.mean(lane);
            }
        }
    }
}

/// The particles of a block, and the fluid beside them.
struct OwnFluid<'a> {
    cloud: &'a FlowCloud,
    packed: &'a [Packed],
    own: OwnBlock,
    unit: [Lanes8; 3],
}

/// Sums over the fluid beside the particles of a block.
struct BlockSums {
    total: Lanes8,
    pressure: Lanes8,
    moment: [Lanes8; 3],
    velocity: [Lanes8; 3],
    offset: [Lanes8; 3],
}

impl OwnFluid<'_> {
    /// Writes down those of a list that are within the support of any particle.
    #[inline(always)]
    fn take_near<'n, A: EightLanes>(&self, a: A, list: &[u32], mut near: NearRow<'n>) -> &'n [u32] {
        let kernel = &self.cloud.kernel;
        let limit = a.splat(kernel.support * kernel.support);
        for &j in list {
            let x = self.own.to(a, &self.packed[j as usize], &self.unit).x;
            near.push_if::<false>(j, a.below(dot(a, &x, &x), limit));
        }
        near.close()
    }

    /// Adds a particle of a fluid.
    #[inline(always)]
    fn add<A: EightLanes, const STICKS: bool>(
        &self,
        a: A,
        state: &FluidState,
        j: usize,
        sums: &mut BlockSums,
    ) {
        let other = &self.packed[j];
        let pair = self.own.to(a, other, &self.unit);
        let distance = a.sqrt(dot(a, &pair.x, &pair.x));
        let value = a.mul(self.cloud.kernel.values(a, distance), a.same(other.volume));
        // rho = rho_0 + p / c_0^2 to first order in the compression.
        let (p, factor) = (f64::from(other.pressure), self.cloud.pressure_factor);
        let density = (state.density + p / (factor * state.sound_speed * state.sound_speed)) as f32;
        let weighed = a.mul(value, a.same(density));
        sums.total = a.add(sums.total, value);
        sums.pressure = a.mul_add(value, a.same(other.pressure), sums.pressure);
        if let Some(load) = self.cloud.loads.get(j) {
            for axis in 0..A::AXES {
                let along = a.mul(pair.x[axis], a.same((-factor * load[axis]) as f32));
                sums.pressure = a.mul_add(weighed, along, sums.pressure);
            }
        }
        for axis in 0..A::AXES {
            sums.moment[axis] = a.mul_add(weighed, pair.x[axis], sums.moment[axis]);
            if STICKS {
                sums.offset[axis] = a.mul_add(value, pair.x[axis], sums.offset[axis]);
                sums.velocity[axis] = a.mul_add(value, pair.v[axis], sums.velocity[axis]);
            }
        }
    }
}

impl BlockSums {
    const ZERO: Self = Self {
        total: Lanes8::ZERO,
        pressure: Lanes8::ZERO,
        moment: [Lanes8::ZERO; 3],
        velocity: [Lanes8::ZERO; 3],
        offset: [Lanes8::ZERO; 3],
    };

    /// The means beside one particle, where there is fluid.
    #[inline(always)]
    fn mean(&self, lane: usize) -> FluidBeside {
        let total = f64::from(self.total.0[lane]);
        if total <= MIN_SHARE {
            return FluidBeside::default();
        }
        let vector = |[x, y, z]: &[Lanes8; 3]| {
            DVec3::new(f64::from(x.0[lane]), f64::from(y.0[lane]), f64::from(z.0[lane])) / total
        };
        FluidBeside {
            pressure: f64::from(self.pressure.0[lane]) / total,
            moment: vector(&self.moment),
            velocity: vector(&self.velocity),
            offset: vector(&self.offset),
        }
    }
}
