//! Minimum and maximum of a field over a selection, with their places.

use glam::DVec3;

use super::measure::Measure;
use crate::fields::ChosenField;
use crate::plugin::Selection;
use crate::scene::Reduction;
use crate::schedule::Resources;
use crate::world::{Column, MissingColumn, Position, Removed, World};

/// A minimum or maximum that is looked for.
pub(super) struct Extremum {
    /// 1 for a maximum, -1 for a minimum.
    sign: f64,
    found: Option<(f64, DVec3)>,
}

impl Extremum {
    pub fn new(take: Reduction) -> Self {
        Self { sign: if take == Reduction::Minimum { -1.0 } else { 1.0 }, found: None }
    }

    /// The value with the coordinates of its place.
    pub fn columns(field: &ChosenField) -> Vec<(String, &'static str)> {
        let value = (field.name().to_owned(), field.unit());
        std::iter::once(value).chain(["x", "y", "z"].map(|axis| (axis.to_owned(), "m"))).collect()
    }

    /// Of equal values the first counts; NaN is no value.
    pub fn look(&mut self, value: f64, place: impl FnOnce() -> DVec3) {
        if !value.is_nan() && self.found.is_none_or(|(best, _)| self.sign * (value - best) > 0.0) {
            self.found = Some((value, place()));
        }
    }

    /// NaN where there was no value, and for z in two dimensions 0.
    pub fn values(&self, axes: usize) -> Vec<f64> {
        let (value, mut place) = self.found.unwrap_or((f64::NAN, DVec3::NAN));
        if axes == 2 {
            place.z = 0.0;
        }
        vec![value, place.x, place.y, place.z]
    }
}

/// A number, or the magnitude of a vector.
pub(super) fn of_number(values: &[f64]) -> f64 {
    match values {
        [value] => *value,
        all => all.iter().map(|value| value * value).sum::<f64>().sqrt(),
    }
}

/// Minimum or maximum of a field over the particles of a selection.
pub(super) struct Extremal {
    pub selection: Selection,
    pub field: ChosenField,
    pub take: Reduction,
}

impl Measure for Extremal {
    fn columns(&self) -> Vec<(String, &'static str)> {
        Extremum::columns(&self.field)
    }

    fn needs(&self) -> Vec<&'static str> {
        let mut needs = self.field.needs();
        needs.push(Position::NAME);
        needs
    }

    fn read(&self, world: &World, resources: &Resources) -> Result<Vec<f64>, MissingColumn> {
        let width = self.field.width();
        let mut extremum = Extremum::new(self.take);
        for (body, rows) in &self.selection.parts {
            let rows = world.rows_now(*body, rows)?;
            let (Some(&first), Some(&last)) = (rows.first(), rows.last()) else { continue };
            let values = self.field.read(world, resources, *body, first as usize..last as usize + 1)?;
            let (view, _) = world.body_view(*body);
            let (removed, position) = (view.read::<Removed>()?, view.read::<Position>()?);
            for row in rows.iter().map(|&row| row as usize).filter(|&row| removed[row] == Removed::NO) {
                let at = (row - first as usize) * width;
                extremum.look(of_number(&values[at..at + width]), || position[row].0);
            }
        }
        Ok(extremum.values(world.dimension().count()))
    }
}
