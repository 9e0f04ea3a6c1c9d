//! Roughness of a surface, from the highest particle of every column across it.
//!
//! The columns are a spacing wide. With the height z_k of the highest particle of column k along the normal,
//! half a spacing included, `Ra = mean |z_k - mean z|`, `Rz = max z_k - min z_k` (ISO 21920). Columns without
//! particles do not count, nor what has come off the body.

use glam::DVec3;

use super::pieces::Pieces;
use crate::neighbors::{NeighborError, Periodic};
use crate::plugin::{Selection, SimBuilder};
use crate::record::probe::measure::Measure;
use crate::schedule::Resources;
use crate::world::{Column, Damage, MissingColumn, Position, Removed, World};

/// A surface that is looked at against its normal.
pub(super) struct Roughness {
    selection: Selection,
    normal: DVec3,
    /// Directions along the surface, and the columns along each: the place of the first, m, and their number.
    along: Vec<(DVec3, f64, usize)>,
    /// Width of the columns, m.
    spacing: f64,
    periodic: Periodic,
    pieces: Pieces,
}

impl Roughness {
    /// The surface of a selection as it is at the start.
    ///
    /// # Errors
    /// The particles of a body that can fail have no neighbours that could be found.
    pub fn new(selection: Selection, normal: DVec3, sim: &SimBuilder<'_>) -> Result<Self, NeighborError> {
        let spacing =
            selection.parts.iter().map(|(id, _)| sim.body(*id).spacing).fold(f64::INFINITY, f64::min);
        let directions = if sim.dimension().count() == 2 {
            vec![DVec3::new(normal.y, -normal.x, 0.0)]
        } else {
            let (one, other) = normal.any_orthonormal_pair();
            vec![one, other]
        };
        let places = || {
            selection.parts.iter().flat_map(|(id, rows)| {
                let body = sim.body(*id);
                rows.iter().map(|&row| body.sites[row as usize - body.rows.start].position)
            })
        };
        let columns = |direction: DVec3| {
            let (low, high) = places()
                .map(|x| x.dot(direction))
                .fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), u| (low.min(u), high.max(u)));
            (direction, low, ((high - low) / spacing).round() as usize + 1)
        };
        let along = directions.into_iter().map(columns).collect();
        let pieces = Pieces::new(selection.parts.iter().map(|(body, _)| *body), sim)?;
        Ok(Self { selection, normal, along, spacing, periodic: sim.periodic(), pieces })
    }

    /// The column that a place is in.
    fn column(&self, x: DVec3) -> Option<usize> {
        let mut column = 0;
        for &(direction, first, count) in &self.along {
            let k = ((x.dot(direction) - first) / self.spacing).round() as i64;
            if k < 0 || k as usize >= count {
                return None;
            }
            column = column * count + k as usize;
        }
        Some(column)
    }
}

impl Measure for Roughness {
    fn columns(&self) -> Vec<(String, &'static str)> {
        ["Ra", "Rz", "mean"].map(|name| (name.to_owned(), "m")).to_vec()
    }

    fn needs(&self) -> Vec<&'static str> {
        let mut needs = vec![Position::NAME, Removed::NAME];
        if !self.pieces.is_empty() {
            needs.push(Damage::NAME);
        }
        needs
    }

    fn read(&self, world: &World, _: &Resources) -> Result<Vec<f64>, MissingColumn> {
        let mut heights = vec![f64::NEG_INFINITY; self.along.iter().map(|(.., count)| count).product()];
        for (body, rows) in &self.selection.parts {
            let rows = world.rows_now(*body, rows)?;
            let (view, all) = world.body_view(*body);
            let (position, removed) = (view.read::<Position>()?, view.read::<Removed>()?);
            let attached = self.pieces.largest(world, *body)?;
            let is_attached = |row: usize| attached.as_ref().is_none_or(|is| is[row - all.start]);
            let there = rows.iter().map(|&row| row as usize);
            let there = there.filter(|&row| removed[row] == Removed::NO && is_attached(row));
            for x in there.map(|row| position[row].0) {
                if let Some(k) = self.column(self.periodic.wrap(x)).or_else(|| self.column(x)) {
                    heights[k] = heights[k].max(x.dot(self.normal) + 0.5 * self.spacing);
                }
            }
        }
        let known = || heights.iter().copied().filter(|height| height.is_finite());
        let count = known().count() as f64;
        let mean = known().sum::<f64>() / count;
        let roughness = known().map(|height| (height - mean).abs()).sum::<f64>() / count;
        let (low, high) =
            known().fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), z| (low.min(z), high.max(z)));
        Ok(vec![roughness, high - low, mean])
    }
}
