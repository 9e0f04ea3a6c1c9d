//! The value at one place minus the value at another.

use super::gauge::Gauge;
use super::measure::Measure;
use crate::schedule::Resources;
use crate::world::{MissingColumn, World};

/// Two gauges of the same columns.
pub(super) struct RelativeGauge {
    pub first: Gauge,
    pub second: Gauge,
    /// The length of the difference instead of its components.
    pub distance: bool,
}

impl Measure for RelativeGauge {
    fn columns(&self) -> Vec<(String, &'static str)> {
        if self.distance { vec![("distance".to_owned(), "m")] } else { self.first.columns() }
    }

    fn needs(&self) -> Vec<&'static str> {
        let mut needs = self.first.needs();
        needs.extend(self.second.needs());
        needs
    }

    fn read(&self, world: &World, resources: &Resources) -> Result<Vec<f64>, MissingColumn> {
        let (first, second) = (self.first.read(world, resources)?, self.second.read(world, resources)?);
        let difference: Vec<f64> = first.iter().zip(second).map(|(a, b)| a - b).collect();
        if self.distance {
            return Ok(vec![difference.iter().map(|part| part * part).sum::<f64>().sqrt()]);
        }
        Ok(difference)
    }
}
