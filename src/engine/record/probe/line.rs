//! A field at places of space along a line.

use super::body_points::line_columns;
use super::measure::Measure;
use super::point::PointGauge;
use crate::schedule::Resources;
use crate::world::{MissingColumn, World};

/// Places in space, with their distances from the first, m.
pub(super) struct SpaceLine {
    pub points: Vec<PointGauge>,
    pub along: Vec<f64>,
}

impl Measure for SpaceLine {
    fn columns(&self) -> Vec<(String, &'static str)> {
        self.points.first().map(|point| line_columns(&point.field, &self.along)).unwrap_or_default()
    }

    fn needs(&self) -> Vec<&'static str> {
        self.points.first().map(|point| point.field.needs()).unwrap_or_default()
    }

    fn read(&self, world: &World, resources: &Resources) -> Result<Vec<f64>, MissingColumn> {
        let mut values = Vec::new();
        for point in &self.points {
            values.extend(point.read(world, resources)?);
        }
        Ok(values)
    }
}
