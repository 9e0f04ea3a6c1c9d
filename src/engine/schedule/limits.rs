//! The time step: the smallest of all limits that systems propose, and which one it was.

use serde::{Deserialize, Serialize};

/// A limit of the time step.
#[derive(Debug, PartialEq, Serialize, Deserialize)]
pub struct Limit {
    /// Largest stable step, s.
    pub dt: f64,
    /// What limits it, such as `wave speed of plate`.
    pub by: String,
}

impl Clone for Limit {
    fn clone(&self) -> Self {
        Self { dt: self.dt, by: self.by.clone() }
    }

    /// Keeps the memory of the text: every step takes one.
    fn clone_from(&mut self, source: &Self) {
        self.dt = source.dt;
        self.by.clone_from(&source.by);
    }
}

/// Least number of steps for which a limit is kept.
const MEMORY: u32 = 500;

/// The limits proposed for the next step. The smallest one is kept; of equal ones the first.
///
/// The step falls at once, but it does not grow before the limit that made it small is `MEMORY` to twice `MEMORY` steps old. The
/// leapfrog conserves energy over long times only with a constant step; one that follows every oscillation of the
/// limits in its rhythm feeds the oscillation.
#[derive(Clone, Debug, Default, Serialize, Deserialize)]
pub struct TimeStepLimits {
    proposed: Option<Limit>,
    /// Smallest limit of the last `age` steps.
    recent: Option<Limit>,
    /// Smallest limit of the `MEMORY` steps before those.
    older: Option<Limit>,
    age: u32,
}

impl TimeStepLimits {
    /// Proposes a limit, dt in s; `by` is asked for its text only where the limit is the smallest so far and smaller
    /// than those not long ago, so that most steps need no text.
    pub fn propose(&mut self, dt: f64, by: impl FnOnce() -> String) {
        if self.proposed.as_ref().is_some_and(|limit| limit.dt <= dt) {
            return;
        }
        let kept = self.recent.as_ref().is_some_and(|recent| recent.dt <= dt) && self.age < MEMORY;
        let by = if kept { String::new() } else { by() };
        self.proposed = Some(Limit { dt, by });
    }

    /// The smallest limit of this step and of those not long ago; none if nothing has been proposed for this step. What
    /// has been proposed is taken.
    pub fn take(&mut self) -> Option<&Limit> {
        let proposed = self.proposed.take()?;
        if self.age == MEMORY {
            self.older = self.recent.take();
            self.age = 0;
        }
        self.age += 1;
        if self.recent.as_ref().is_none_or(|limit| limit.dt > proposed.dt) {
            self.recent = Some(proposed);
        }
        match (&self.older, &self.recent) {
            (Some(older), Some(recent)) if older.dt < recent.dt => Some(older),
            (_, recent) => recent.as_ref(),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn steps(limits: &mut TimeStepLimits, dt: f64, count: u32) -> f64 {
        let mut last = 0.0;
        for _ in 0..count {
            limits.propose(2.0 * dt, || "other".into());
            limits.propose(dt, || "smaller".into());
            last = limits.take().map_or(f64::NAN, |limit| limit.dt);
        }
        last
    }

    #[test]
    fn the_step_falls_at_once_and_grows_late() {
        let mut limits = TimeStepLimits::default();
        assert!(limits.take().is_none());
        assert_eq!(steps(&mut limits, 1.0, 3), 1.0);
        assert_eq!(steps(&mut limits, 0.5, 1), 0.5);
        assert_eq!(steps(&mut limits, 1.0, MEMORY), 0.5);
        assert_eq!(steps(&mut limits, 1.0, MEMORY), 1.0);
    }

    #[test]
    fn a_limit_that_swings_faster_than_the_memory_gives_a_constant_step() {
        let mut limits = TimeStepLimits::default();
        steps(&mut limits, 0.5, 1);
        for k in 0..5000 {
            let swing = if k % 100 < 50 { 1.0 } else { 0.5 };
            assert_eq!(steps(&mut limits, swing, 1), 0.5);
        }
    }
}
