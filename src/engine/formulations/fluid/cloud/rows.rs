//! Runs passes over rows: in blocks of particles, or four neighbours of one particle at a time.

use glam::DVec3;

use super::flow_cloud::FlowCloud;
use super::near::{FourNear, part, take_until};
use super::row_blocks::RowPassBlocks;
use super::row_pass::RowPass;
use crate::parallel::{
    FourLanes, HotLoop, Vector, for_each_block, own_part, run_blocks_on, run_hot_on, share_part,
};

/// What a pass sums for each row, in memory that is kept.
#[derive(Debug, Default)]
pub struct RowSums(Vec<DVec3>);

impl FlowCloud {
    /// Runs a pass over the particles of whole bodies, from row `first` of the cloud on, in parallel. `sums` is memory that is kept from step to step.
    pub fn for_each_row<const R: usize, const S: usize, P: RowPass<R, S>>(
        &self,
        first: usize,
        out: &mut [P::Output],
        sums: &mut RowSums,
        pass: &P,
    ) {
        sums.0.resize(out.len() * S, DVec3::ZERO);
        let (sums, _) = sums.0.as_chunks_mut::<S>();
        let rows = first..first + out.len();
        for body in self.groups.iter().map(|group| &group.cloud) {
            let part = body.start.max(rows.start)..body.end.min(rows.end);
            let own = own_part(body, &part);
            if part.is_empty() {
                continue;
            }
            let of_own = &mut sums[own.start - first..own.end - first];
            for_each_block(of_own, &mut Vec::new(), &|start, sums: &mut [[DVec3; S]]| {
                let first = own.start + start;
                match &self.blocks {
                    Some(blocks) if first < self.fluid => {
                        run_blocks_on(self.plane, RowPassBlocks { cloud: self, blocks, pass, first, sums });
                    }
                    _ => run_hot_on(self.plane, RowPassRows { cloud: self, pass, first, sums }),
                }
            });
            let of_part = &mut sums[part.start - first..part.end - first];
            share_part(of_part.as_flattened_mut(), S, &part, body);
        }
        let sums = &*sums;
        for_each_block(out, &mut Vec::new(), &|start, out: &mut [P::Output]| {
            for (k, out) in (start..).zip(out) {
                *out = pass.output(first + k, &sums[k]);
            }
        });
    }
}

/// Some particles, whose neighbours are taken four at a time.
struct RowPassRows<'a, const R: usize, const S: usize, P> {
    cloud: &'a FlowCloud,
    pass: &'a P,
    first: usize,
    sums: &'a mut [[DVec3; S]],
}

impl<const R: usize, const S: usize, P: RowPass<R, S>> HotLoop for RowPassRows<'_, R, S, P> {
    type Output = ();

    #[inline(always)]
    fn run<A: FourLanes>(self, a: A) {
        let Self { cloud, pass, first, sums: all } = self;
        let among = pass.among();
        let first_group = cloud.group_at(among.start);
        for (k, totals) in all.iter_mut().enumerate() {
            let i = first + k;
            let mut sums = [Vector::zero(a); S];
            if !pass.skips(i) {
                // By number: mapped arrays would be called.
                let (read, mut own, mut other) = (pass.reads(i), [Vector::zero(a); R], [Vector::zero(a); R]);
                for n in 0..R {
                    own[n] = Vector::splat(a, read[n]);
                }
                let mut rest = part(cloud.near_row(i), &among);
                let mut group = first_group;
                while !rest.is_empty() {
                    for chunk in take_until(&mut rest, cloud.groups[group].cloud.end).chunks(4) {
                        let FourNear { rows, pairs } = cloud.four(a, i, group, chunk);
                        let [j, k, l, m] = rows;
                        let (j, k, l, m) = (pass.reads(j), pass.reads(k), pass.reads(l), pass.reads(m));
                        for n in 0..R {
                            other[n] = Vector::from_rows(a, [j[n], k[n], l[n], m[n]]);
                        }
                        pass.add(&pairs, &own, &other, &mut sums);
                    }
                    group += 1;
                }
            }
            for n in 0..S {
                totals[n] = sums[n].sum();
            }
        }
    }
}
