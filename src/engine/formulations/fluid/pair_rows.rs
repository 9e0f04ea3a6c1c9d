//! The pairs within a fluid body as pairs for pair terms.

use super::cloud::{FlowCloud, Group};
use super::near::part;
use super::record::{FILLS, Places, padded};
use crate::pair::{FourVectors, PairRow, PairRows, PairSource};
use crate::parallel::{Arithmetic, HotLoop, Lanes4, Vector, run_hot_on};
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
    fn row(&self, i: usize, with_kernel: bool, row: &mut PairRow) {
        run_hot_on(self.cloud.plane, Fill { pairs: self, i, with_kernel, row });
    }
}

/// Fills the row of one particle.
struct Fill<'a> {
    pairs: &'a BodyPairs<'a>,
    i: usize,
    with_kernel: bool,
    row: &'a mut PairRow,
}

impl HotLoop for Fill<'_> {
    type Output = ();

    #[inline(always)]
    fn run<A: Arithmetic>(self, a: A) {
        let Self { pairs: &BodyPairs { cloud, group }, i, with_kernel, row } = self;
        let FlowCloud { records, kernel, pairs: lists, periods, .. } = cloud;
        let before = group.cloud.start - group.rows.start;
        let i = i + before;
        let own = &records[i];
        let list = if own.volume() > 0.0 { part(lists.fluid.row(i), &group.cloud) } else { &[] };
        row.volume_i = own.volume();
        let room = row.room(list.len(), false, false);
        for (k, pairs) in room.pairs.iter_mut().enumerate() {
            let chunk = &list[4 * k..(4 * k + 4).min(list.len())];
            let four = padded(chunk, i);
            let Places { x, volume } = Places::gather(a, records, own, four, periods);
            let x_ij = Vector::new(a, x);
            let square = x_ij.length_squared().lanes();
            let (square, volume) = kernel.within(a, square, FILLS[chunk.len()], volume);
            let distance = a.sqrt(square);
            pairs.current = FourVectors { vector: x, length: distance };
            pairs.weight = kernel.weights(a, distance);
            pairs.support = Lanes4::splat(kernel.support);
            pairs.volume_j = volume;
            if with_kernel {
                pairs.kernel = kernel.values(a, distance);
            }
            room.rows[k] = [
                (four[0] - before) as u32,
                (four[1] - before) as u32,
                (four[2] - before) as u32,
                (four[3] - before) as u32,
            ];
        }
    }
}
