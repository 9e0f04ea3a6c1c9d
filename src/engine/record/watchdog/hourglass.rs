//! Too much hourglass energy: the control carries load in place of the stress, and the result is too stiff;
//! or its viscous part takes the energy that should deform the body.

use serde::{Deserialize, Serialize};

use super::energy_growth::resolution;
use crate::notation::quantity;
use crate::plugin::{BodyPlan, SimBuilder};
use crate::schedule::{Account, Ledger, Step};
use crate::world::BodyId;

/// Hourglass energy over strain energy plus plastic work that is worth a warning. In a beam of n particles
/// across, the control holds the bending energy that the mean gradients miss, some 9/n^2 of the strain
/// energy: 14 % at eight across, where the stiffness is right to 1 %, and half of it at four (3 %). Cook's
/// membrane at rest has 33, 8 and 4 % at 8, 16 and 32 across and is 7, 2 and .5 % off; thick rings and
/// spheres at eight across the wall have 1 to 3 %, Taylor bars 3 to 8 %.
const SHARE: f64 = 0.2;

/// Hourglass energy, over the largest energy of any other kind that the body has had, below which its share
/// says nothing: at the start of a run all that a body has may be kinetic.
const MIN_ENERGY: f64 = 0.02;

/// Largest strain energy plus plastic work of a body per volume, over that of any body of the scene, below
/// which its share says nothing: no wave has reached the body yet, and what it has comes before the front.
const REACHED: f64 = 1e-4;

/// Watches the hourglass energy of every body.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub(super) struct HourglassShare {
    /// Largest strain energy plus plastic work of each body so far, J: a body that swings through its rest
    /// shape is no reason to warn.
    largest_internal: Vec<f64>,
    /// Largest energy of any other account of each body so far, J.
    largest: Vec<f64>,
    /// Volume of each body, m3.
    volumes: Vec<f64>,
    /// Energy of each body below which all is round-off, J.
    resolution: Vec<f64>,
    /// Largest hourglass energy of each body after the first load, J, and when it was, s.
    most: Vec<(f64, f64)>,
}

impl HourglassShare {
    /// Over the volumes and moduli of the bodies.
    pub fn new(sim: &SimBuilder<'_>) -> Self {
        Self {
            volumes: sim.bodies().iter().map(BodyPlan::volume).collect(),
            resolution: sim.bodies().iter().map(resolution).collect(),
            ..Self::default()
        }
    }

    /// Takes in a step.
    pub fn look(&mut self, ledger: &Ledger, bodies: usize) {
        self.largest_internal.resize(bodies, 0.0);
        self.largest.resize(bodies, 0.0);
        self.most.resize(bodies, (0.0, 0.0));
        for (k, largest) in self.largest_internal.iter_mut().enumerate() {
            *largest = largest.max(energy(ledger, "strain", k) + energy(ledger, "plastic_work", k));
        }
        for (k, largest) in self.largest.iter_mut().enumerate() {
            let others = ledger.accounts().iter().filter(|account| account.name != "hourglass");
            let of = |account: &Account| account.of(BodyId(k)) - ledger.drift_of(account, BodyId(k));
            let energies = others.map(|account| of(account).abs());
            *largest = energies.fold(*largest, f64::max);
        }
    }

    /// Takes in the hourglass energies of a step that is judged.
    pub fn judge(&mut self, ledger: &Ledger, time: f64) {
        for (k, most) in self.most.iter_mut().enumerate() {
            let hourglass = energy(ledger, "hourglass", k);
            if hourglass > most.0 {
                *most = (hourglass, time);
            }
        }
    }

    /// Warns of every body whose share has been too large. What it is a share of is only known at the end: of
    /// a small load that comes first the control carries more than of the large one that follows.
    pub fn warn(&self, step: &mut Step<'_>) {
        let per_volume =
            self.largest_internal.iter().zip(&self.volumes).map(|(energy, volume)| energy / volume);
        let densest = per_volume.fold(0.0, f64::max);
        for (k, body) in step.world.bodies().iter().enumerate() {
            let internal = self.largest_internal[k];
            if internal <= 0.0 || internal <= REACHED * densest * self.volumes[k] {
                continue;
            }
            let least = self.resolution[k].max(MIN_ENERGY * self.largest[k]);
            let is_large = |energy: f64| energy > least.max(SHARE * internal);
            let (name, percent) = (&body.name, |energy: f64| 100.0 * energy / internal);
            let (hourglass, time) = self.most[k];
            if is_large(hourglass) {
                step.warnings.push(format!(
                    "the hourglass energy of body `{name}` is {:.0} % of its largest strain energy plus plastic work, at \
                     {}: more particles across the body or a smaller coefficient of the hourglass control would help",
                    percent(hourglass),
                    quantity(time, "s")
                ));
            }
            let viscous = energy(step.ledger, "hourglass_viscosity", k);
            if is_large(viscous) {
                step.warnings.push(format!(
                    "the viscous part of the hourglass control of body `{name}` has taken {:.0} % of its largest strain energy \
                     plus plastic work, which it deforms the less by: more particles across the body, or a smaller `chi` or \
                     `zeta`, would help",
                    percent(viscous)
                ));
            }
        }
    }
}

fn energy(ledger: &Ledger, account: &str, body: usize) -> f64 {
    let found = ledger.accounts().iter().find(|known| known.name == account);
    found.map_or(0.0, |account| account.of(BodyId(body)))
}
