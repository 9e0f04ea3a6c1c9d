//! Sub-steps of stiff bodies within the long step of the rest.
//!
//! A long step of length dt takes k sub-steps. Forces between both sides are frozen in it; the systems that
//! compute them apply the difference to the next value as an impulse at the end of the long step, equal and
//! opposite on both sides.

use serde::{Deserialize, Serialize};

use super::{MIN_STEP, RunError, Simulation};
use crate::scene;
use crate::schedule::{Clock, Limit, Stage, TimeStepLimits};
use crate::world::PhaseId;

/// Sub-steps of some phases.
pub(super) struct SubSteps {
    /// Sub-cycled phases; none where all move by one clock.
    pub phases: Vec<PhaseId>,
    /// Largest number of sub-steps in a long one.
    largest: u32,
    /// Factor on the limits of sub-steps.
    factor: f64,
    /// Length of the long step, s, where it takes more than one.
    pub long: Option<f64>,
    /// State in a checkpoint.
    pub state: SubStepState,
}

/// The part that must survive a restart.
#[derive(Clone, Debug, Default, Serialize, Deserialize)]
pub(super) struct SubStepState {
    pub limits: TimeStepLimits,
    next: Option<Limit>,
    /// Sub-steps in the last long one.
    last: u32,
    /// Sub-steps since time 0.
    pub total: u64,
}

impl SubSteps {
    pub fn new(phases: Vec<PhaseId>, time: &scene::Time) -> Self {
        let factor = time.step.factor();
        Self { phases, largest: time.sub_steps.max(1), factor, long: None, state: SubStepState::default() }
    }

    /// Largest length of the next long step that needs no more short ones than there may be, s, and what
    /// limits it.
    pub fn limit(&self) -> Option<(f64, &Limit)> {
        let next = self.state.next.as_ref()?;
        Some((f64::from(self.largest) * next.dt, next))
    }

    /// Number of sub-steps in the rest of the long step, s.
    fn count(&self, rest: f64) -> f64 {
        match &self.state.next {
            Some(limit) if self.largest > 1 => (rest / (self.factor * limit.dt) - 1e-9).ceil().max(1.0),
            _ => 1.0,
        }
    }

    fn take_limit(&mut self) {
        let SubStepState { limits, next, .. } = &mut self.state;
        match (limits.take(), next) {
            (Some(limit), Some(next)) => next.clone_from(limit),
            (limit, next) => *next = limit.cloned(),
        }
    }
}

impl Simulation {
    /// Number of sub-steps in the last step, and since time 0; none where no body is sub-cycled.
    pub fn sub_steps(&self) -> Option<(u32, u64)> {
        let SubStepState { last, total, .. } = self.sub_steps.state;
        (!self.sub_steps.phases.is_empty()).then_some((last, total))
    }

    /// The limit of the sub-steps, where there are any.
    pub fn short_limit(&self) -> Option<&Limit> {
        self.sub_steps.state.next.as_ref()
    }

    /// Runs the sub-steps of the long one, which is that of the clock.
    pub(super) fn run_short_steps(&mut self) -> Result<(), RunError> {
        if self.sub_steps.phases.is_empty() {
            return Ok(());
        }
        let long = self.clock;
        let mut rest = long.dt;
        self.sub_steps.state.last = 0;
        loop {
            let count = self.sub_steps.count(rest);
            if count.is_nan() || count * MIN_STEP >= 1.0 {
                let limit = self.sub_steps.state.next.clone();
                let (dt, by) = limit.map_or((f64::NAN, String::new()), |limit| (limit.dt, limit.by));
                return Err(RunError::StepTooSmall { dt, by });
            }
            let dt = rest / count;
            let is_divided = count > 1.0 || self.sub_steps.state.last > 0;
            self.sub_steps.long = is_divided.then_some(long.dt);
            self.clock = Clock { time: long.time + (long.dt - rest), dt, step: long.step };
            self.run_short_stages(count <= 1.0, |stage| stage != Stage::Record)?;
            self.sub_steps.take_limit();
            self.sub_steps.state.last += 1;
            self.sub_steps.state.total += 1;
            rest -= dt;
            if count <= 1.0 {
                break;
            }
        }
        self.clock = long;
        Ok(())
    }

    /// Evaluates the short side at the start.
    pub(super) fn start_short_steps(&mut self) -> Result<(), RunError> {
        if !self.sub_steps.phases.is_empty() {
            self.run_short_stages(true, |stage| {
                stage.is_right_hand_side() || stage == Stage::FinalIntegrate
            })?;
            self.sub_steps.take_limit();
        }
        Ok(())
    }
}
