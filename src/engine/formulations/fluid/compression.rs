//! First pass over pairs: the rate of compression.
//!
//! `D_i = sum_j V_j w_ij v_ij.x_ij` at the middle of the step, so that `drho_i/dt = -rho_i D_i`. With x at the end of the step
//! and v at its middle, the pair vectors at the middle are `x_ij - dt/2 v_ij`.

use super::cloud::FlowCloud;
use super::record::{Four, dot, padded};
use crate::parallel::{Arithmetic, Lanes4, PlaneOrSolid, for_each_block, run_hot_in};

/// The pass over all fluid particles.
pub(super) struct Compression<'a> {
    pub cloud: &'a FlowCloud,
    /// Length of the step, s.
    pub dt: f64,
}

impl Compression<'_> {
    /// Writes D of every fluid particle, 1/s.
    pub fn run(&self, out: &mut [f64]) {
        for_each_block(out, &mut Vec::new(), &|first, out: &mut [f64]| {
            run_hot_in(self.cloud.plane, Rows { pass: self, first, out });
        });
    }
}

struct Rows<'a> {
    pass: &'a Compression<'a>,
    first: usize,
    out: &'a mut [f64],
}

impl PlaneOrSolid for Rows<'_> {
    #[inline(always)]
    fn run<A: Arithmetic, const D: usize>(self, a: A) {
        if self.pass.cloud.periods.any() { self.rows::<A, D, true>(a) } else { self.rows::<A, D, false>(a) }
    }
}

impl Rows<'_> {
    #[inline(always)]
    fn rows<A: Arithmetic, const D: usize, const P: bool>(self, a: A) {
        let FlowCloud { records, pairs, kernel, periods, .. } = self.pass.cloud;
        let back = -0.5 * self.pass.dt;
        for (k, out) in self.out.iter_mut().enumerate() {
            let i = self.first + k;
            let own = &records[i];
            let mut sum = Lanes4::ZERO;
            for chunk in pairs.fluid.row(i).chunks(4) {
                let four = Four::<D>::gather::<A, P>(a, records, own, padded(chunk, i), periods);
                let mut x = four.x;
                for axis in 0..D {
                    x[axis] = a.scale_add(back, four.v[axis], x[axis]);
                }
                let weight = kernel.weights(a, a.sqrt(dot(a, &x, &x)));
                sum = a.times_add(a.times(weight, four.volume), dot(a, &four.v, &x), sum);
            }
            *out = sum.sum();
        }
    }
}
