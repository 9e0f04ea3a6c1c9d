//! A field at points of a body that move with it: a point, places on a line, or those of its surface.

use glam::DVec3;

use super::measure::Measure;
use super::stencil::Stencil;
use super::surface::SurfacePoints;
use super::taken::{Extremum, of_number};
use crate::fields::ChosenField;
use crate::scene::Reduction;
use crate::schedule::Resources;
use crate::world::{BodyId, Column, MissingColumn, Position, Removed, World};

/// Reduction of the values at the points.
pub(super) enum PointReduction {
    /// The value at the only point.
    Value,
    /// All of them, each with its distance from the first, m.
    Line(Vec<f64>),
    /// Something over points that stand for these areas, m2.
    Taken(Reduction, Vec<f64>),
}

/// A field at points of a body.
pub(super) struct BodyPoints {
    pub body: BodyId,
    pub field: ChosenField,
    pub stencils: Vec<Stencil>,
    /// Those at surfaces, if the field is one of the stress.
    pub surface: Option<SurfacePoints>,
    pub made: PointReduction,
}

impl Measure for BodyPoints {
    fn columns(&self) -> Vec<(String, &'static str)> {
        let names = self.field.column_names();
        match &self.made {
            PointReduction::Line(along) => line_columns(&self.field, along),
            PointReduction::Taken(Reduction::Minimum | Reduction::Maximum, _) => {
                Extremum::columns(&self.field)
            }
            _ => names.into_iter().map(|name| (name, self.field.unit())).collect(),
        }
    }

    fn needs(&self) -> Vec<&'static str> {
        let mut needs = self.field.needs();
        needs.push(Position::NAME);
        if self.surface.is_some() {
            needs.extend(SurfacePoints::needs());
        }
        needs
    }

    fn read(&self, world: &World, resources: &Resources) -> Result<Vec<f64>, MissingColumn> {
        let (view, rows) = world.body_view(self.body);
        let removed = &view.read::<Removed>()?[rows.clone()];
        let ends = || self.stencils.iter().map(Stencil::ends);
        let first = ends().map(|ends| ends.0).min().unwrap_or(0) as usize;
        let last = ends().map(|ends| ends.1).max().unwrap_or(0) as usize;
        let values =
            self.field.read(world, resources, self.body, rows.start + first..rows.start + last + 1)?;
        let width = self.field.width();
        let axes = world.dimension().count();
        let there = |particle: u32| removed[particle as usize] == Removed::NO;
        let shares: Vec<Vec<(u32, f64)>> =
            self.stencils.iter().map(|stencil| stencil.shares(axes, there)).collect();
        let at = |shares: &Vec<(u32, f64)>| -> Vec<f64> {
            let value = |c: usize| {
                let of =
                    |&(particle, share): &(u32, f64)| share * values[(particle as usize - first) * width + c];
                if shares.is_empty() { f64::NAN } else { shares.iter().map(of).sum() }
            };
            (0..width).map(value).collect()
        };
        let mut all: Vec<Vec<f64>> = shares.iter().map(at).collect();
        for (k, values) in all.iter_mut().enumerate() {
            self.at_surface(k, (world, resources), &there, values)?;
        }
        match &self.made {
            PointReduction::Value | PointReduction::Line(_) => Ok(all.concat()),
            PointReduction::Taken(take @ (Reduction::Minimum | Reduction::Maximum), _) => {
                let position = &view.read::<Position>()?[rows];
                let mut extremum = Extremum::new(*take);
                for (values, shares) in all.iter().zip(&shares) {
                    let of = |&(particle, share): &(u32, f64)| share * position[particle as usize].0;
                    extremum.look(of_number(values), || shares.iter().map(of).sum::<DVec3>());
                }
                Ok(extremum.values(axes))
            }
            PointReduction::Taken(_, areas) => {
                let there = || all.iter().zip(areas).filter(|(values, _)| !values[0].is_nan());
                let total: f64 = there().map(|(_, area)| area).sum();
                let mean = |c: usize| there().map(|(values, area)| values[c] * area).sum::<f64>() / total;
                Ok((0..width).map(mean).collect())
            }
        }
    }
}

impl BodyPoints {
    /// Puts what the field is for the stress at a surface in the place of its values at a point of one.
    fn at_surface(
        &self,
        k: usize,
        (world, resources): (&World, &Resources),
        there: &dyn Fn(u32) -> bool,
        values: &mut [f64],
    ) -> Result<(), MissingColumn> {
        let Some(surface) = &self.surface else { return Ok(()) };
        let (Some(of_stress), Some(at_surface)) =
            (self.field.of_stress(self.body), surface.stress(k, world, resources, there)?)
        else {
            return Ok(());
        };
        for (value, there) in values.iter_mut().zip(of_stress(&at_surface.stress)) {
            *value += at_surface.share * (there - *value);
        }
        Ok(())
    }
}

/// The columns of a field at places along a line, by their distances from its first one.
pub(super) fn line_columns(field: &ChosenField, along: &[f64]) -> Vec<(String, &'static str)> {
    let names = field.column_names();
    let at = |distance: &f64| {
        let distance = format!("{distance:.9}");
        let distance = distance.trim_end_matches('0').trim_end_matches('.').to_owned();
        names.iter().map(move |name| format!("{name} at {distance} m")).collect::<Vec<_>>()
    };
    along.iter().flat_map(at).map(|name| (name, field.unit())).collect()
}
