//! Energy that the diffusion of density takes out of flows which walls drive.
//!
//! A particle that passes the end of a wall loses the wall's contribution to its density faster than the
//! fluid follows: behind the lips of a slot it is under tension, voids open, and the diffusion of density
//! dissipates the energy of the disturbance. Where walls do all the work, this loss is missing in the force
//! on them. Real breaking waves lose as much: a violently sloshing tank without viscosity 5 % in five
//! seconds.

use crate::formulations::fluid::cloud::{ACCOUNTS, FlowCloud};
use crate::notation::quantity;
use crate::schedule::{AccountKind, Step};

/// Energy taken over the largest that any account has held that is worth a warning.
const SHARE: f64 = 0.06;
/// Work of walls over that energy above which they drive the flow.
const WORK: f64 = 0.5;

/// Evaluates the energy that the diffusion of density, whose account has that name, has taken by the end of a
/// run.
pub fn look(is_told: &mut bool, diffusion: Option<&str>, cloud: &FlowCloud, step: &mut Step<'_>) {
    let Some(diffusion) = diffusion.filter(|_| !*is_told) else { return };
    let walls = || cloud.groups.iter().filter(|group| group.is_wall());
    let supplied = step.ledger.accounts().iter().filter(|account| account.kind == AccountKind::Supplied);
    let driven = supplied.filter(|account| account.name == "constraints");
    let work = driven.map(|account| walls().map(|group| account.of(group.body)).sum::<f64>()).sum();
    let work = step.ledger.without_drift(work);
    let (taken, largest) = (step.ledger.total_named(diffusion), step.ledger.largest());
    let friction = step.ledger.total_named(ACCOUNTS[0]);
    if taken <= SHARE * largest || work <= WORK * largest || taken <= friction {
        return;
    }
    *is_told = true;
    step.warnings.push(format!(
        "`{diffusion}` has taken {} of the {} that walls have done on {} by {}, {:.0} %: where they push one way and nothing breaks, forces on them are too small by about as much, and where they move to and fro, the waves that they leave behind wear off; \
         a fluid tears where it passes the end of a wall, as a jet does behind the lips of a slot (15 and 7 %, 8 and 16 particles across), and waves of less than a spacing wear off; take more particles",
        quantity(taken, "J"),
        quantity(work, "J"),
        super::closed::named(cloud, step),
        quantity(step.clock.time, "s"),
        100.0 * taken / work,
    ));
}
