//! Whether walls have suction where they should: in flows without a free surface, and only there.
//!
//! The pressure of walls without suction is not part of the balance of energy and volume
//! (`walls::wall_compression`): the work that they take from the fluid is missing in its pressure. At a free
//! surface, walls with suction compress fluid that slides along them.

use serde::{Deserialize, Serialize};

use super::filling::filling;
use crate::formulations::fluid::cloud::{ACCOUNTS, FlowCloud, Group, RowSums};
use crate::notation::quantity;
use crate::schedule::Step;

/// Particles of a free surface over those of a side of a square, or a cube, of as many particles.
const SURFACE: f64 = 0.25;
/// Energy taken by walls over the energy of compression that causes a warning.
const TAKEN: f64 = 0.03;
/// Largest energy supplied or taken by walls over the work of gravity, loads and prescribed motions that
/// causes a warning. Chosen between a light disc that rises in a closed tank (0.04 to 0.07 without suction,
/// below 0.001 with it); the shipped flows have suction or a free surface.
const EXCHANGED: f64 = 0.03;

/// Watches the energy of compression, with which that of walls is compared at the end.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct ClosedWatch {
    is_told: bool,
    /// Largest energy of compression in the frames, J.
    largest: f64,
    /// Largest energy supplied or taken by walls and bodies in the frames, J.
    most: f64,
}

impl ClosedWatch {
    /// Evaluates the energy of compression, and at the end of a run the walls.
    pub fn look(
        &mut self,
        is_end: bool,
        cloud: &FlowCloud,
        scratch: &mut Vec<Option<f64>>,
        step: &mut Step<'_>,
    ) {
        self.largest = self.largest.max(step.ledger.total_named("compression"));
        self.most = self.most.max(step.ledger.total_named(ACCOUNTS[1]).abs());
        if !is_end || self.is_told || cloud.records().len() == cloud.fluid {
            return;
        }
        let found = match cloud.is_confined() {
            true => pulling_at_a_surface(cloud, scratch, step),
            false => self
                .taken_by_walls(cloud, scratch, step)
                .or_else(|| self.exchanged_with_walls(cloud, scratch, step)),
        };
        self.is_told = found.is_some();
        step.warnings.extend(found);
    }

    /// Energy taken by walls without suction, where no fluid has a free surface.
    fn taken_by_walls(
        &self,
        cloud: &FlowCloud,
        scratch: &mut Vec<Option<f64>>,
        step: &Step<'_>,
    ) -> Option<String> {
        let taken = step.ledger.total_named(ACCOUNTS[1]);
        // Of noise there is little.
        let worth = 1e-3 * step.ledger.motion();
        if taken <= TAKEN * self.largest || taken <= worth || !is_closed(cloud, scratch) {
            return None;
        }
        Some(format!(
            "walls and bodies have taken {} of the work on {}, without a free surface, by {}, {:.0} % of what has compressed it: its pressure is wrong by about as much where nothing gives way, and in soft vessels its volume by that share of its compression, \
             because the fluid beside them is compressed by half of their motion{}",
            quantity(taken, "J"),
            named(cloud, step),
            quantity(step.clock.time, "s"),
            100.0 * taken / self.largest,
            cure(cloud),
        ))
    }

    /// Energy that walls without suction have supplied and taken in turn, compared with the work that moves a
    /// fluid without a free surface.
    fn exchanged_with_walls(
        &self,
        cloud: &FlowCloud,
        scratch: &mut Vec<Option<f64>>,
        step: &Step<'_>,
    ) -> Option<String> {
        let work = step.ledger.turnover();
        // The work on a fluid that settles to rest is small.
        let is_worth = self.most > EXCHANGED * work && work > 0.1 * self.largest;
        if !is_worth || !is_closed(cloud, scratch) {
            return None;
        }
        Some(format!(
            "walls and bodies have given {}, or taken as much, by {}, {:.0} % of the work that moves {}, without a free surface: bodies in it are up to a tenth too slow{}",
            quantity(self.most, "J"),
            quantity(step.clock.time, "s"),
            100.0 * self.most / work,
            named(cloud, step),
            cure(cloud),
        ))
    }
}

/// The remedy where walls and bodies lack suction.
fn cure(cloud: &FlowCloud) -> &'static str {
    match cloud.groups.iter().any(Group::is_wall) {
        true => "; give the walls `Wall(suction: true)`",
        false => "; without walls, bodies have suction in a domain that is periodic along all axes",
    }
}

/// Walls and bodies with suction at a fluid with a free surface.
fn pulling_at_a_surface(
    cloud: &FlowCloud,
    scratch: &mut Vec<Option<f64>>,
    step: &Step<'_>,
) -> Option<String> {
    let pulled = beside_suction(cloud);
    (!are_closed(cloud, |i| pulled[i], scratch)).then(|| {
        format!(
            "walls or bodies with suction bound {}, with a free surface at {}: levels are 2 to 4 % too high there, and forces of impacts up to half too large; leave `suction` out",
            named(cloud, step),
            quantity(step.clock.time, "s"),
        )
    })
}

/// The fluid, or all of them.
pub(super) fn named(cloud: &FlowCloud, step: &Step<'_>) -> String {
    match cloud.fluids().count() {
        1 => format!("`{}`", step.world.body(cloud.groups[0].body).name),
        _ => "the fluids".to_owned(),
    }
}

/// The fluid particles that are joined, by others, to walls or bodies with suction, without those next to
/// them: a gap between fluid and wall is not a free surface.
fn beside_suction(cloud: &FlowCloud) -> Vec<bool> {
    let near = |i: usize| {
        let is_near = move |j: &usize| {
            let (own, other) = (&cloud.records()[i], &cloud.records()[*j]);
            let squared = cloud.offset(own.position(), other.position()).length_squared();
            other.volume() > 0.0 && squared < cloud.kernel.support * cloud.kernel.support
        };
        cloud.near_row(i).iter().map(|&j| j as usize).filter(is_near)
    };
    let pulls = |j: usize| j >= cloud.fluid && cloud.group_of(j).has_suction();
    let flows = |i: &usize| cloud.records()[*i].volume() > 0.0;
    let beside: Vec<usize> = (0..cloud.fluid).filter(flows).filter(|&i| near(i).any(pulls)).collect();
    let mut found = vec![false; cloud.fluid];
    beside.iter().for_each(|&i| found[i] = true);
    let mut next = beside.clone();
    while let Some(i) = next.pop() {
        for j in near(i).filter(|&j| j < cloud.fluid) {
            if !std::mem::replace(&mut found[j], true) {
                next.push(j);
            }
        }
    }
    beside.iter().for_each(|&i| found[i] = false);
    found
}

/// Whether there is a fluid and none has a free surface. One that has left the domain had one.
pub(super) fn is_closed(cloud: &FlowCloud, scratch: &mut Vec<Option<f64>>) -> bool {
    let is_there = cloud.records()[..cloud.fluid].iter().any(|record| record.volume() > 0.0);
    is_there && are_closed(cloud, |_| true, scratch)
}

/// Whether the particles of the fluids that count have no free surface.
fn are_closed(cloud: &FlowCloud, counts: impl Fn(usize) -> bool, scratch: &mut Vec<Option<f64>>) -> bool {
    cloud.fluids().all(|rows| {
        scratch.clear();
        scratch.resize(rows.len(), None);
        cloud.for_each_row(rows.start, scratch, &mut RowSums::default(), &filling(cloud));
        let counted = || rows.clone().zip(&*scratch).filter(|(i, _)| counts(*i));
        let flows = counted().filter(|(i, _)| cloud.records()[*i].volume() > 0.0).count();
        let outside = flows.saturating_sub(counted().filter(|(_, filling)| filling.is_some()).count());
        let side = (flows as f64).powf(if cloud.plane { 1.0 / 2.0 } else { 2.0 / 3.0 });
        outside as f64 <= SURFACE * side
    })
}
