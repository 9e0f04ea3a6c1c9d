//! Runs passes over rows: in blocks of particles, or four neighbours of one particle at a time.

use std::ops::Range;

use glam::DVec3;

use super::flow_cloud::FlowCloud;
use super::near::{FourNear, part, take_until};
use super::row_blocks::RowPassBlocks;
use super::row_pass::RowPass;
use crate::parallel::{
    BLOCK, FourLanes, HotLoop, Vector, for_each_block, own_part, run_blocks_on, run_hot_on, share_part,
};
use crate::ranks::has_several;

/// Sums of a pass for each row where several ranks exchange them, in memory that is kept.
#[derive(Debug, Default)]
pub struct RowSums(Vec<DVec3>);

impl FlowCloud {
    /// Runs a pass over the particles of whole bodies, from row `first` of the cloud on, in parallel. `sums`
    /// is memory that is kept from step to step.
    pub fn for_each_row<const R: usize, const S: usize, P: RowPass<R, S>>(
        &self,
        first: usize,
        out: &mut [P::Output],
        sums: &mut RowSums,
        pass: &P,
    ) {
        let rows = first..first + out.len();
        if !has_several() {
            for part in self.groups.iter().filter_map(|group| common(&group.cloud, &rows)) {
                let of_part = &mut out[part.start - first..part.end - first];
                for_each_block(of_part, &mut Vec::new(), &|start, out: &mut [P::Output]| {
                    // What a block sums stays in the cache.
                    let mut sums = [[DVec3::ZERO; S]; BLOCK];
                    let (first, sums) = (part.start + start, &mut sums[..out.len()]);
                    self.sum_rows(first, sums, pass);
                    (first..)
                        .zip(out.iter_mut().zip(sums))
                        .for_each(|(k, (out, sums))| *out = pass.output(k, sums));
                });
            }
            return;
        }
        // Sums are exchanged, not what is made of them, which may be of any type.
        sums.0.resize(out.len() * S, DVec3::ZERO);
        let (sums, _) = sums.0.as_chunks_mut::<S>();
        for body in self.groups.iter().map(|group| &group.cloud) {
            let Some(part) = common(body, &rows) else { continue };
            let own = own_part(body, &part);
            let of_own = &mut sums[own.start - first..own.end - first];
            for_each_block(of_own, &mut Vec::new(), &|start, sums: &mut [[DVec3; S]]| {
                self.sum_rows(own.start + start, sums, pass);
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

    /// Sums over the neighbours of some rows of one body.
    fn sum_rows<const R: usize, const S: usize, P: RowPass<R, S>>(
        &self,
        first: usize,
        sums: &mut [[DVec3; S]],
        pass: &P,
    ) {
        match &self.blocks {
            Some(blocks) if first < self.fluid => {
                run_blocks_on(self.plane, RowPassBlocks { cloud: self, blocks, pass, first, sums });
            }
            _ => run_hot_on(self.plane, RowPassRows { cloud: self, pass, first, sums }),
        }
    }
}

/// The rows that two ranges have in common, if there are any.
fn common(a: &Range<usize>, b: &Range<usize>) -> Option<Range<usize>> {
    let common = a.start.max(b.start)..a.end.min(b.end);
    (!common.is_empty()).then_some(common)
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
