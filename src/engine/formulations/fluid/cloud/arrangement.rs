//! Arrangement of the neighbours of a particle: moment matrix and first moment.

use std::ops::Range;

use glam::DVec3;

use super::flow_cloud::FlowCloud;
use super::row_pass::{NearPairs, RowPass};
use crate::correction::{MomentMatrix, add_moment, moment_of};
use crate::parallel::{Arithmetic, Vector};

/// The pass that sums the moment matrix `M_i = sum_j V_j w_ij x_ij (x) x_ij` and the first moment `S_i =
/// sum_j V_j w_ij x_ij` (1/m) over all neighbours of a fluid particle, walls and bodies included, and makes
/// an output of both.
pub struct ArrangementPass<'a, F> {
    /// The particles.
    pub cloud: &'a FlowCloud,
    /// The result for the row in the cloud, the moment matrix and the first moment.
    pub output: F,
}

impl<T: Send, F: Fn(usize, &MomentMatrix, DVec3) -> T + Sync> RowPass<0, 4> for ArrangementPass<'_, F> {
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
        [xx, yy, zz, first_moment]: &mut [Vector<A>; 4],
    ) {
        add_arrangement(near, [xx, yy, zz, first_moment]);
    }

    #[inline(always)]
    fn output(&self, i: usize, &[xx, yy, zz, first_moment]: &[DVec3; 4]) -> T {
        (self.output)(i, &moment_of([xx, yy, zz], self.cloud.plane), first_moment)
    }
}

/// Adds neighbours to the three columns of the moment matrix and to the first moment.
#[inline(always)]
pub fn add_arrangement<A: Arithmetic>(near: &NearPairs<A>, [xx, yy, zz, first_moment]: [&mut Vector<A>; 4]) {
    let weight = near.volume * near.weight;
    *first_moment = near.x_ij.mul_add(weight, *first_moment);
    add_moment([xx, yy, zz], weight, near.x_ij);
}
