//! Passes over rows in blocks: a lane is a particle, and eight of them read each neighbour once.

use glam::DVec3;

use super::flow_cloud::FlowCloud;
use super::near::part_of;
use super::row_pass::{NearPairs, RowPass};
use crate::formulations::fluid::lists::blocks::{Blocks, OwnBlock, Rows, SEEN, dot};
use crate::parallel::{BlockLoop, EIGHT, EightLanes, Lanes8, Number, Vector};

/// Some particles of a fluid, from row `first` of the cloud on.
pub(super) struct RowPassBlocks<'a, const R: usize, const S: usize, P: RowPass<R, S>> {
    pub cloud: &'a FlowCloud,
    pub blocks: &'a Blocks,
    pub pass: &'a P,
    pub first: usize,
    pub sums: &'a mut [[DVec3; S]],
}

impl<const R: usize, const S: usize, P: RowPass<R, S>> BlockLoop for RowPassBlocks<'_, R, S, P> {
    type Output = ();

    #[inline(always)]
    fn run<A: EightLanes>(self, a: A) {
        let Self { cloud, blocks: Blocks { lists, units, packed, near, hides }, pass, first, sums: out } =
            self;
        let unit = [a.splat(units.length.x), a.splat(units.length.y), a.splat(units.length.z)];
        let kernel = &cloud.kernel;
        let limit = a.splat(kernel.support * kernel.support);
        let least = a.splat(kernel.min_square());
        let among = pass.among();
        let first_group = cloud.group_at(among.start);
        for block in lists.table.of_rows(&(first..first + out.len())) {
            let rows = &lists.table.rows[block];
            let mut sums = [Vector::zero(a); S];
            if rows.iter().any(|&row| !pass.skips(row as usize)) {
                let own = OwnBlock::new(packed, rows);
                let of_i = lanes_of(a, pass, rows);
                let row = near.row(block);
                let seen = if *hides { near.lanes(block) } else { &[] };
                let (mut group, mut of_j) = (first_group, [Vector::zero(a); R]);
                for n in part_of(row, &among) {
                    let j = row[n];
                    while cloud.groups[group].cloud.end <= j as usize {
                        group += 1;
                    }
                    let other = &packed[j as usize];
                    let x = own.to(a, other, &unit).x;
                    let square = dot(a, &x, &x);
                    let distance = a.sqrt(a.max(square, least));
                    // Neither what is beyond the support nor the particle itself.
                    let near_volume = a.where_below(square, limit, a.same(other.volume));
                    let mut volume = a.where_below(Lanes8::ZERO, square, near_volume);
                    if *hides {
                        volume = a.mul(volume, SEEN[usize::from(seen[n])]);
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
            put(pass, rows, &sums, first, out);
        }
    }
}

/// Writes the sums of a block to those of its rows that are wanted: blocks at the ends may have others as
/// well.
#[inline(always)]
fn put<A: EightLanes, const R: usize, const S: usize, P: RowPass<R, S>>(
    pass: &P,
    rows: &Rows,
    sums: &[Vector<A>; S],
    first: usize,
    out: &mut [[DVec3; S]],
) {
    for lane in 0..EIGHT {
        let row = rows[lane] as usize;
        let Some(out) = out.get_mut(row.wrapping_sub(first)) else { continue };
        let is_wanted = !pass.skips(row);
        for n in 0..S {
            out[n] = if is_wanted { lane_of(sums[n], lane) } else { DVec3::ZERO };
        }
    }
}

/// The vector of one lane, in double precision.
#[inline(always)]
fn lane_of<A: EightLanes>(Vector { x, y, z }: Vector<A>, lane: usize) -> DVec3 {
    // By number: a mapped array would be called.
    DVec3::new(f64::from(x.lanes().0[lane]), f64::from(y.lanes().0[lane]), f64::from(z.lanes().0[lane]))
}

/// Data of the particles of a block for a pass, a particle in each lane.
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
