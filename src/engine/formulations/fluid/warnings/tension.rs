//! Warning of fluids under tension that nothing damps: their particles pair, and the fluid falls apart.

use serde::{Deserialize, Serialize};

use super::closed::is_closed;
use crate::formulations::fluid::cloud::{FlowCloud, Group, is_viscous};
use crate::formulations::fluid::lanes::FlowParticle;
use crate::notation::quantity;
use crate::parallel::{BlockSum, sum_over_blocks};
use crate::plugin::SimBuilder;
use crate::schedule::Step;

/// Pressure below zero over the largest magnitude of the pressure in the same fluid that counts as tension.
const TENSION: f64 = 0.1;
/// And over the weight of a row of particles: the pressure of a fluid in a container that falls freely is
/// zero, but for noise of up to two fifths of that weight, which pairs nothing.
const OF_A_ROW: f64 = 0.5;
/// Share of the particles in tension that is worth a warning.
const SHARE: f64 = 0.25;
/// Frames in sequence for which it has to last: sound passes, an acceleration does not. Between boundaries
/// with suction they need not be in sequence: nothing relieves a fluid that oscillates about zero pressure.
const FRAMES: u32 = 3;
/// The plugin that damps the noise.
const REMEDY: &str = "artificial_viscosity";

/// Watches the pressure of every fluid that is not viscous; `Unevenness` watches the particles of the others.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct TensionWatch {
    /// Frames for which each group was in tension; none for those that are not watched.
    frames: Vec<Option<u32>>,
    /// Magnitude of the pressure below zero that counts at least, of each group, Pa.
    least: Vec<f64>,
}

/// Tension in a fluid.
#[derive(Clone, Copy, Debug)]
pub struct Tension {
    /// Number of its particles, and of those in tension.
    counts: [usize; 2],
    /// Minimum pressure, zero at most, Pa.
    pub minimum: f64,
}

#[derive(Clone, Copy, Debug, Default)]
struct Counts([usize; 2]);

impl BlockSum for Counts {
    fn add(&mut self, next: &Self) {
        (0..2).for_each(|k| self.0[k] += next.0[k]);
    }
}

impl Tension {
    /// That of the particles of one fluid, where the pressure is below zero by more than `least`, Pa.
    pub fn of(records: &[FlowParticle], least: f64) -> Self {
        let pressures = || records.iter().filter(|row| row.volume() > 0.0).map(FlowParticle::pressure);
        let largest = pressures().map(f64::abs).fold(0.0, f64::max);
        let limit = least.max(TENSION * largest);
        let Counts(counts) = sum_over_blocks(records, &|_, records: &[FlowParticle]| {
            let there = || records.iter().filter(|record| record.volume() > 0.0);
            let is_tense = |record: &&FlowParticle| record.pressure() < -limit;
            Counts([there().count(), there().filter(is_tense).count()])
        });
        Self { counts, minimum: pressures().fold(0.0, f64::min) }
    }

    /// Share of the particles that are in tension.
    pub fn share(&self) -> f64 {
        let [all, tense] = self.counts.map(|count| count as f64);
        if all > 0.0 { tense / all } else { 0.0 }
    }
}

impl TensionWatch {
    /// A watch over the fluids of `groups` without the plugin.
    pub fn new(groups: &[Group], sim: &SimBuilder<'_>) -> Self {
        let is_damped = |group: &Group| sim.scene().has_plugin(group.body.0, REMEDY);
        let watched = |group: &Group| group.fluid().is_some() && !is_damped(group);
        let least = |group: &Group| {
            let density = group.fluid().map_or(0.0, |fluid| fluid.density);
            OF_A_ROW * density * sim.gravity().length() * sim.body(group.body).spacing
        };
        Self {
            frames: groups.iter().map(|group| watched(group).then_some(0)).collect(),
            least: groups.iter().map(least).collect(),
        }
    }

    /// Checks all fluids.
    pub fn look(&mut self, cloud: &FlowCloud, scratch: &mut Vec<Option<f64>>, step: &mut Step<'_>) {
        let h = cloud.kernel.smoothing_length();
        for ((group, frames), least) in cloud.groups.iter().zip(&mut self.frames).zip(&self.least) {
            let Some(count) = frames else { continue };
            if group.fluid().is_some_and(|fluid| is_viscous(fluid, h)) {
                continue;
            }
            let tension = Tension::of(&cloud.records()[group.cloud.clone()], *least);
            if tension.share() > SHARE {
                *count += 1;
            } else if *count > 0 && !(cloud.is_confined() && is_closed(cloud, scratch)) {
                *count = 0;
            }
            if *count < FRAMES {
                continue;
            }
            *frames = None;
            step.warnings.push(format!(
                "`{}` has been in tension since about {}, {:.0} % of it, down to {}, and has hardly any friction: its particles pair, and it falls apart; give it \
                 `plugins: [density_diffusion(), particle_shifting(), {REMEDY}(alpha: 0.02, beta: 0.0)]`, or, in a closed flow, a pressure at the start that keeps it above zero, `Fluid(pressure: ...)`",
                step.world.body(group.body).name,
                quantity(step.clock.time, "s"),
                100.0 * tension.share(),
                quantity(tension.minimum, "Pa"),
            ));
        }
    }
}
