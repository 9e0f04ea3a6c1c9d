//! What surrounds a particle of a fluid, boundary particles included: whether its neighbours are on all
//! sides, and how far their volumes fill the space.

use std::ops::Range;

use glam::DVec3;

use crate::correction::moment_of;
use crate::formulations::fluid::cloud::{
    FlowCloud, NearPairs, RowPass, add_arrangement, smallest_eigenvalue,
};
use crate::parallel::{Arithmetic, Vector, sum_over_blocks};

/// The surroundings of a particle.
pub struct FilledAround {
    /// Smallest eigenvalue of `M = sum_j V_j w_ij x_ij (x) x_ij`: one where particles are evenly spread.
    pub least: f64,
    /// `sum_j V_j w_ij x_ij`, 1/m: zero where they are on opposite sides.
    pub first: DVec3,
    /// `sum_j V_j W_ij` with the particle itself: one where the volumes fill space.
    pub filling: f64,
}

/// The pass that makes an output of the row in the cloud and its surroundings.
pub struct Surroundings<'a, F> {
    pub cloud: &'a FlowCloud,
    pub output: F,
}

impl<T: Send, F: Fn(usize, &FilledAround) -> T + Sync> RowPass<0, 5> for Surroundings<'_, F> {
    type Output = T;

    fn among(&self) -> Range<usize> {
        self.cloud.everything()
    }

    fn reads(&self, _: usize) -> [DVec3; 0] {
        []
    }

    #[inline(always)]
    fn add<A: Arithmetic>(
        &self,
        near: &NearPairs<A>,
        _: &[Vector<A>; 0],
        _: &[Vector<A>; 0],
        [xx, yy, zz, first, filling]: &mut [Vector<A>; 5],
    ) {
        add_arrangement(near, [xx, yy, zz, first]);
        filling.x = near.volume.mul_add(near.kernel, filling.x);
    }

    fn output(&self, i: usize, &[xx, yy, zz, first, filling]: &[DVec3; 5]) -> T {
        let Self { cloud, output } = self;
        let least = smallest_eigenvalue(moment_of([xx, yy, zz], cloud.plane).matrix(), cloud.plane);
        let filling = filling.x + cloud.records[i].volume() * cloud.kernel.value(0.0);
        output(i, &FilledAround { least, first, filling })
    }
}

/// Number and sum of the values that are there.
pub fn count_and_sum(rows: &[Option<f64>]) -> (f64, f64) {
    sum_over_blocks(rows, &|_, rows: &[Option<f64>]| {
        (rows.iter().flatten().count() as f64, rows.iter().flatten().sum::<f64>())
    })
}
