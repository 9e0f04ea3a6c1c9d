//! Warning of compressed flows: pressure that changes the density by more than the few per cent that are
//! acceptable in a liquid.
//!
//! The Mach number covers flows whose pressure is that of their inertia, rho v^2. Friction and loads cause
//! pressures of mu v / L and rho b L, however slow the flow is: in a journal bearing, a packed bed, a deep
//! tank. So the criterion is the standard deviation of the compression p / (rho_0 c_0^2) over a body. A
//! constant added to the pressure changes nothing, and an impact passes: it has to last for some frames.
//! In flows in which friction has dissipated more than the kinetic energy, the deviation weighted with the
//! power of friction counts too: a ball in a long tube compresses the liquid around it alone.

use serde::{Deserialize, Serialize};

use super::friction::{FrictionOf, FrictionOfParticle};
use crate::formulations::fluid::cloud::{FlowCloud, FluidState, Group, RowSums};
use crate::formulations::fluid::lanes::FlowParticle;
use crate::notation::quantity;
use crate::parallel::{BlockSum, sum_over_blocks};
use crate::schedule::{Step, replace_warning};

/// Standard deviation of the compression that is worth a warning: pressures that differ by a thirtieth to a
/// tenth of rho_0 c_0^2.
const DEVIATION: f64 = 0.02;
/// Frames in sequence for which it has to last.
const FRAMES: u32 = 3;
/// Growth of the deviation for which the warning is renewed.
const GROWTH: f64 = 1.2;
/// Standard deviation of a flow as one would have it.
const USUAL: f64 = 0.003;

/// Watches the compression of every body.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct CompressionWatch {
    bodies: Vec<ReportedDeviation>,
}

/// Deviation reported for a body.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
struct ReportedDeviation {
    /// Frames in sequence with a large deviation.
    frames: u32,
    /// The largest deviation reported to the user.
    deviation: f64,
}

/// Sums of weights, and of the compression and its square times the weights.
#[derive(Clone, Copy, Debug, Default)]
struct CompressionSums([f64; 3]);

impl BlockSum for CompressionSums {
    fn add(&mut self, next: &Self) {
        (0..3).for_each(|k| self.0[k] += next.0[k]);
    }
}

impl CompressionWatch {
    /// Checks all fluids.
    pub fn look(
        &mut self,
        cloud: &FlowCloud,
        scratch: &mut Vec<Option<FrictionOfParticle>>,
        step: &mut Step<'_>,
    ) {
        self.bodies.resize(cloud.groups.len(), ReportedDeviation::default());
        let is_slow =
            cloud.viscosities.is_viscous && step.ledger.total_named("viscosity") > step.ledger.motion();
        for (group, told) in cloud.groups.iter().zip(&mut self.bodies) {
            let Some(state) = group.fluid() else { break };
            let records = &cloud.records[group.cloud.clone()];
            let mut deviation = deviation(records, state.bulk_modulus(), |_| 1.0);
            if is_slow {
                scratch.clear();
                scratch.resize(records.len(), None);
                let pass = FrictionOf::new(cloud, group);
                cloud.for_each_row(group.cloud.start, scratch, &mut RowSums::default(), &pass);
                let power = |k: usize| scratch[k].map_or(0.0, |row| row.power);
                deviation = deviation.max(self::deviation(records, state.bulk_modulus(), power));
            }
            told.frames = if deviation > DEVIATION { told.frames + 1 } else { 0 };
            if told.frames < FRAMES || deviation < GROWTH * told.deviation {
                continue;
            }
            told.deviation = deviation;
            let (begin, text) = text(group, state, deviation, step);
            replace_warning(step.warnings, &begin, text);
        }
    }
}

/// The weighted standard deviation of p over that modulus.
fn deviation(records: &[FlowParticle], modulus: f64, weight: impl Fn(usize) -> f64 + Sync) -> f64 {
    let CompressionSums([all, sum, squares]) =
        sum_over_blocks(records, &|first, records: &[FlowParticle]| {
            let mut sums = CompressionSums::default();
            for (k, record) in records.iter().enumerate().filter(|(_, record)| record.volume() > 0.0) {
                let (compression, weight) = (record.pressure() / modulus, weight(first + k));
                sums.add(&CompressionSums([1.0, compression, compression * compression].map(|x| weight * x)));
            }
            sums
        });
    if all <= 0.0 {
        return 0.0;
    }
    let mean = sum / all;
    (squares / all - mean * mean).max(0.0).sqrt()
}

fn text(group: &Group, state: &FluidState, deviation: f64, step: &Step<'_>) -> (String, String) {
    let begin = format!("`{}` is compressed unevenly: ", step.world.body(group.body).name);
    let text = format!(
        "{begin}its density varies by {:.0} % (standard deviation) at {}, where that of a liquid hardly changes; pressures of {} need a larger `sound_speed` of its material, \
         some {} in the place of {}, at smaller steps",
        100.0 * deviation,
        quantity(step.clock.time, "s"),
        quantity(deviation * state.bulk_modulus(), "Pa"),
        quantity(state.sound_speed * (deviation / USUAL).sqrt(), "m/s"),
        quantity(state.sound_speed, "m/s"),
    );
    (begin, text)
}
