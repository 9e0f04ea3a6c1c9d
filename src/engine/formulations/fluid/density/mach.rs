//! Mach number of a flow: whether the fluid still is as good as incompressible.
//!
//! A tank that moves as a whole with its fluid compresses nothing. The speed that counts is that against the frame in which the fastest of
//! all that flows and bounds a flow is slowest: at rest, or with one of the bodies that bound the flow, or, where nothing bounds it, with the mean of what flows.

use glam::DVec3;

use crate::formulations::fluid::cloud::{FluidState, Group};
use crate::formulations::fluid::lanes::FlowParticle;
use crate::notation::quantity;
use crate::schedule::{Step, StepError, warn_anew};

/// Speed of the flow over that of sound that is worth a warning: twice the one that a speed of sound is chosen for. The density then changes by 4 %.
const FAST: f64 = 0.2;
/// Growth of the largest Mach number for which the warning is written anew.
const GROWTH: f64 = 1.05;

/// Largest speed in a frame that moves, over that at rest, for which the frame is taken.
const SLOWER: f64 = 0.9;

/// Largest speed of a fluid against the frame of its flow, m/s; `at_rest` is the one against rest. At the speeds of fluids that are no warning
/// nothing is looked for.
pub fn relative_speed(at_rest: f64, group: &Group, groups: &[Group], records: &[FlowParticle]) -> f64 {
    if group.fluid().is_none_or(|state| at_rest <= FAST * state.sound_speed) {
        return at_rest;
    }
    let rows = |group: &Group| records[group.cloud.clone()].iter().filter(|record| record.volume() > 0.0);
    let fastest = |group: &Group, frame: DVec3| {
        rows(group).map(|record| record.velocity().distance_squared(frame)).fold(0.0, f64::max).sqrt()
    };
    let bounds = || groups.iter().filter(|group| group.fluid().is_none());
    let mean = |groups: &[Group]| {
        let sum: DVec3 = groups.iter().flat_map(rows).map(FlowParticle::velocity).sum();
        sum / groups.iter().flat_map(rows).count().max(1) as f64
    };
    let of_bounds = bounds().map(|group| mean(std::slice::from_ref(group)));
    let of_all = bounds().next().is_none().then(|| mean(groups));
    let in_frame = |frame| groups.iter().map(|group| fastest(group, frame)).fold(0.0, f64::max);
    let mut least = in_frame(DVec3::ZERO);
    let mut speed = at_rest;
    // A frame that is slow beside the flow is as good as rest.
    for frame in of_bounds.chain(of_all).filter(|frame| frame.length() > (1.0 - SLOWER) * at_rest) {
        let largest = in_frame(frame);
        if largest < SLOWER * least {
            (least, speed) = (largest, fastest(group, frame).min(at_rest));
        }
    }
    speed
}

/// The largest Mach number of a body that the user has been told.
#[derive(Clone, Copy, Debug, Default)]
pub struct Mach {
    pub told: f64,
}

impl Mach {
    /// Looks at the largest [`relative_speed`] in a step, m/s; the warning keeps up with the largest one of the run.
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
                "the flow of `{name}` has reached {speed:.4} m/s at {}, faster than its sound of {sound:.4} m/s: it no longer behaves as a liquid; \
                 give ten times the largest speed of the flow as `sound_speed` of its material",
                quantity(step.clock.time, "s")
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
        warn_anew(step.warnings, &begin, text);
        self.told = mach;
        Ok(())
    }
}
