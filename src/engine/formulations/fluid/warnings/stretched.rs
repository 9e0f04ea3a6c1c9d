//! Rows of a lattice that a flow has drawn apart, farther than the support: the fluid has come apart into
//! sheets or threads that do not see each other.
//!
//! The rate of compression is `D : M` with the rate of strain D and `M = sum_j V_j w_ij x_ij (x) x_ij`, which
//! is the identity where particles are evenly spread. In a lattice that is stretched along its rows the
//! component of M along them goes to zero, `m_i = sum_j V_j w_ij x_ij` stays zero by symmetry, and
//! `sum_j V_j W_ij` stays one: across the stretch the fluid no longer contracts. A round drop that is drawn
//! out to three and a half times its length is 1.5 times as wide as it should be, at any resolution; in a
//! `Relaxed` lattice, whose particles change places, it is right within 0.2 %. Particles at a free surface
//! have a large `m_i`, and those of a thread in empty space do not fill it.

use std::ops::Range;

use glam::DVec3;

use crate::correction::{add_moment, moment_of};
use crate::formulations::fluid::cloud::{FlowCloud, NearPairs, RowPass, RowSums, smallest_eigenvalue};
use crate::notation::quantity;
use crate::parallel::{Arithmetic, Vector, sum_over_blocks};
use crate::schedule::Step;

/// Smallest eigenvalue of M below which a particle lacks neighbours along an axis.
const LACKING: f64 = 0.75;
/// Largest h |m_i| of a particle that has neighbours on all sides or on two opposite ones.
const EVEN: f64 = 0.15;
/// Smallest `sum_j V_j W_ij` of a particle whose surroundings count as filled.
const FILLED: f64 = 0.85;
/// Share of such particles that is worth a warning. Drops that were 6 to 60 % too wide had 0.45 to 0.78,
/// those within 2 % had 0.28 at most.
const SHARE: f64 = 0.3;

/// Checks all fluids; `told` says which of them the user has been warned of.
pub fn look(told: &mut Vec<bool>, cloud: &FlowCloud, scratch: &mut Vec<Option<f64>>, step: &mut Step<'_>) {
    told.resize(cloud.groups.len(), false);
    for (group, told) in cloud.groups.iter().zip(told) {
        if group.fluid().is_none() {
            break;
        }
        if *told {
            continue;
        }
        scratch.clear();
        scratch.resize(group.cloud.len(), None);
        cloud.for_each_row(group.cloud.start, scratch, &mut RowSums::default(), &DrawnApart(cloud));
        let share = mean(scratch);
        if share <= SHARE {
            continue;
        }
        *told = true;
        step.warnings.push(format!(
            "the particles of `{}` have been drawn apart by {}: {:.0} % of them no longer see those ahead and behind along one axis, and the fluid does not become \
             thinner as it is stretched on; start it with `lattice: Relaxed(seed: 1, iterations: 30)`, whose particles change places",
            step.world.body(group.body).name,
            quantity(step.clock.time, "s"),
            100.0 * share,
        ));
    }
}

/// Mean over the particles that are there.
fn mean(rows: &[Option<f64>]) -> f64 {
    let (count, sum) = sum_over_blocks(rows, &|_, rows: &[Option<f64>]| {
        (rows.iter().flatten().count() as f64, rows.iter().flatten().sum::<f64>())
    });
    sum / count.max(1.0)
}

/// One for a particle whose neighbours along an axis are out of reach, zero for others, none for removed
/// ones.
struct DrawnApart<'a>(&'a FlowCloud);

impl RowPass<0, 5> for DrawnApart<'_> {
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
        [xx, yy, zz, first, filling]: &mut [Vector<A>; 5],
    ) {
        let weight = near.volume * near.weight;
        add_moment([xx, yy, zz], weight, near.x_ij);
        *first = near.x_ij.mul_add(weight, *first);
        filling.x = near.volume.mul_add(near.kernel, filling.x);
    }

    fn output(&self, i: usize, &[xx, yy, zz, first, filling]: &[DVec3; 5]) -> Option<f64> {
        let cloud = self.0;
        let own = cloud.records[i].volume();
        let lacks = smallest_eigenvalue(moment_of([xx, yy, zz], cloud.plane).matrix(), cloud.plane) < LACKING;
        let is_even = cloud.kernel.smoothing_length() * first.length() < EVEN;
        let is_filled = filling.x + own * cloud.kernel.value(0.0) > FILLED;
        (own > 0.0).then_some(if lacks && is_even && is_filled { 1.0 } else { 0.0 })
    }
}
