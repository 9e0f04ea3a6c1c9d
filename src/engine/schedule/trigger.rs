//! When something is due.

use serde::{Deserialize, Serialize};

/// Falls due at the times 0, T, 2T, ... and is seen at the first step end at or after each.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Trigger {
    interval: f64,
    next: u64,
}

/// Share of the interval by which a step end may fall short of a due time: the rounding of a sum of steps.
const TOLERANCE: f64 = 1e-6;

impl Trigger {
    /// Due at 0 for the first time, then every `interval`, s.
    pub fn new(interval: f64) -> Self {
        Self { interval, next: 0 }
    }

    /// Due after one `interval`, s, for the first time.
    pub fn after_interval(interval: f64) -> Self {
        Self { interval, next: 1 }
    }

    /// Continues from the state in a checkpoint, unless the interval has changed.
    pub fn resume(&mut self, saved: Trigger) {
        if saved.interval == self.interval {
            *self = saved;
        }
    }

    /// Whether a due time has been reached since it was asked last; several at once count as one.
    pub fn is_due(&mut self, time: f64) -> bool {
        let reached = time / self.interval + TOLERANCE;
        if reached < self.next as f64 {
            return false;
        }
        self.next = reached as u64 + 1;
        true
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn it_is_due_at_the_first_step_end_at_or_after_each_due_time() {
        let mut trigger = Trigger::new(0.1);
        let mut late = Trigger::after_interval(0.1);
        let mut seen = Vec::new();
        let mut seen_late = Vec::new();
        for k in 0..=10 {
            let time = 0.04 * f64::from(k);
            if trigger.is_due(time) {
                seen.push(k);
            }
            if late.is_due(time) {
                seen_late.push(k);
            }
        }
        assert_eq!(seen, [0, 3, 5, 8, 10]);
        assert_eq!(seen_late, [3, 5, 8, 10]);
    }

    #[test]
    fn a_step_end_that_rounding_leaves_just_below_is_not_missed() {
        let mut trigger = Trigger::after_interval(0.3);
        assert!(!trigger.is_due(0.2));
        assert!(trigger.is_due(0.1 + 0.1 + 0.1 - 1e-16) && !trigger.is_due(0.3));
    }

    #[test]
    fn due_times_that_one_step_passes_count_once() {
        let mut trigger = Trigger::new(0.1);
        assert!(trigger.is_due(0.0) && trigger.is_due(0.55));
        assert!(!trigger.is_due(0.58) && trigger.is_due(0.6));
    }
}
