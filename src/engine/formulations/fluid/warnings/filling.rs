//! Gaps and swelling: whether the density of the particles agrees with their spatial distribution.
//!
//! `sum_j V_j W_ij`, the particle itself and boundary particles included, is one wherever the volumes m / rho
//! fill space. The density of a particle is integrated from the velocities around it, and does not change
//! with gaps.

use std::ops::Range;

use glam::DVec3;
use serde::{Deserialize, Serialize};

use crate::correction::{add_moment, moment_of};
use crate::formulations::fluid::cloud::{FlowCloud, NearPairs, RowPass, RowSums, smallest_eigenvalue};
use crate::notation::quantity;
use crate::parallel::{Arithmetic, Vector, sum_over_blocks};
use crate::schedule::{Step, replace_warning};

/// Smallest eigenvalue of the moment matrix above which a particle is inside the fluid.
const INSIDE: f64 = 0.75;
/// Difference of the mean filling from one that is worth a warning.
const SHARE: f64 = 0.1;
/// Growth of the difference for which the warning is renewed.
const GROWTH: f64 = 1.2;
/// Minimum part of the particles of a body that has to be inside for a mean: a splash has gaps.
const PART: f64 = 0.25;

/// Watches the filling of every body.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct FillingWatch {
    /// Largest difference of each group reported to the user.
    told: Vec<f64>,
}

impl FillingWatch {
    /// Checks all fluids.
    pub fn look(&mut self, cloud: &FlowCloud, scratch: &mut Vec<Option<f64>>, step: &mut Step<'_>) {
        self.told.resize(cloud.groups.len(), 0.0);
        for (group, told) in cloud.groups.iter().zip(&mut self.told) {
            if group.fluid().is_none() {
                break;
            }
            scratch.clear();
            scratch.resize(group.cloud.len(), None);
            cloud.for_each_row(group.cloud.start, scratch, &mut RowSums::default(), &FillingPass(cloud));
            let Some(mean) = mean_filling(scratch) else { continue };
            let off = (mean - 1.0).abs();
            if off <= SHARE.max(GROWTH * *told) {
                continue;
            }
            *told = off;
            let name = &step.world.body(group.body).name;
            let begin = format!("the particles of `{name}` do not fill ");
            let text = format!(
                "{begin}the space that they have: inside of it their volumes m/rho make up {:.1} % of it at {}; {}",
                100.0 * mean,
                quantity(step.clock.time, "s"),
                if mean < 1.0 {
                    "there are gaps, or the flow has swollen: a confined flow needs a pressure above zero, others weaker shifting or none"
                } else {
                    "the flow has collapsed: a larger `sound_speed`, `density_diffusion()` or a smaller step may help"
                }
            );
            replace_warning(step.warnings, &begin, text);
        }
    }
}

/// Mean of the filling over the particles inside; none where there are too few.
fn mean_filling(rows: &[Option<f64>]) -> Option<f64> {
    let (inside, filling) = sum_over_blocks(rows, &|_, rows: &[Option<f64>]| {
        (rows.iter().flatten().count() as f64, rows.iter().flatten().sum::<f64>())
    });
    (inside > PART * rows.len() as f64).then(|| filling / inside)
}

/// The filling about a particle; none near a surface.
pub struct FillingPass<'a>(pub &'a FlowCloud);

impl RowPass<0, 4> for FillingPass<'_> {
    type Output = Option<f64>;

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
        [xx, yy, zz, filling]: &mut [Vector<A>; 4],
    ) {
        add_moment([xx, yy, zz], near.volume * near.weight, near.x_ij);
        filling.x = near.volume.mul_add(near.kernel, filling.x);
    }

    fn output(&self, i: usize, &[xx, yy, zz, filling]: &[DVec3; 4]) -> Option<f64> {
        let cloud = self.0;
        let own = cloud.records[i].volume();
        let moment = moment_of([xx, yy, zz], cloud.plane);
        let is_inside = own > 0.0 && smallest_eigenvalue(moment.matrix(), cloud.plane) > INSIDE;
        is_inside.then(|| filling.x + own * cloud.kernel.value(0.0))
    }
}
