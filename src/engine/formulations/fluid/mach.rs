//! Mach number of a flow: whether the fluid still is as good as incompressible.

use super::cloud::FluidState;
use crate::schedule::{Step, StepError};

/// Speed of the flow over that of sound that is worth a warning: twice the one that a speed of sound is chosen for. The density then changes by 4 %.
const FAST: f64 = 0.2;
/// Growth of the largest Mach number for which the warning is written anew.
const GROWTH: f64 = 1.05;

/// The largest Mach number of a body that the user has been told.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Mach {
    pub told: f64,
}

impl Mach {
    /// Looks at the largest speed in a step, m/s; the warning keeps up with the largest one of the run.
    ///
    /// # Errors
    /// The flow is faster than its sound.
    pub fn look(
        &mut self,
        speed: f64,
        state: &FluidState,
        name: &str,
        step: &mut Step<'_>,
    ) -> Result<(), StepError> {
        let (sound, mach) = (state.sound_speed, speed / state.sound_speed);
        if mach <= FAST.max(GROWTH * self.told) {
            return Ok(());
        }
        if mach >= 1.0 {
            let message = format!(
                "the flow of `{name}` has reached {speed:.4} m/s at {:.6e} s, faster than its sound of {sound:.4} m/s: it no longer behaves as a liquid; \
                 give ten times the largest speed of the flow as `sound_speed` of its material",
                step.clock.time
            );
            return Err(StepError::System { system: "fluid_pressure".to_owned(), message });
        }
        let begin = format!("the flow of `{name}` has reached ");
        let text = format!(
            "{begin}a Mach number of {mach:.2}, {speed:.4} m/s with a speed of sound of {sound:.4} m/s: its density changes by {:.0} %, where it \
             should by 1 %; a `sound_speed` of some {:.3} m/s would be right, at smaller steps",
            100.0 * mach * mach,
            10.0 * speed
        );
        match step.warnings.iter_mut().find(|warning| warning.starts_with(&begin)) {
            Some(warning) => *warning = text,
            None => step.warnings.push(text),
        }
        self.told = mach;
        Ok(())
    }
}
