//! The plastic increment of a step: where the equivalent stress of the radial return meets the flow stress.

use super::hardening::Hardening;
use super::value_and_slope::ValueAndSlope;

/// Trial state of a return mapping.
#[derive(Clone, Copy, Debug)]
pub struct Trial {
    /// Equivalent stress if the step were elastic, Pa; above the static flow stress.
    pub stress: f64,
    /// Shear modulus mu, Pa.
    pub shear: f64,
    /// Plastic strain before the step.
    pub strain: f64,
    /// Temperature, K.
    pub temperature: f64,
    /// Length of the step, s, above zero.
    pub dt: f64,
}

/// Share of the trial stress to which the return is solved.
const ACCURACY: f64 = 1e-12;
/// Share of an increment that is too large that is tried next, as long as none has been too small.
const STRIDE: f64 = 1e-4;

impl Trial {
    /// The increment d of the plastic strain with `stress - 3 mu d = flow stress after d`.
    ///
    /// The difference falls with d, is positive at 0 and not positive where the stress is gone: Newton's
    /// iteration keeps to that bracket and halves it where it would leave it, so that it ends for every law
    /// that does not soften with strain. A law that hardens by a small power of the strain is so steep at its
    /// beginning that d can be of any size: it is looked for downwards in large strides, and upwards from
    /// there, where the iteration does not pass it. Input that is not a number gives NaN, which the watchdog
    /// sees.
    pub fn increment(&self, hardening: &Hardening) -> f64 {
        let stiffness = 3.0 * self.shear;
        match *hardening {
            Hardening::Perfect { yield_stress } => return (self.stress - yield_stress) / stiffness,
            Hardening::Linear { yield_stress, modulus } => {
                let flow = yield_stress + modulus * self.strain;
                return (self.stress - flow) / (stiffness + modulus);
            }
            _ => {}
        }
        let (mut low, mut high) = (0.0, self.stress / stiffness);
        if !high.is_finite() {
            return f64::NAN;
        }
        let start = hardening.static_stress(self.strain, self.temperature);
        let mut d = ((self.stress - start) / stiffness).clamp(low, high);
        // Newton's iteration usually ends after four, halving alone after 60.
        for k in 0..160 {
            let ValueAndSlope { value: flow, slope } =
                hardening.flow_stress(self.strain, d, self.dt, self.temperature);
            let rest = self.stress - stiffness * d - flow;
            if rest.is_nan() {
                return f64::NAN;
            }
            if rest.abs() <= ACCURACY * self.stress {
                return d;
            }
            if rest > 0.0 {
                low = d;
            } else {
                high = d;
            }
            let newton = d + rest / (stiffness + slope);
            let newton_helps = k < 80 && newton > low && newton < high;
            let next = match newton_helps {
                true => newton,
                false if low == 0.0 => STRIDE * d,
                false => 0.5 * (low + high),
            };
            if next == d {
                return d;
            }
            d = next;
        }
        f64::NAN
    }
}
