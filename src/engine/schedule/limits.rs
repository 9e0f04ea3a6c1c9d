//! The time step: the smallest of all limits that systems propose, and the name of that limit.

use std::fmt::{Display, Write as _};

use serde::{Deserialize, Serialize};

/// A limit of the time step.
#[derive(Debug, PartialEq, Serialize, Deserialize)]
pub struct Limit {
    /// Largest stable step, s.
    pub dt: f64,
    /// Name of the limit, such as `wave speed of plate`.
    pub by: String,
}

/// Bytes of a text with memory from the start.
const TEXT: usize = 128;

impl Clone for Limit {
    fn clone(&self) -> Self {
        let mut by = String::with_capacity(TEXT);
        by.push_str(&self.by);
        Self { dt: self.dt, by }
    }

    /// Keeps the memory of the text: every step takes one.
    fn clone_from(&mut self, source: &Self) {
        self.dt = source.dt;
        self.by.clone_from(&source.by);
    }
}

impl Default for Limit {
    /// No limit.
    fn default() -> Self {
        Self { dt: f64::INFINITY, by: String::with_capacity(TEXT) }
    }
}

/// Minimum number of steps for which a limit is kept.
const MEMORY: u32 = 500;

/// The limits proposed for the next step. The smallest one is kept; of equal ones the first.
///
/// The step falls at once, but it does not grow before the limit that made it small is `MEMORY` to twice
/// `MEMORY` steps old. The leapfrog conserves energy over long times only with a constant step; one that
/// follows every oscillation of the limits in its rhythm feeds the oscillation.
///
/// The three limits are infinite where there is none, so that their texts stay in one place of memory.
#[derive(Clone, Debug, Default, Serialize, Deserialize)]
pub struct TimeStepLimits {
    /// Whether there is a proposal, possibly an infinite one: a body that has failed entirely has no limit.
    any: bool,
    proposed: Limit,
    /// Smallest limit of the last `age` steps.
    recent: Limit,
    /// Smallest limit of the `MEMORY` steps before those.
    older: Limit,
    age: u32,
}

impl TimeStepLimits {
    /// Proposes a limit, dt in s; the text of `by`, such as [`format_args!`] gives, is written only where the
    /// limit is the smallest so far and smaller than those not long ago.
    pub fn propose(&mut self, dt: f64, by: impl Display) {
        if self.has_below(dt) {
            return;
        }
        self.any = true;
        let kept = self.recent.dt <= dt && self.age < MEMORY;
        self.proposed.dt = dt;
        self.proposed.by.clear();
        if !kept {
            let _ = write!(self.proposed.by, "{by}");
        }
    }

    /// Whether a limit for this step is at most that, dt in s: proposing it would change nothing.
    #[inline]
    pub fn has_below(&self, dt: f64) -> bool {
        self.any && self.proposed.dt <= dt
    }

    /// The smallest limit of this step and of recent ones; none if nothing has been proposed for this step.
    /// The proposals are consumed.
    pub fn take(&mut self) -> Option<&Limit> {
        if !std::mem::take(&mut self.any) {
            return None;
        }
        if self.age == MEMORY {
            std::mem::swap(&mut self.older, &mut self.recent);
            self.recent.dt = f64::INFINITY;
            self.age = 0;
        }
        self.age += 1;
        if self.recent.dt > self.proposed.dt || self.recent.dt == f64::INFINITY {
            std::mem::swap(&mut self.recent, &mut self.proposed);
        }
        Some(if self.older.dt < self.recent.dt { &self.older } else { &self.recent })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn steps(limits: &mut TimeStepLimits, dt: f64, count: u32) -> f64 {
        let mut last = 0.0;
        for _ in 0..count {
            limits.propose(2.0 * dt, "other");
            limits.propose(dt, "smaller");
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
