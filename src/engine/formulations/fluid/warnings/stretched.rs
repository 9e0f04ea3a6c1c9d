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

use super::surroundings::{FilledAround, Surroundings, count_and_sum};
use crate::formulations::fluid::cloud::{FlowCloud, RowPass, RowSums};
use crate::notation::quantity;
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
        cloud.for_each_row(group.cloud.start, scratch, &mut RowSums::default(), &drawn_apart(cloud));
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
    let (count, sum) = count_and_sum(rows);
    sum / count.max(1.0)
}

/// One for a particle whose neighbours along an axis are out of reach, zero for others, none for removed
/// ones.
fn drawn_apart(cloud: &FlowCloud) -> impl RowPass<0, 5, Output = Option<f64>> {
    Surroundings {
        cloud,
        output: |i: usize, around: &FilledAround| {
            let is_even = cloud.kernel.smoothing_length() * around.first.length() < EVEN;
            let is_apart = around.least < LACKING && is_even && around.filling > FILLED;
            (cloud.records[i].volume() > 0.0).then_some(if is_apart { 1.0 } else { 0.0 })
        },
    }
}
