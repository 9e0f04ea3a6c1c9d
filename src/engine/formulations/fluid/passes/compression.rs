//! First pass over pairs: the neighbours within the support, and the rate of compression.
//!
//! `D_i = sum_j V_j w_ij v_ij.x_ij` at the middle of the step, so that `drho_i/dt = -rho_i D_i`. With x at
//! the end of the step and v at its middle, the pair vectors at the middle are `x_ij - dt/2 v_ij`. The
//! neighbours are those at the end of the step.

use crate::formulations::fluid::cloud::FlowCloud;
use crate::formulations::fluid::lanes::{
    BATCH, Batch, FluidKernel, Four, MASKS, OwnRecord, as_rows, dot, filled_up,
};
use crate::formulations::fluid::lists::{NearRow, NearWriter};
use crate::parallel::{
    FourLanes, Lanes4, PlaneOrSpace, Split, for_each_own_block, others_rows, run_hot_in, share_rows_of,
};
use crate::schedule::{Run, Step, StepError};

/// Runs the pass.
pub struct Compression;

impl Run for Compression {
    fn run(&mut self, step: &mut Step<'_>) -> Result<(), StepError> {
        let mut cloud = step.resources.get_mut::<FlowCloud>();
        match cloud.blocks.take() {
            Some(mut blocks) => {
                cloud.compress_blocks(&mut blocks, step.clock.dt);
                cloud.blocks = Some(blocks);
            }
            None => cloud.compress(step.clock.dt),
        }
        Ok(())
    }
}

impl FlowCloud {
    /// Finds the neighbours within the support of every fluid particle, and its D, 1/s, in a step of that
    /// length, s.
    fn compress(&mut self, dt: f64) {
        let (mut near, mut rates) = (std::mem::take(&mut self.near), std::mem::take(&mut self.compression));
        let mut is_close = std::mem::take(&mut self.is_close);
        rates.resize(self.fluid, 0.0);
        is_close.resize(self.fluid, 0);
        let mut rest = (&mut rates[..], &mut is_close[..], near.writer());
        for fluid in self.fluids() {
            let (rows, behind) = rest.split(fluid.len());
            rest = behind;
            for_each_own_block(rows, &mut Vec::new(), &|first, (out, is_close, near)| {
                let first = fluid.start + first;
                run_hot_in(
                    self.plane,
                    CompressionRows { cloud: self, back: -0.5 * dt, first, out, is_close, near },
                );
            });
        }
        share_rows_of(&mut rates, self.fluids());
        share_rows_of(&mut is_close, self.fluids());
        let lists = &self.pairs;
        near.fill_others(self.fluids().flat_map(|fluid| others_rows(&fluid)), |i| {
            [(lists.fluid.row(i), &[]), (lists.walls.row(i), &[])]
        });
        (self.near, self.compression, self.is_close) = (near, rates, is_close);
    }
}

struct CompressionRows<'a> {
    cloud: &'a FlowCloud,
    /// Time from the end of the step to its middle, s.
    back: f64,
    first: usize,
    out: &'a mut [f64],
    is_close: &'a mut [u8],
    near: NearWriter<'a>,
}

impl PlaneOrSpace for CompressionRows<'_> {
    #[inline(always)]
    fn run<A: FourLanes, const D: usize>(self, a: A) {
        if self.cloud.periods.any() { self.rows::<A, D, true>(a) } else { self.rows::<A, D, false>(a) }
    }
}

impl CompressionRows<'_> {
    #[inline(always)]
    fn rows<A: FourLanes, const D: usize, const P: bool>(mut self, a: A) {
        let FlowCloud { records, pairs: lists, kernel, .. } = self.cloud;
        let kernel = *kernel;
        let mut batch = Batch::EMPTY;
        let range = Lanes4::splat(self.cloud.repulsion_range * self.cloud.repulsion_range);
        for (k, out) in self.out.iter_mut().enumerate() {
            let i = self.first + k;
            let own = OwnRecord::<D>::new(&records[i]);
            let mut pairs = ListPairs { cloud: self.cloud, kernel, own, back: self.back, batch: &mut batch };
            let mut near = self.near.row(k);
            let mut least = Lanes4::splat(f64::INFINITY);
            let sum = pairs.add::<A, P>(a, lists.fluid.row(i), &mut near, Lanes4::ZERO, None);
            let sum = pairs.add::<A, P>(a, lists.walls.row(i), &mut near, sum, Some(&mut least));
            near.close();
            self.is_close[k] = (a.below(least, range) != 0).into();
            *out = a.scale(kernel.weight_scale(), sum).sum();
        }
    }
}

/// The neighbours of one list.
struct ListPairs<'a, const D: usize> {
    cloud: &'a FlowCloud,
    kernel: FluidKernel,
    own: OwnRecord<D>,
    back: f64,
    batch: &'a mut Batch,
}

impl<const D: usize> ListPairs<'_, D> {
    #[inline(always)]
    fn add<A: FourLanes, const P: bool>(
        &mut self,
        a: A,
        row: &[u32],
        near: &mut NearRow<'_>,
        mut sum: Lanes4,
        mut least: Option<&mut Lanes4>,
    ) -> Lanes4 {
        let (fours, rest) = row.as_chunks();
        let mut done = 0;
        while done < fours.len() {
            let end = (done + BATCH).min(fours.len());
            for k in done..end {
                let (square, factor) = self.four::<A, P>(a, fours[k], 4, near, least.as_deref_mut());
                self.batch.put(k, square, factor);
            }
            for k in done..end {
                let (square, factor) = self.batch.get(k);
                sum = a.mul_add(self.kernel.shapes(a, a.sqrt(square)), factor, sum);
            }
            done = end;
        }
        if !rest.is_empty() {
            let (square, factor) = self.four::<A, P>(a, filled_up(rest), rest.len(), near, least);
            let factor = a.mul(factor, MASKS[rest.len()]);
            sum = a.mul_add(self.kernel.shapes(a, a.sqrt(square)), factor, sum);
        }
        sum
    }

    /// The squares of the distances at the middle of the step, and V_j v_ij.x_ij; writes down who is near.
    #[inline(always)]
    fn four<A: FourLanes, const P: bool>(
        &self,
        a: A,
        rows: [u32; 4],
        count: usize,
        near: &mut NearRow<'_>,
        least: Option<&mut Lanes4>,
    ) -> (Lanes4, Lanes4) {
        let Self { cloud: FlowCloud { records, periods, .. }, kernel, own, back, .. } = self;
        let four = Four::<D>::gather::<A, P>(a, records, own, as_rows(rows), periods);
        let limit = Lanes4::splat(kernel.support * kernel.support);
        let square = dot(a, &four.x, &four.x);
        if let Some(least) = least {
            *least = a.min(square, *least);
        }
        let within = a.below(square, limit) & ((1 << count) - 1);
        near.push(a, rows, within);
        let mut x = four.x;
        for axis in 0..D {
            x[axis] = a.scale_add(*back, four.v[axis], x[axis]);
        }
        (dot(a, &x, &x), a.mul(four.volume, dot(a, &four.v, &x)))
    }
}
