//! Energy from terms that can only dissipate: friction, diffusion, shifting, walls.

use glam::DVec3;
use serde::{Deserialize, Serialize};

use super::remedies::Remedies;
use crate::formulations::eulerian::SUPPORT_CHANGE;
use crate::formulations::fluid::{FlowCloud, FlowParticle, Group, SHIFTING_ENERGY};
use crate::notation::quantity;
use crate::parallel::{BlockSum, sum_over_blocks};
use crate::plugin::SimBuilder;
use crate::removal::REMOVED_ENERGY;
use crate::schedule::{Account, AccountKind, INTO_HEAT, Step, replace_warning};

/// Energy given, over the largest one that any account has held, that is worth a warning.
const SHARE: f64 = 0.01;
/// The same where walls give it: their pressure is extrapolated, and they push fluid on that starts or
/// arrives, to take as much a little later.
const SHARE_OF_WALLS: f64 = 0.05;
/// The same where supports of Eulerian bodies change: the energy of the control has other weights then, most
/// of them larger ones.
const SHARE_OF_SUPPORTS: f64 = 0.05;
/// The same over the work that gravity and loads on fluids could do on all bodies along their own heights:
/// bodies at rest have hardly any other energy.
const SHARE_OF_WEIGHT: f64 = 0.005;
/// Consecutive checks in which the criterion has to be met: there is little energy at the start of a run. The
/// end of a run counts as all of them.
const LOOKS: u32 = 5;
/// Growth of that share for which the warning is renewed.
const GROWTH: f64 = 1.2;

/// Account of the pressure of walls.
const WALLS: &str = "wall_pressure";

/// Account of the dashpots of contacts.
const CONTACT_DAMPING: &str = "contact_damping";

/// Watches the accounts of what takes energy out of the motion.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub(super) struct WrongSign {
    accounts: Vec<SuppliedEnergy>,
    /// Largest work that gravity or a load could do, seen so far, J.
    weight: f64,
}

/// Energy supplied by an account.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
struct SuppliedEnergy {
    name: String,
    /// Consecutive checks in which it has supplied too much.
    looks: u32,
    /// Largest share reported to the user.
    told: f64,
}

impl WrongSign {
    /// Over the work that gravity could do.
    pub fn new(sim: &SimBuilder<'_>) -> Self {
        Self { weight: sim.work_of_weight(), accounts: Vec::new() }
    }

    /// Warns of every account that has given energy; the warning keeps up with the largest share.
    pub fn warn(&mut self, step: &mut Step<'_>, remedies: &Remedies, at_end: bool) {
        if let Some(cloud) = FlowCloud::whole(step.resources) {
            self.weight = self.weight.max(work_of_loads(&cloud));
        }
        let largest = step.ledger.largest();
        let can_only_take = |account: &&Account| {
            // What has left the domain may have been below zero height.
            let may_give = [REMOVED_ENERGY, INTO_HEAT].contains(&account.name.as_str());
            account.kind == AccountKind::Dissipated && !may_give
        };
        for account in step.ledger.accounts().iter().filter(can_only_take) {
            let worth = match account.name.as_str() {
                WALLS => SHARE_OF_WALLS,
                SUPPORT_CHANGE => SHARE_OF_SUPPORTS,
                _ => SHARE,
            };
            let scale = largest.max(SHARE_OF_WEIGHT / worth * self.weight);
            let share = if scale > 0.0 { -account.total() / scale } else { 0.0 };
            let k = self.accounts.iter().position(|given| given.name == account.name).unwrap_or_else(|| {
                self.accounts
                    .push(SuppliedEnergy { name: account.name.clone(), ..SuppliedEnergy::default() });
                self.accounts.len() - 1
            });
            let given = &mut self.accounts[k];
            // Less than round-off of the stored energies is nothing.
            let is_much = share > worth && -account.total() > step.ledger.resolution();
            given.looks = if is_much { given.looks + 1 } else { 0 };
            if !is_much || share <= GROWTH * given.told || (given.looks < LOOKS && !at_end) {
                continue;
            }
            given.told = share;
            let begin = format!("`{}` has produced energy ", account.name);
            let text = format!(
                "{begin}though it can only dissipate: {}, {:.0} % of the peak energy, by {}; {}",
                quantity(-account.total(), "J"),
                100.0 * share,
                quantity(step.clock.end(), "s"),
                advice(account, remedies, step)
            );
            replace_warning(step.warnings, &begin, text);
        }
    }
}

/// Corners of the box around a fluid, m, and the magnitude of the load on it along each axis, N.
#[derive(Clone, Copy)]
struct LoadedFluid {
    low: DVec3,
    high: DVec3,
    weight: DVec3,
}

impl Default for LoadedFluid {
    fn default() -> Self {
        Self { low: DVec3::INFINITY, high: DVec3::NEG_INFINITY, weight: DVec3::ZERO }
    }
}

impl BlockSum for LoadedFluid {
    fn add(&mut self, next: &Self) {
        (self.low, self.high) = (self.low.min(next.low), self.high.max(next.high));
        self.weight += next.weight;
    }
}

/// Work that the loads on fluids could do on them along their own heights, J: a `BodyForce` may be their
/// gravity.
fn work_of_loads(cloud: &FlowCloud) -> f64 {
    let of = |group: &Group| {
        let (Some(state), rows) = (group.fluid(), group.cloud.clone()) else { return 0.0 };
        let start = rows.start;
        let sum = sum_over_blocks(&cloud.records()[rows], &|first, records: &[FlowParticle]| {
            let mut sum = LoadedFluid::default();
            for (i, record) in (start + first..).zip(records).filter(|(_, record)| record.volume() > 0.0) {
                let (low, high) = (record.position(), record.position());
                let weight = state.density * record.volume() * cloud.load(i).abs();
                sum.add(&LoadedFluid { low, high, weight });
            }
            sum
        });
        let height = sum.high - sum.low;
        if height.is_finite() { sum.weight.dot(height) } else { 0.0 }
    };
    cloud.groups.iter().map(of).sum()
}

fn advice(account: &Account, remedies: &Remedies, step: &Step<'_>) -> String {
    if account.name == WALLS {
        return remedies.of_walls(step, -account.total());
    }
    if account.name == CONTACT_DAMPING {
        return "the motion that it drives is not real: elastic bodies that slide chatter, which `artificial_viscosity()` in their plugins or a larger `restitution` takes"
            .to_owned();
    }
    if account.name == SUPPORT_CHANGE {
        return "the motion that it drives is not real: more particles across the body need less hourglass control, or `support_follows: false` keeps spheres"
            .to_owned();
    }
    if account.name == SHIFTING_ENERGY
        && let Some(text) = Remedies::of_finer_bodies(step)
    {
        return text;
    }
    "the motion that it drives is not real: leave the plugin out, or take a smaller step or more particles"
        .to_owned()
}
