//! Gaps and swelling: whether the density of the particles agrees with their spatial distribution.
//!
//! `sum_j V_j W_ij`, the particle itself and boundary particles included, is one wherever the volumes m / rho
//! fill space. The density of a particle is integrated from the velocities around it, and does not change
//! with gaps.

use serde::{Deserialize, Serialize};

use super::surroundings::{FilledAround, Surroundings, count_and_sum};
use crate::formulations::fluid::cloud::{FlowCloud, RowPass, RowSums};
use crate::notation::quantity;
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
            cloud.for_each_row(group.cloud.start, scratch, &mut RowSums::default(), &filling(cloud));
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
    let (inside, filling) = count_and_sum(rows);
    (inside > PART * rows.len() as f64).then(|| filling / inside)
}

/// The filling about a particle; none near a surface.
pub fn filling(cloud: &FlowCloud) -> impl RowPass<0, 5, Output = Option<f64>> {
    Surroundings {
        cloud,
        output: |i: usize, around: &FilledAround| {
            let is_inside = cloud.records[i].volume() > 0.0 && around.least > INSIDE;
            is_inside.then_some(around.filling)
        },
    }
}
