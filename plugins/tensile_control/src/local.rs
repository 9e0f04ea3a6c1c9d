//! How the particles of a neighbourhood lie.

use std::ops::Range;

use meshless_engine::correction::{add_moment, moment_of};
use meshless_engine::formulations::fluid::{FlowCloud, NearPairs, RowPass, smallest_eigenvalue};
use meshless_engine::glam::DVec3;
use meshless_engine::parallel::{Arithmetic, Vector};

/// The neighbourhood of a particle.
#[derive(Clone, Copy, Debug, Default)]
pub struct Local {
    /// Smallest eigenvalue of the moment matrix `sum_j V_j w_ij x_ij (x) x_ij`: one inside, about a half at a free surface.
    pub lambda: f64,
    /// First moment `S = sum_j V_j w_ij x_ij`, 1/m: it points to where particles are crowded.
    pub first_moment: DVec3,
}

/// The pass that computes them.
pub struct Locals<'a>(pub &'a FlowCloud);

impl RowPass<0, 4> for Locals<'_> {
    type Output = Local;

    fn among(&self) -> Range<usize> {
        self.0.everything()
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
        let weight = near.volume * near.weight;
        *first_moment = near.x_ij.mul_add(weight, *first_moment);
        add_moment([xx, yy, zz], weight, near.x_ij);
    }

    #[inline(always)]
    fn output(&self, _: usize, &[xx, yy, zz, first_moment]: &[DVec3; 4]) -> Local {
        let plane = self.0.plane();
        Local { lambda: smallest_eigenvalue(moment_of([xx, yy, zz], plane).matrix(), plane), first_moment }
    }
}
