//! Passes over rows in blocks: a lane is a particle, and eight of them read each neighbour once.

use std::ops::Range;

use glam::DVec3;

use super::flow_cloud::FlowCloud;
use super::near::part_of;
use super::row_pass::{NearPairs, RowPass};
use crate::formulations::fluid::lists::blocks::{BlockSums, Blocks, OwnBlock, Rows, SEEN, dot};
use crate::parallel::{
    BlockLoop, EIGHT, EightLanes, Lanes8, Number, Vector, for_each_block, for_each_own_block, run_blocks_on,
    share_wide_rows,
};

/// What a pass sums for each block, or for each row.
#[derive(Debug, Default)]
pub struct RowSums {
    of_blocks: Vec<Lanes8>,
    pub(super) of_rows: Vec<DVec3>,
}

impl FlowCloud {
    /// See [`FlowCloud::for_each_row`].
    pub(super) fn run_in_blocks<const R: usize, const S: usize, P: RowPass<R, S>>(
        &self,
        blocks: &Blocks,
        first: usize,
        out: &mut [P::Output],
        RowSums { of_blocks: sums, .. }: &mut RowSums,
        pass: &P,
    ) {
        if out.is_empty() {
            return;
        }
        let table = &blocks.lists.table;
        let (from, to) = (self.group_at(first), self.group_at(first + out.len() - 1));
        let Range { start, end } = table.of_fluid(from).start..table.of_fluid(to).end;
        let stride = 3 * S;
        sums.resize((end - start) * stride, Lanes8::ZERO);
        for fluid in (from..=to).map(|number| table.of_fluid(number)) {
            let lanes = &mut sums[(fluid.start - start) * stride..(fluid.end - start) * stride];
            let of_blocks = BlockSums { lanes: &mut *lanes, stride };
            for_each_own_block(of_blocks, &mut Vec::new(), &|k, sums: BlockSums<'_>| {
                run_blocks_on(
                    self.plane,
                    RowPassBlocks { cloud: self, blocks, pass, first: fluid.start + k, sums },
                );
            });
            share_wide_rows(lanes, stride);
        }
        let sums = &sums[..];
        for_each_block(out, &mut Vec::new(), &|k, out: &mut [P::Output]| {
            for (i, out) in (first + k..).zip(out) {
                let (block, lane) = table.place(i);
                let lanes = &sums[(block - start) * stride..][..stride];
                let mut sums = [DVec3::ZERO; S];
                if !pass.skips(i) {
                    for n in 0..S {
                        let of = |axis: usize| f64::from(lanes[3 * n + axis].0[lane]);
                        sums[n] = DVec3::new(of(0), of(1), of(2));
                    }
                }
                *out = pass.output(i, &sums);
            }
        });
    }
}

struct RowPassBlocks<'a, const R: usize, const S: usize, P: RowPass<R, S>> {
    cloud: &'a FlowCloud,
    blocks: &'a Blocks,
    pass: &'a P,
    first: usize,
    sums: BlockSums<'a>,
}

impl<const R: usize, const S: usize, P: RowPass<R, S>> BlockLoop for RowPassBlocks<'_, R, S, P> {
    type Output = ();

    #[inline(always)]
    fn run<A: EightLanes>(self, a: A) {
        let Self { cloud, blocks: Blocks { lists, units, packed, near, hides, .. }, pass, first, sums } =
            self;
        let unit = [a.splat(units.length.x), a.splat(units.length.y), a.splat(units.length.z)];
        let kernel = &cloud.kernel;
        let limit = a.splat(kernel.support * kernel.support);
        let least = a.splat(kernel.least_square());
        let among = pass.among();
        let first_group = cloud.group_at(among.start);
        for (k, out) in sums.lanes.chunks_exact_mut(sums.stride).enumerate() {
            let rows = &lists.table.rows[first + k];
            let mut sums = [Vector::zero(a); S];
            let mut is_wanted = false;
            for lane in 0..EIGHT {
                is_wanted |= !pass.skips(rows[lane] as usize);
            }
            if is_wanted {
                let own = OwnBlock::new(packed, rows);
                let of_i = lanes_of(a, pass, rows);
                let row = near.row(first + k);
                let seen = if *hides { near.lanes(first + k) } else { &[] };
                let (mut group, mut of_j) = (first_group, [Vector::zero(a); R]);
                for n in part_of(row, &among) {
                    let j = row[n];
                    while cloud.groups[group].cloud.end <= j as usize {
                        group += 1;
                    }
                    let other = &packed[j as usize];
                    let x = own.to(a, other, &unit).x;
                    let square = dot(a, &x, &x);
                    let distance = a.sqrt(a.larger(square, least));
                    // Neither what is beyond the support nor the particle itself.
                    let near_volume = a.where_below(square, limit, a.same(other.volume));
                    let mut volume = a.where_below(Lanes8::ZERO, square, near_volume);
                    if *hides {
                        volume = a.times(volume, SEEN[usize::from(seen[n])]);
                    }
                    let pairs = NearPairs {
                        group,
                        is_fluid: (j as usize) < cloud.fluid,
                        x_ij: Vector::new(a, x),
                        distance: Number::new(a, distance),
                        weight: Number::new(a, kernel.weights(a, distance)),
                        kernel: Number::new(a, kernel.values(a, distance)),
                        volume: Number::new(a, volume),
                    };
                    // By number: mapped arrays would be called.
                    let read = pass.reads(j as usize);
                    for n in 0..R {
                        of_j[n] = Vector::splat(a, read[n]);
                    }
                    pass.add(&pairs, &of_i, &of_j, &mut sums);
                }
            }
            for n in 0..S {
                let Vector { x, y, z } = sums[n];
                out[3 * n..3 * n + 3].copy_from_slice(&[x.lanes(), y.lanes(), z.lanes()]);
            }
        }
    }
}

/// What a pass reads of the particles of a block, a particle in each lane.
#[inline(always)]
fn lanes_of<A: EightLanes, const R: usize, const S: usize, P: RowPass<R, S>>(
    a: A,
    pass: &P,
    rows: &Rows,
) -> [Vector<A>; R] {
    let mut lanes = [[Lanes8::ZERO; 3]; R];
    for lane in 0..EIGHT {
        let read = pass.reads(rows[lane] as usize);
        for n in 0..R {
            for axis in 0..A::AXES {
                lanes[n][axis].0[lane] = read[n][axis] as f32;
            }
        }
    }
    let mut vectors = [Vector::zero(a); R];
    for n in 0..R {
        vectors[n] = Vector::new(a, lanes[n]);
    }
    vectors
}
