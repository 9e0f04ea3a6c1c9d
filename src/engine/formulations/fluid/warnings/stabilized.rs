//! Warning of energy that stabilizers dissipate in flows with hardly any friction.
//!
//! In breaking and falling water, stabilizers dissipate energy that a real flow would lose too. A fluid
//! without a free surface, and one without walls, lose nothing without friction: a loss there is an error.
//! Particles that move past stepped walls, that are in tension, or that go from one lattice arrangement into
//! another, are disturbed, and stabilizers dissipate the energy of the disturbance.

use crate::formulations::fluid::cloud::{ACCOUNTS, FlowCloud};
use crate::formulations::fluid::lanes::FlowParticle;
use crate::notation::quantity;
use crate::removal::REMOVED_ENERGY;
use crate::schedule::{Account, AccountKind, Step};

use super::closed::is_closed;

/// Energy that stabilizers have taken over the largest that any account has held that is worth a warning.
const SHARE: f64 = 0.2;

/// Account of the damping of the velocity of every particle, which a scene asks for to lose motion.
const DAMPING: &str = "local_damping";

/// Evaluates the energy that stabilizers have taken from the fluids by the end of a run.
pub fn look(is_told: &mut bool, cloud: &FlowCloud, scratch: &mut Vec<Option<f64>>, step: &mut Step<'_>) {
    let fluids = || cloud.groups.iter().filter(|group| group.fluid().is_some());
    let of_fluids = |account: &Account| fluids().map(|group| account.of(group.body)).sum::<f64>();
    let is_stabilizer = |account: &&Account| {
        let name = account.name.as_str();
        let is_meant = ACCOUNTS.contains(&name) || [REMOVED_ENERGY, DAMPING].contains(&name);
        account.kind == AccountKind::Dissipated && !is_meant
    };
    let taken = || step.ledger.accounts().iter().filter(is_stabilizer).map(|a| (a, of_fluids(a)));
    let total: f64 = taken().map(|(_, energy)| energy).sum();
    let (largest, friction) = (step.ledger.largest(), step.ledger.total_named(ACCOUNTS[0]));
    if *is_told || total <= SHARE * largest || total <= friction {
        return;
    }
    let is_bounded = cloud.records().len() > cloud.fluid;
    if is_bounded && !is_closed(cloud, scratch) {
        return;
    }
    let Some((account, _)) = taken().max_by(|a, b| a.1.total_cmp(&b.1)) else { return };
    *is_told = true;
    let lowest = cloud.records()[..cloud.fluid].iter().map(FlowParticle::pressure).fold(0.0, f64::min);
    let tension = match is_bounded && lowest < 0.0 {
        true => format!(
            "some are in tension, down to {}: a pressure at the start that keeps it above zero, `Fluid(pressure: ...)`; ",
            quantity(lowest, "Pa")
        ),
        false => String::new(),
    };
    step.warnings.push(format!(
        "{} of the motion of {} has been lost to `{}` by {}, {:.0} % of the largest energy of the run, where there is nothing to lose it by but friction: its particles shake; {tension}{}take more particles",
        quantity(total, "J"),
        super::closed::named(cloud, step),
        account.name,
        quantity(step.clock.time, "s"),
        100.0 * total / largest,
        if is_bounded {
            "where walls or bodies are curved, give them and the fluid `lattice: Concentric`, `BodyFitted()` or `Relaxed()`, elsewhere "
        } else {
            "start them from `lattice: Relaxed()`, or "
        },
    ));
}
