//! Thin bodies that lie along other bodies or walls in a fluid: their other side is within the support of the gap, whose pressure is only that of a closed one, and the flow at their edges
//! is not at rest.

use crate::formulations::fluid::cloud::{FlowCloud, Group};
use crate::schedule::Step;

/// Share of the particles of a side that lie along something, from which on the body is told of: of a strip that is clamped, some do.
const SHARE: f64 = 0.25;

/// Warns, once, of the first thin body that lies along another one and is wet on its other side.
pub fn look(is_told: &mut bool, cloud: &FlowCloud, step: &mut Step<'_>) {
    if *is_told {
        return;
    }
    let gaps = &cloud.pairs.gaps;
    let is_dry = |&row: &usize| cloud.near_row(row).is_empty();
    let share = |side: &Group, count: usize| count as f64 / side.rows.len() as f64;
    for side in cloud.groups.iter().filter(|group| group.fluid().is_none()) {
        let is_here = |row: &usize| side.cloud.contains(row);
        let mut along = gaps.particles.iter().map(|&[row, _]| row as usize).filter(is_here).filter(is_dry);
        let Some(first) = along.next().filter(|&row| gaps.side_of(row).is_thin) else { continue };
        let is_other = |group: &&Group| group.body == side.body && group.cloud != side.cloud;
        let wet = |other: &Group| share(other, other.cloud.clone().filter(|row| !is_dry(row)).count());
        let is_wet = cloud.groups.iter().find(is_other).is_some_and(|other| wet(other) > SHARE);
        if share(side, 1 + along.count()) < SHARE || !is_wet {
            continue;
        }
        let beside = cloud.across_gap_of(first);
        let name = |row: usize| &step.world.body(gaps.side_of(row).body).name;
        if let Some(other) = beside {
            step.warnings.push(format!(
                "`{0}` lies along `{1}` and is thinner than the support of the fluid: what the fluid does to it there is uncertain; make `{0}` thicker than the support, use smaller \
                 spacings, or leave two spacings of the fluid between the two",
                name(first),
                name(other)
            ));
            *is_told = true;
            return;
        }
    }
}
