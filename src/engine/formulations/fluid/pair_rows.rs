//! The pairs within a fluid body as pairs for pair terms.

use super::cloud::{FlowCloud, Group};
use crate::pair::{Pair, PairRows, PairSource};
use crate::schedule::{Step, StepError};
use crate::world::BodyId;

/// Gives pair terms the pairs of fluid bodies.
pub(super) struct FluidPairs;

impl PairSource for FluidPairs {
    fn with_rows(
        &self,
        step: &Step<'_>,
        body: BodyId,
        run: &mut dyn FnMut(&dyn PairRows) -> Result<(), StepError>,
    ) -> Result<(), StepError> {
        let cloud = step.resources.get::<FlowCloud>();
        let Some(group) = cloud.groups.iter().find(|group| group.body == body) else { return Ok(()) };
        run(&BodyPairs { cloud: &cloud, group })
    }
}

struct BodyPairs<'a> {
    cloud: &'a FlowCloud,
    group: &'a Group,
}

impl PairRows for BodyPairs<'_> {
    fn row(&self, i: usize, with_kernel: bool, pairs: &mut Vec<Pair>) {
        let FlowCloud { records, kernel, pairs: lists, .. } = self.cloud;
        let Group { rows, cloud, .. } = self.group;
        let row_of = |j: usize| j - cloud.start + rows.start;
        let i = i - rows.start + cloud.start;
        let own = &records[i];
        let limit = kernel.support * kernel.support;
        pairs.clear();
        for &j in lists.fluid.row(i) {
            let j = j as usize;
            if j == i || !cloud.contains(&j) {
                continue;
            }
            let other = &records[j];
            let x_ij = lists.periodic().minimal_image(other.position() - own.position());
            let square = x_ij.length_squared();
            if square >= limit || own.volume() == 0.0 || other.volume() == 0.0 {
                continue;
            }
            let distance = square.sqrt();
            pairs.push(Pair {
                x_ij,
                distance,
                reference_x_ij: x_ij,
                reference_distance: distance,
                weight: kernel.weight(distance),
                kernel: if with_kernel { kernel.value(distance) } else { f64::NAN },
                support: kernel.support,
                volume_i: own.volume(),
                volume_j: other.volume(),
                row_j: row_of(j) as u32,
                mirror: None,
            });
        }
    }
}
