//! Warning of slow flows that end before their pressure has spread.
//!
//! In a gap of thickness h the pressure of a slow flow spreads by diffusion, with c^2 h^2 / (12 nu). Until it
//! has crossed the gap, a body that should push the liquid past itself or ahead of it compresses it instead,
//! and moves too easily, however small the Mach number and the changes of density are. Part of the work on
//! the flow is then stored as energy of compression, as much as a third of what friction dissipates, and
//! nothing once pressure has spread. So the criterion is the change of that energy in the second half of the
//! run over the dissipation in the same time.

use glam::DVec3;
use serde::{Deserialize, Serialize};

use super::closed::named;
use crate::formulations::fluid::cloud::{ACCOUNTS, FlowCloud};
use crate::formulations::fluid::density::open_gravity;
use crate::formulations::fluid::lanes::FlowParticle;
use crate::notation::quantity;
use crate::parallel::{BlockSum, sum_over_blocks};
use crate::plugin::SimBuilder;
use crate::schedule::{Account, AccountKind, Step};

/// Energy stored over energy dissipated that is worth a warning.
const SHARE: f64 = 0.1;
/// The same energy over that of the pressure at rest below which it is the error of the latter.
const OF_REST: f64 = 0.01;

/// Watches the energy of the pressure that drives a flow.
pub struct Spreading {
    /// Gravity along the axes on which it causes a pressure at rest, m/s2.
    gravity: DVec3,
    /// End of the run, s.
    end: f64,
    pub seen: Seen,
}

/// What the watch has seen so far.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Seen {
    is_told: bool,
    middle: Option<Middle>,
}

/// Energies in the middle of a run, J, and its time, s.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
struct Middle {
    time: f64,
    stored: f64,
    /// By friction, and by all.
    dissipated: f64,
    all: f64,
}

impl Spreading {
    /// The watch of a scene.
    pub fn new(sim: &SimBuilder<'_>) -> Self {
        Self { gravity: open_gravity(sim), end: sim.scene().time.end, seen: Seen::default() }
    }

    /// Notes the energies in the middle of a run, and compares those at its end with them.
    pub fn look(&mut self, is_end: bool, cloud: &FlowCloud, step: &mut Step<'_>) {
        let time = step.clock.time;
        let is_middle = self.seen.middle.is_none() && time >= 0.5 * self.end;
        if !cloud.viscosities.is_viscous
            || self.seen.is_told
            || !(is_middle || is_end)
            || !cloud.loads.is_empty()
        {
            return;
        }
        let (driving, whole) = stored(cloud, self.gravity);
        let dissipated = step.ledger.total_named(ACCOUNTS[0]);
        let of_kind = |account: &&Account| account.kind == AccountKind::Dissipated;
        let ledger = &step.ledger;
        let all =
            ledger.accounts().iter().filter(of_kind).map(|one| ledger.total_named(&one.name)).sum::<f64>();
        if is_middle && !is_end {
            self.seen.middle = Some(Middle { time, stored: driving, dissipated, all });
            return;
        }
        // A run that ends before its middle has nothing to compare with.
        let Some(since) = self.seen.middle else { return };
        let (grown, lost) = (driving - since.stored, dissipated - since.dissipated);
        // Where stabilizers take more than friction, or much is in motion, the flow is not slow.
        let is_loud = lost <= step.ledger.motion() || lost <= 0.5 * (all - since.all);
        if grown.abs() <= SHARE * lost || is_loud || grown.abs() <= OF_REST * whole {
            return;
        }
        self.seen.is_told = true;
        step.warnings.push(format!(
            "the pressure of {} has not spread by {}: from {} on its compression has {} {}, {:.0} % of the {} that friction has dissipated; slow flows between walls a distance h apart spread it by diffusion, with c^2 h^2 / (12 nu), \
             and until it has spread, bodies and pistons compress the liquid in the place of pushing it along, and are too fast (a disc in a closed channel 1.07 times where this share was 20 %, 3 times where it was 28 %); take a larger `sound_speed` or a later end",
            named(cloud, step),
            quantity(time, "s"),
            quantity(since.time, "s"),
            if grown > 0.0 { "taken up" } else { "given back" },
            quantity(grown.abs(), "J"),
            100.0 * grown.abs() / lost,
            quantity(lost, "J"),
        ));
    }
}

/// Sums of volumes, and of the pressure, that without its part at rest, and their squares, times the volumes.
#[derive(Clone, Copy, Debug, Default)]
struct PressureSums([f64; 5]);

impl BlockSum for PressureSums {
    fn add(&mut self, next: &Self) {
        (0..5).for_each(|k| self.0[k] += next.0[k]);
    }
}

/// Energy of compression by the pressure that differs from that at rest, and by all that varies, J. A
/// pressure that is the same everywhere drives no flow.
fn stored(cloud: &FlowCloud, gravity: DVec3) -> (f64, f64) {
    let factor = cloud.pressure_factor;
    cloud.groups.iter().map_while(|group| Some((group, group.fluid()?))).fold(
        (0.0, 0.0),
        |all, (group, state)| {
            let records = &cloud.records[group.cloud.clone()];
            let PressureSums([volume, p, q, pp, qq]) =
                sum_over_blocks(records, &|_, records: &[FlowParticle]| {
                    let mut sums = PressureSums::default();
                    for record in records.iter().filter(|record| record.volume() > 0.0) {
                        let p = record.pressure() / factor;
                        let q = p - state.density * gravity.dot(record.position());
                        sums.add(&PressureSums([1.0, p, q, p * p, q * q].map(|x| record.volume() * x)));
                    }
                    sums
                });
            let energy = |sum: f64, squares: f64| match volume > 0.0 {
                true => (squares - sum * sum / volume).max(0.0) / (2.0 * state.bulk_modulus()),
                false => 0.0,
            };
            (all.0 + energy(q, qq), all.1 + energy(p, pp))
        },
    )
}
