//! The time step: the smallest of all limits that systems propose, and which one it was.

use serde::{Deserialize, Serialize};

/// A limit of the time step.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Limit {
    /// Largest stable step, s.
    pub dt: f64,
    /// What limits it, such as `wave speed of plate`.
    pub by: String,
}

/// The limits proposed for the next step. The smallest one is kept; of equal ones the first.
#[derive(Debug, Default)]
pub struct TimeStepLimits {
    smallest: Option<Limit>,
}

impl TimeStepLimits {
    /// Proposes a limit, dt in s; `by` is asked for its text only if the limit is the smallest so far.
    pub fn propose(&mut self, dt: f64, by: impl FnOnce() -> String) {
        if self.smallest.as_ref().is_none_or(|limit| dt < limit.dt) {
            self.smallest = Some(Limit { dt, by: by() });
        }
    }

    /// Takes the smallest limit, and forgets all.
    pub fn take(&mut self) -> Option<Limit> {
        self.smallest.take()
    }
}
