//! The mean of a gauge over the time between two samples.

use serde::{Deserialize, Serialize};

/// Integrates the reading of a gauge by the trapezoidal rule, step by step: of the force on a body this is
/// the momentum that the leapfrog transfers.
#[derive(Clone, Debug, Default, Serialize, Deserialize)]
pub(super) struct TimeMean {
    /// Integral since the last sample, and its length, s.
    integral: Vec<f64>,
    length: f64,
    /// Time of the last reading, s, and its values.
    last: Option<(f64, Vec<f64>)>,
}

impl TimeMean {
    /// Adds the reading at a time, s.
    pub fn add(&mut self, time: f64, values: &[f64]) {
        if let Some((before, earlier)) = &self.last {
            let dt = time - before;
            self.integral.resize(values.len(), 0.0);
            let ends = earlier.iter().zip(values);
            self.integral.iter_mut().zip(ends).for_each(|(sum, (a, b))| *sum += 0.5 * dt * (a + b));
            self.length += dt;
        }
        self.last = Some((time, values.to_vec()));
    }

    /// The mean since it was asked for last; at the start, the last values.
    pub fn take(&mut self) -> Vec<f64> {
        if self.length <= 0.0 {
            return self.last.as_ref().map_or_else(Vec::new, |(_, values)| values.clone());
        }
        let mean = self.integral.iter().map(|sum| sum / self.length).collect();
        self.integral.fill(0.0);
        self.length = 0.0;
        mean
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_mean_is_over_the_time_since_the_last_sample_whatever_the_steps() {
        let mut mean = TimeMean::default();
        mean.add(0.0, &[1.0, 0.0]);
        assert_eq!(mean.take(), [1.0, 0.0]);
        for t in [0.5, 0.75, 2.0] {
            mean.add(t, &[1.0, 4.0 * t]);
        }
        assert_eq!(mean.take(), [1.0, 4.0]);
        mean.add(3.0, &[3.0, 12.0]);
        assert_eq!(mean.take(), [2.0, 10.0]);
    }
}
