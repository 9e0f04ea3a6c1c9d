//! The search: checks of the input, the grid, then the rows.

use super::grid::Grid;
use super::periodic::AXIS_NAMES;
use super::rows::{Buffers, Order, Query};
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
        self.build(cloud, cloud, true, (skin, None), periodic, list)
    }

    /// Lists the neighbours of the first `targets` particles of `cloud` in `cloud`. A row is ordered by the groups of particles
    /// that end at `groups`, and within a group by cells: cheaper than ascending rows. Otherwise as [`NeighborSearch::within`].
    ///
    /// # Errors
    /// See [`NeighborError`]; `list` is then unchanged.
    pub fn of_first(
        &mut self,
        (targets, groups): (usize, &[u32]),
        cloud: Cloud<'_>,
        skin: f64,
        periodic: &Periodic,
        list: &mut NeighborList,
    ) -> Result<(), NeighborError> {
        self.build(cloud.first(targets), cloud, true, (skin, Some(groups)), periodic, list)
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
        self.build(targets, sources, false, (skin, None), periodic, list)
    }

    fn build(
        &mut self,
        targets: Cloud<'_>,
        sources: Cloud<'_>,
        same_set: bool,
        (skin, groups): (f64, Option<&[u32]>),
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
        let mut bounds = if sources.positions.is_empty() { Default::default() } else { sources.bounds() };
        let mut solid = bounds.0.z < bounds.1.z;
        if !same_set {
            let more = targets.bounds();
            solid |= bounds.0.z.min(more.0.z) < bounds.1.z.max(more.1.z);
            for a in (0..3).filter(|&a| periodic.axes()[a]) {
                bounds.0[a] = bounds.0[a].min(more.0[a]);
                bounds.1[a] = bounds.1[a].max(more.1[a]);
            }
        }
        let uniform =
            matches!((targets.support, sources.support), (Support::Uniform(_), Support::Uniform(_)));
        let particles = targets.positions.len().max(sources.positions.len());
        self.grid.build((sources, !uniform), bounds, radius, periodic, particles);

        let order = match groups {
            None => Order::Rows,
            Some(ends) if ends.iter().all(|&end| end as usize >= sources.positions.len()) => Order::Cells,
            Some(ends) => Order::Groups(ends),
        };
        let query = Query { grid: &self.grid, targets, same_set, radius, skin, periodic, solid, order };
        query.fill(&mut self.buffers, list);
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::DVec3;

    #[test]
    fn rows_of_the_first_particles_are_those_of_all_in_the_order_of_groups() {
        let place = |k: usize| {
            let t = k as f64;
            DVec3::new((0.37 * t).sin(), (1.7 * t + 0.3).sin(), (0.9 * t + 1.1).sin())
        };
        let positions: Vec<DVec3> = (0..400).map(place).collect();
        let cloud = Cloud::uniform(&positions, 0.5);
        let (mut all, mut first) = (NeighborList::default(), NeighborList::default());
        let (mut search, groups) = (NeighborSearch::default(), [90, 250, 400]);
        search.within(cloud, 0.05, &Periodic::NONE, &mut all).expect("a list");
        search.of_first((250, &groups), cloud, 0.05, &Periodic::NONE, &mut first).expect("a list");
        assert_eq!(first.rows(), 250);
        for i in 0..250 {
            let mut row = first.row(i).to_vec();
            assert!(
                groups.iter().all(|&end| row.iter().skip_while(|&&j| j < end).all(|&j| j >= end)),
                "{row:?}"
            );
            row.sort_unstable();
            assert_eq!(row, all.row(i));
        }
    }
}
