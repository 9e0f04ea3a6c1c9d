//! Closed flows whose boundaries wear: whether the fluid can fill the place of what has been removed.
//!
//! Removed particles leave a closed vessel, and the mass of the fluid stays. Its pressure falls by its bulk
//! modulus times the share of its volume that is opened. Below zero it is under tension, voids open, and what
//! happens from there on depends on single particles. The pressure at the start has to be higher than that.

use serde::{Deserialize, Serialize};

use crate::formulations::fluid::cloud::{FlowCloud, FluidState, Group};
use crate::formulations::fluid::lanes::FlowParticle;
use crate::notation::quantity;
use crate::parallel::{BlockSum, sum_over_blocks};
use crate::schedule::{Step, StepError};
use crate::world::{ReferenceVolume, Removed};

/// Mean pressure over that which the removed volume costs, below which a fluid has lost its pressure by it.
const LOST: f64 = 0.1;

/// Watches the pressure of every fluid.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct LostVolume {
    /// Mean pressure of the fluids when it was first looked at, Pa.
    at_start: Vec<f64>,
    is_told: bool,
}

/// Volume of the particles, m3, and its product with their pressures, J.
#[derive(Clone, Copy, Debug, Default)]
struct PressureSum {
    volume: f64,
    energy: f64,
}

impl BlockSum for PressureSum {
    fn add(&mut self, next: &Self) {
        self.volume += next.volume;
        self.energy += next.energy;
    }
}

fn pressure_sum(cloud: &FlowCloud, group: &Group) -> PressureSum {
    sum_over_blocks(&cloud.records()[group.cloud.clone()], &|_, records: &[FlowParticle]| {
        let mut sum = PressureSum::default();
        for record in records {
            let volume = record.volume();
            sum.add(&PressureSum { volume, energy: volume * record.pressure() });
        }
        sum
    })
}

impl LostVolume {
    /// Compares the remaining pressure with the loss by the removed volume, in flows whose boundaries have
    /// suction.
    pub fn look(&mut self, cloud: &FlowCloud, step: &mut Step<'_>) -> Result<(), StepError> {
        if self.is_told || !cloud.is_confined() {
            return Ok(());
        }
        let fluids = || cloud.groups.iter().filter_map(|group| Some((group, group.fluid()?)));
        let sums: Vec<PressureSum> = fluids().map(|(group, _)| pressure_sum(cloud, group)).collect();
        if self.at_start.is_empty() {
            self.at_start = sums.iter().map(|sum| sum.energy / sum.volume).collect();
        }
        let opened = removed_volume(cloud, step)? / sums.iter().map(|sum| sum.volume).sum::<f64>();
        if opened == 0.0 {
            return Ok(());
        }
        for (((group, state), sum), at_start) in fluids().zip(&sums).zip(&self.at_start) {
            let cost = state.bulk_modulus() * opened;
            if *at_start < cost && sum.energy / sum.volume < LOST * cost {
                self.is_told = true;
                let text = text(group, state, opened, *at_start, step);
                step.warnings.push(text);
                break;
            }
        }
        Ok(())
    }
}

/// Volume of the boundary particles that have been removed, in the reference configuration, m3.
fn removed_volume(cloud: &FlowCloud, step: &Step<'_>) -> Result<f64, StepError> {
    let mut volume = 0.0;
    for group in cloud.groups.iter().filter(|group| group.fluid().is_none()) {
        let view = step.world.phase(group.phase);
        let (removed, reference) = (view.read::<Removed>()?, view.read::<ReferenceVolume>()?);
        let rows = (&removed[group.rows.clone()], &reference[group.rows.clone()]);
        volume += sum_over_blocks(rows, &|_, (removed, volume): (&[Removed], &[ReferenceVolume])| {
            let gone = removed.iter().zip(volume).filter(|(removed, _)| **removed != Removed::NO);
            gone.map(|(_, volume)| volume.0).sum::<f64>()
        });
    }
    Ok(volume)
}

/// The warning: the share of the volume that has been `opened`, and the pressure `at_start`, Pa.
fn text(group: &Group, state: &FluidState, opened: f64, at_start: f64, step: &Step<'_>) -> String {
    format!(
        "`{}` cannot fill the place of what has been removed: {:.1} % of its volume by {}, which costs {} of its pressure, with {} at the start; its mass stays, so that it is under tension, voids \
         open and the run depends on single particles from here on; start it with `Fluid(pressure: ...)` above {}, and more for what will still be removed",
        step.world.body(group.body).name,
        100.0 * opened,
        quantity(step.clock.time, "s"),
        quantity(opened * state.bulk_modulus(), "Pa"),
        quantity(at_start, "Pa"),
        quantity(opened * state.bulk_modulus(), "Pa"),
    )
}
