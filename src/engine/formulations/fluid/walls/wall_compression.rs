//! The rate of compression that is adjoint to the pressure force of boundaries, in flows without a free
//! surface.
//!
//! The pressure of a boundary with suction is a mean of that of the fluid, `p_w = sum_i V_i W_iw p_i / S_w`
//! with `S_w = sum_f V_f W_wf` (`wall_pressure`, beside what gravity and loads add). The power of its force
//! is `V_w p_w D_w`, with the rate of compression of the fluid as the boundary particle sees it,
//!
//! `D_w = sum_f V_f w_wf v_wf.x_wf`,
//!
//! so that of fluid particle i is greater by `sum_w V_w W_iw D_w / S_w`: the force is the adjoint of the rate
//! of compression. The energy that the fluid loses is the work on its boundaries, its volume change is
//! conjugate to the force on them, and sliding along a wall contributes a stretch.
//!
//! Boundaries without suction do not have this term: their pressure is cut off at zero, and at the edge of a
//! free surface on a wall the fluid ahead of a particle is missing, so that sliding would compress it.

use std::ops::Range;

use super::wall_pressure::share_wetted;
use crate::formulations::fluid::cloud::{FlowCloud, MIN_SHARE};
use crate::formulations::fluid::lanes::{Four, MASKS, OwnRecord, as_rows, dot, filled_up};
use crate::parallel::{
    FourLanes, Lanes4, PlaneOrSpace, Split, for_each_block, for_each_own_block, run_hot_in, share_rows_of,
};
use crate::schedule::{Run, Step, StepError};

/// Adds to the rates of compression of fluids what follows from the force of their boundaries.
#[derive(Default)]
pub struct WallCompression {
    /// `D_w / S_w` of every boundary particle, 1/s.
    rates: Vec<f64>,
}

impl Run for WallCompression {
    fn run(&mut self, step: &mut Step<'_>) -> Result<(), StepError> {
        let mut cloud = step.resources.get_mut::<FlowCloud>();
        let back = -0.5 * step.clock.dt;
        self.rates.resize(cloud.records.len() - cloud.fluid, 0.0);
        self.find(&cloud, back);
        let mut of_boundaries = std::mem::take(&mut cloud.boundary_compression);
        of_boundaries.resize(cloud.fluid, 0.0);
        self.spread(&cloud, back, &mut of_boundaries);
        type Rows<'a> = (&'a mut [f64], &'a [f64]);
        let rows = (&mut cloud.compression[..], &of_boundaries[..]);
        for_each_block(rows, &mut Vec::new(), &|_, (rates, parts): Rows<'_>| {
            rates.iter_mut().zip(parts).for_each(|(rate, part)| *rate += part);
        });
        cloud.boundary_compression = of_boundaries;
        Ok(())
    }
}

impl WallCompression {
    /// Finds the rates beside all boundary particles; `back` is the time from the end of the step to its
    /// middle, s.
    fn find(&mut self, cloud: &FlowCloud, back: f64) {
        let boundaries = || cloud.groups.iter().filter(|group| group.fluid().is_none());
        let mut rest = &mut self.rates[..];
        for group in boundaries() {
            let Range { start, end } = group.cloud;
            let (rows, behind) = rest.split(end - start);
            rest = behind;
            if group.has_suction() {
                for_each_own_block(rows, &mut Vec::new(), &|first, out: &mut [f64]| {
                    let first = start - cloud.fluid + first;
                    run_hot_in(cloud.plane, RatesBeside { cloud, back, first, out });
                });
            }
        }
        share_wetted(cloud, &mut self.rates);
        for edge in &cloud.edges.particles {
            self.rates[edge.row - cloud.fluid] += edge.rate;
        }
    }

    /// Finds what follows for every fluid particle.
    fn spread(&self, cloud: &FlowCloud, back: f64, of_boundaries: &mut [f64]) {
        let mut rest = &mut *of_boundaries;
        for fluid in cloud.fluids() {
            let (rows, behind) = rest.split(fluid.len());
            rest = behind;
            for_each_own_block(rows, &mut Vec::new(), &|first, out: &mut [f64]| {
                let first = fluid.start + first;
                run_hot_in(cloud.plane, SpreadRates { cloud, rates: &self.rates, back, first, out });
            });
        }
        share_rows_of(of_boundaries, cloud.fluids());
    }
}

/// Four neighbours at the middle of the step.
struct FourBefore<const D: usize> {
    four: Four<D>,
    x: [Lanes4; D],
    distance: Lanes4,
    /// V_j; zero in lanes without a neighbour.
    volume: Lanes4,
}

impl<const D: usize> FourBefore<D> {
    #[inline(always)]
    fn gather<A: FourLanes, const P: bool>(
        a: A,
        cloud: &FlowCloud,
        own: &OwnRecord<D>,
        chunk: &[u32],
        back: f64,
    ) -> Self {
        let rows = as_rows(filled_up(chunk));
        let four = Four::<D>::gather::<A, P>(a, &cloud.records, own, rows, &cloud.periods);
        let mut x = four.x;
        for axis in 0..D {
            x[axis] = a.scale_add(back, four.v[axis], x[axis]);
        }
        let distance = a.sqrt(dot(a, &x, &x));
        let volume = a.mul(four.volume, MASKS[chunk.len()]);
        Self { four, x, distance, volume }
    }
}

struct RatesBeside<'a> {
    cloud: &'a FlowCloud,
    back: f64,
    first: usize,
    out: &'a mut [f64],
}

impl PlaneOrSpace for RatesBeside<'_> {
    #[inline(always)]
    fn run<A: FourLanes, const D: usize>(self, a: A) {
        if self.cloud.periods.any() { self.rows::<A, D, true>(a) } else { self.rows::<A, D, false>(a) }
    }
}

impl RatesBeside<'_> {
    #[inline(always)]
    fn rows<A: FourLanes, const D: usize, const P: bool>(self, a: A) {
        let Self { cloud, back, first, out } = self;
        let kernel = cloud.kernel;
        for (row, out) in (first..).zip(out) {
            let own = OwnRecord::<D>::new(&cloud.records[cloud.fluid + row]);
            let (mut share, mut rate) = (Lanes4::ZERO, Lanes4::ZERO);
            for chunk in cloud.pairs.boundary.row(row).chunks(4) {
                let FourBefore { four, x, distance, volume } =
                    FourBefore::gather::<A, P>(a, cloud, &own, chunk, back);
                share = a.mul_add(kernel.values(a, distance), volume, share);
                let approach = a.mul(dot(a, &four.v, &x), volume);
                rate = a.mul_add(kernel.weights(a, distance), approach, rate);
            }
            let share = share.sum();
            *out = if share > MIN_SHARE { rate.sum() / share } else { 0.0 };
        }
    }
}

struct SpreadRates<'a> {
    cloud: &'a FlowCloud,
    rates: &'a [f64],
    back: f64,
    first: usize,
    out: &'a mut [f64],
}

impl PlaneOrSpace for SpreadRates<'_> {
    #[inline(always)]
    fn run<A: FourLanes, const D: usize>(self, a: A) {
        if self.cloud.periods.any() { self.rows::<A, D, true>(a) } else { self.rows::<A, D, false>(a) }
    }
}

impl SpreadRates<'_> {
    #[inline(always)]
    fn rows<A: FourLanes, const D: usize, const P: bool>(self, a: A) {
        let Self { cloud, rates, back, first, out } = self;
        for (i, out) in (first..).zip(out) {
            let own = OwnRecord::<D>::new(&cloud.records[i]);
            let mut sum = Lanes4::ZERO;
            for chunk in cloud.pairs.walls.row(i).chunks(4) {
                let FourBefore { distance, volume, .. } =
                    FourBefore::gather::<A, P>(a, cloud, &own, chunk, back);
                let rates = Lanes4(filled_up(chunk).map(|j| rates[j as usize - cloud.fluid]));
                sum = a.mul_add(a.mul(cloud.kernel.values(a, distance), volume), rates, sum);
            }
            *out = sum.sum();
        }
    }
}
