//! The search: checks of the input, the grid, then the rows.

use super::grid::Grid;
use super::periodic::AXIS_NAMES;
use super::rows::{Buffers, Query};
use super::{Cloud, NeighborError, NeighborList, Periodic, Support};

/// Neighbour search with buffers that are kept: from the second build of like size on it does not allocate.
#[derive(Debug, Default)]
pub struct NeighborSearch {
    grid: Grid,
    buffers: Buffers,
}

impl NeighborSearch {
    /// Lists the neighbours of every particle of `cloud` in `cloud`, itself excluded, within the mean of their
    /// support radii plus `skin` (m). What `list` held is replaced.
    ///
    /// # Errors
    /// See [`NeighborError`]; `list` is then unchanged.
    pub fn within(
        &mut self,
        cloud: Cloud<'_>,
        skin: f64,
        periodic: &Periodic,
        list: &mut NeighborList,
    ) -> Result<(), NeighborError> {
        self.build(cloud, cloud, true, skin, periodic, list)
    }

    /// Lists the neighbours of the first `targets` particles of `cloud` in `cloud`: otherwise as [`NeighborSearch::within`].
    ///
    /// # Errors
    /// See [`NeighborError`]; `list` is then unchanged.
    pub fn of_first(
        &mut self,
        targets: usize,
        cloud: Cloud<'_>,
        skin: f64,
        periodic: &Periodic,
        list: &mut NeighborList,
    ) -> Result<(), NeighborError> {
        self.build(cloud.first(targets), cloud, true, skin, periodic, list)
    }

    /// Lists the neighbours of every target among `sources`, another set of particles: equal row numbers are not
    /// the same particle. Otherwise as [`NeighborSearch::within`].
    ///
    /// # Errors
    /// See [`NeighborError`]; `list` is then unchanged.
    pub fn between(
        &mut self,
        targets: Cloud<'_>,
        sources: Cloud<'_>,
        skin: f64,
        periodic: &Periodic,
        list: &mut NeighborList,
    ) -> Result<(), NeighborError> {
        self.build(targets, sources, false, skin, periodic, list)
    }

    fn build(
        &mut self,
        targets: Cloud<'_>,
        sources: Cloud<'_>,
        same_set: bool,
        skin: f64,
        periodic: &Periodic,
        list: &mut NeighborList,
    ) -> Result<(), NeighborError> {
        if !(skin >= 0.0 && skin.is_finite()) {
            return Err(NeighborError::Skin(skin));
        }
        sources.check(if same_set { "target" } else { "source" })?;
        if !same_set {
            targets.check("target")?;
        }
        let radius = 0.5 * (targets.largest_support() + sources.largest_support()) + skin;
        for a in (0..3).filter(|&a| periodic.axes()[a]) {
            let (length, needed) = (periodic.lengths()[a], 2.0 * radius);
            if length < needed {
                return Err(NeighborError::PeriodicTooShort { axis: AXIS_NAMES[a], length, needed });
            }
        }
        let mut bounds = sources.bounds();
        if !same_set && periodic.any() {
            let more = targets.bounds();
            for a in (0..3).filter(|&a| periodic.axes()[a]) {
                bounds.0[a] = bounds.0[a].min(more.0[a]);
                bounds.1[a] = bounds.1[a].max(more.1[a]);
            }
        }
        let uniform =
            matches!((targets.support, sources.support), (Support::Uniform(_), Support::Uniform(_)));
        self.grid.build(sources, !uniform, bounds, radius, periodic);

        let query = Query { grid: &self.grid, targets, same_set, radius, skin, periodic };
        match (periodic.any(), uniform) {
            (false, true) => query.fill::<false, true>(&mut self.buffers, list),
            (false, false) => query.fill::<false, false>(&mut self.buffers, list),
            (true, true) => query.fill::<true, true>(&mut self.buffers, list),
            (true, false) => query.fill::<true, false>(&mut self.buffers, list),
        }
        Ok(())
    }
}
