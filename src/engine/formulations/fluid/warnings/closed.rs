//! Closed vessels whose walls do not pull: the fluid feels less of their motion than there is.
//!
//! The pressure of walls that do not pull is no part of the balance of energy and volume (`walls::wall_compression`): what they take of the work on the fluid is missing in its pressure.

use super::filling::FillingPass;
use crate::formulations::fluid::cloud::{ACCOUNTS, FlowCloud, RowSums};
use crate::notation::quantity;
use crate::schedule::Step;

/// Part of the particles that has to be inside: a flow with a free surface has no pressure of its volume.
const CONFINED: f64 = 0.95;
/// What walls have taken over the energy of compression that is worth a warning.
const TAKEN: f64 = 0.03;

/// Looks at what walls have taken, where no fluid has a free surface; `is_told` says whether the user has been warned.
pub fn look(is_told: &mut bool, cloud: &FlowCloud, scratch: &mut Vec<Option<f64>>, step: &mut Step<'_>) {
    if *is_told || cloud.is_confined() || cloud.records().len() == cloud.fluid {
        return;
    }
    let taken = step.ledger.total_named(ACCOUNTS[1]);
    let stored = step.ledger.total_named("compression");
    // Of noise there is little.
    let worth = 1e-3 * step.ledger.total_named("kinetic");
    if taken <= TAKEN * stored || taken <= worth || !is_closed(cloud, scratch) {
        return;
    }
    *is_told = true;
    let name = &step.world.body(cloud.groups[0].body).name;
    step.warnings.push(format!(
        "walls have taken {} of the work on `{name}`, which has no free surface, by {}, {:.0} % of what compresses it: its pressure is too low by about as much, \
         as the fluid beside them feels half of their motion; give them `Wall(suction: true)`",
        quantity(taken, "J"),
        quantity(step.clock.time, "s"),
        100.0 * taken / stored
    ));
}

/// Whether no fluid has a free surface.
fn is_closed(cloud: &FlowCloud, scratch: &mut Vec<Option<f64>>) -> bool {
    cloud.fluids().all(|rows| {
        scratch.clear();
        scratch.resize(rows.len(), None);
        cloud.for_each_row(rows.start, scratch, &mut RowSums::default(), &FillingPass(cloud));
        scratch.iter().flatten().count() as f64 > CONFINED * rows.len() as f64
    })
}
