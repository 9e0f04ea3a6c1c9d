//! Records over time: values from references, means, maxima, crossings.

use std::ops::RangeInclusive;

use anyhow::{Context, Result, ensure};

/// Values at times, ascending.
#[derive(Clone, Debug, Default)]
pub struct Record(pub Vec<(f64, f64)>);

impl Record {
    /// Adds a value, s and its unit.
    pub fn push(&mut self, time: f64, value: f64) {
        self.0.push((time, value));
    }

    /// Mean over a time, s, by the trapezoidal rule over the samples in it.
    pub fn mean(&self, time: &RangeInclusive<f64>) -> Result<f64> {
        let inside: Vec<(f64, f64)> = self.0.iter().copied().filter(|s| time.contains(&s.0)).collect();
        ensure!(inside.len() > 1, "the record has no samples from {} to {} s", time.start(), time.end());
        let areas = inside.windows(2).map(|w| 0.5 * (w[0].1 + w[1].1) * (w[1].0 - w[0].0));
        Ok(areas.sum::<f64>() / (inside[inside.len() - 1].0 - inside[0].0))
    }

    /// Time and value of the maximum, from the parabola through three samples.
    pub fn maximum(&self) -> Result<(f64, f64)> {
        let largest = self.0.windows(3).max_by(|a, b| a[1].1.total_cmp(&b[1].1));
        let inner = largest.filter(|w| w[1].1 >= w[0].1 && w[1].1 > w[2].1);
        inner.map(|w| vertex(w[0], w[1], w[2])).context("the record has its maximum at an end")
    }

    /// The record in two columns of a CSV text whose comment lines start with `#`.
    pub fn read(csv: &str, time: &str, value: &str) -> Result<Self> {
        let mut lines = csv.lines().filter(|line| !line.starts_with('#'));
        let names: Vec<&str> = lines.next().context("the reference is empty")?.split(',').collect();
        let column =
            |name| names.iter().position(|n| *n == name).with_context(|| format!("no column `{name}`"));
        let (time, value) = (column(time)?, column(value)?);
        let mut record = Self::default();
        for line in lines {
            let numbers: Vec<&str> = line.split(',').collect();
            ensure!(numbers.len() == names.len(), "the reference has a short line: {line}");
            record.push(numbers[time].parse()?, numbers[value].parse()?);
        }
        Ok(record)
    }

    /// The part up to a time, s.
    #[must_use]
    pub fn until(mut self, end: f64) -> Self {
        self.0.retain(|sample| sample.0 <= end);
        self
    }

    /// Middle of the time in which the value is above `share` of its maximum, s. It is well-defined for a
    /// flat peak, where the time of the maximum is not.
    pub fn middle_of_peak(&self, share: f64) -> Result<f64> {
        let (_, largest) = self.maximum()?;
        let level = share * largest;
        let rise = self.upward_crossings(level).first().copied();
        let falling = Self(self.0.iter().map(|&(t, v)| (t, -v)).collect());
        let fall = falling.upward_crossings(-level).last().copied();
        Ok(0.5
            * (rise.context("the record starts in its peak")?
                + fall.context("the record ends in its peak")?))
    }

    /// Times at which the value rises through `level`, s.
    pub fn upward_crossings(&self, level: f64) -> Vec<f64> {
        let rises = self.0.windows(2).filter(|w| w[0].1 < level && w[1].1 >= level);
        rises.map(|w| w[0].0 + (w[1].0 - w[0].0) * (level - w[0].1) / (w[1].1 - w[0].1)).collect()
    }
}

/// Vertex of the parabola through three points.
fn vertex(a: (f64, f64), b: (f64, f64), c: (f64, f64)) -> (f64, f64) {
    let left = (b.1 - a.1) / (b.0 - a.0);
    let right = (c.1 - b.1) / (c.0 - b.0);
    let curvature = (right - left) / (c.0 - a.0);
    if curvature == 0.0 {
        return b;
    }
    let time = 0.5 * (a.0 + b.0) - 0.5 * left / curvature;
    (time, a.1 + (time - a.0) * (left + curvature * (time - b.0)))
}

/// The rows of a reference, each a list of texts, without comments and header.
pub fn rows(csv: &str) -> impl Iterator<Item = Vec<&str>> {
    let lines = csv.lines().filter(|line| !line.starts_with('#') && !line.is_empty());
    lines.skip(1).map(|line| line.split(',').collect())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_peak_of_a_parabola_is_found_between_samples() {
        let mut record = Record::default();
        for k in 0..10 {
            let t = 0.3 * f64::from(k);
            record.push(t, 2.0 - (t - 1.0) * (t - 1.0));
        }
        let (time, value) = record.maximum().unwrap();
        assert!((time - 1.0).abs() < 1e-12 && (value - 2.0).abs() < 1e-12);
        assert!(Record(record.0[..3].to_vec()).maximum().is_err());
        let crossings = record.upward_crossings(1.2);
        assert_eq!(crossings.len(), 1);
        assert!(crossings[0] > 0.0 && crossings[0] < 0.3);
    }
}
