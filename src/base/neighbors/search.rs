//! The neighbour search: it checks the input, builds the grid, then the rows.

use std::ops::Range;

use glam::DVec3;

use super::grid::{Grid, GridBounds};
use super::periodic::AXIS_NAMES;
use super::rows::{Buffers, Order, Query, Sift};
use super::{Cloud, NeighborError, NeighborList, Periodic, PointBounds, SupportRadii};

/// Neighbour search with persistent buffers: it does not allocate from the second build of similar size on.
#[derive(Debug, Default)]
pub struct NeighborSearch {
    grid: Grid,
    buffers: Buffers,
    sources: GridSources,
}

/// The particles in the grid.
#[derive(Debug, Default)]
struct GridSources {
    count: usize,
    largest_support: f64,
    bounds: PointBounds,
}

/// A cloud, the first particles of which are targets.
#[derive(Clone, Copy)]
pub struct FirstOfCloud<'a> {
    /// All particles.
    pub cloud: Cloud<'a>,
    /// Number of targets.
    pub targets: usize,
}

/// Parameters of a search, beside the targets.
#[derive(Clone, Copy)]
struct SearchTask<'a> {
    same_set: bool,
    skin: f64,
    /// Ends of the groups of sources that order a row; `None` for ascending rows.
    groups: Option<&'a [u32]>,
    periodic: &'a Periodic,
    /// Half the edge lengths of the targets, m, where targets are boxes.
    halves: Option<&'a [DVec3]>,
    /// The targets whose rows are built, ascending; `None` for all.
    only: Option<&'a [Range<usize>]>,
    /// Takes more out of the rows.
    sift: Option<Sift<'a>>,
}

impl<'a> SearchTask<'a> {
    /// All neighbours of points.
    fn of_points(same_set: bool, groups: Option<&'a [u32]>, skin: f64, periodic: &'a Periodic) -> Self {
        Self { same_set, skin, groups, periodic, halves: None, only: None, sift: None }
    }
}

/// Boxes whose neighbours are searched.
#[derive(Clone, Copy)]
pub struct Boxes<'a> {
    /// Their centres, m.
    pub centers: &'a [DVec3],
    /// Half of their edge lengths, m.
    pub halves: &'a [DVec3],
    /// The boxes whose rows are built, ascending; the rows of the others stay empty.
    pub wanted: &'a [Range<usize>],
    /// Ends of the groups of sources that order a row.
    pub groups: &'a [u32],
    /// Takes sources out of the rows.
    pub sift: Option<Sift<'a>>,
}

impl NeighborSearch {
    /// Lists the neighbours of every particle of `cloud` in `cloud`, itself excluded, within the mean of
    /// their support radii plus `skin` (m). The content of `list` is replaced.
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
        let wanted = SearchTask::of_points(true, None, skin, periodic);
        self.build(cloud, cloud, wanted, list)
    }

    /// Lists the neighbours of the first particles of a cloud in the whole cloud, behind the rows that `list`
    /// has. Otherwise as [`NeighborSearch::within`].
    ///
    /// # Errors
    /// See [`NeighborError`]; `list` is then unchanged.
    pub fn append(
        &mut self,
        first: FirstOfCloud<'_>,
        skin: f64,
        periodic: &Periodic,
        list: &mut NeighborList,
    ) -> Result<(), NeighborError> {
        let wanted = SearchTask::of_points(true, None, skin, periodic);
        let targets = first.cloud.first(first.targets);
        let radius = self.grid_of(targets, first.cloud, wanted)?;
        self.fill(targets, radius, wanted, list);
        Ok(())
    }

    /// Lists the neighbours of the first particles of a cloud in the whole cloud. A row is ordered by the
    /// groups of particles that end at `groups`, and within a group by cells, which is cheaper than ascending
    /// rows. Otherwise as [`NeighborSearch::within`].
    ///
    /// # Errors
    /// See [`NeighborError`]; `list` is then unchanged.
    pub fn of_first(
        &mut self,
        first: FirstOfCloud<'_>,
        groups: &[u32],
        skin: f64,
        periodic: &Periodic,
        list: &mut NeighborList,
    ) -> Result<(), NeighborError> {
        let wanted = SearchTask::of_points(true, Some(groups), skin, periodic);
        self.build(first.cloud.first(first.targets), first.cloud, wanted, list)
    }

    /// Lists the neighbours of every target among `sources`, another set of particles, where equal row
    /// numbers do not mean the same particle. Otherwise as [`NeighborSearch::within`].
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
        let wanted = SearchTask::of_points(false, None, skin, periodic);
        self.build(targets, sources, wanted, list)
    }

    /// Lists the neighbours of other particles among the sources of the previous search, without sorting
    /// these again. Both sets have uniform support radii; rows are ordered as by
    /// [`NeighborSearch::of_first`]. A skin much larger than that of the previous search is slow.
    ///
    /// # Errors
    /// See [`NeighborError`]; `list` is then unchanged.
    pub fn of_others(
        &mut self,
        positions: &[DVec3],
        groups: &[u32],
        skin: f64,
        periodic: &Periodic,
        list: &mut NeighborList,
    ) -> Result<(), NeighborError> {
        let targets = Cloud::uniform(positions, self.sources.largest_support);
        targets.check("target")?;
        let wanted = SearchTask::of_points(false, Some(groups), skin, periodic);
        let radius = self.radius(targets, wanted)?;
        list.offsets.truncate(1);
        self.fill(targets, radius, wanted, list);
        Ok(())
    }

    /// Sorts sources with a uniform support radius into the grid, for subsequent searches.
    ///
    /// # Errors
    /// See [`NeighborError`].
    pub fn sort(&mut self, sources: Cloud<'_>, skin: f64, periodic: &Periodic) -> Result<(), NeighborError> {
        let wanted = SearchTask::of_points(true, None, skin, periodic);
        self.grid_of(sources.first(0), sources, wanted).map(|_| ())
    }

    /// Lists, for each box, the sources of the previous search within the support radius plus the skin.
    /// Otherwise as [`NeighborSearch::of_others`].
    ///
    /// # Errors
    /// See [`NeighborError`].
    pub fn of_boxes(
        &mut self,
        boxes: Boxes<'_>,
        skin: f64,
        periodic: &Periodic,
        list: &mut NeighborList,
    ) -> Result<(), NeighborError> {
        let mut buffers = std::mem::take(&mut self.buffers);
        let done = self.of_boxes_with(&mut buffers, boxes, skin, periodic, list);
        self.buffers = buffers;
        done
    }

    /// [`NeighborSearch::of_boxes`] with temporary buffers, which leaves the search unchanged.
    ///
    /// # Errors
    /// See [`NeighborError`].
    pub fn of_more_boxes(
        &self,
        boxes: Boxes<'_>,
        skin: f64,
        periodic: &Periodic,
        list: &mut NeighborList,
    ) -> Result<(), NeighborError> {
        self.of_boxes_with(&mut Buffers::default(), boxes, skin, periodic, list)
    }

    fn of_boxes_with(
        &self,
        buffers: &mut Buffers,
        Boxes { centers, halves, wanted, groups, sift }: Boxes<'_>,
        skin: f64,
        periodic: &Periodic,
        list: &mut NeighborList,
    ) -> Result<(), NeighborError> {
        let targets = Cloud::uniform(centers, self.sources.largest_support);
        let wanted = SearchTask {
            same_set: false,
            skin,
            groups: Some(groups),
            periodic,
            halves: Some(halves),
            only: Some(wanted),
            sift,
        };
        let radius = self.radius(targets, wanted)?;
        list.offsets.truncate(1);
        self.query(targets, radius, wanted).fill(buffers, list);
        Ok(())
    }

    fn build(
        &mut self,
        targets: Cloud<'_>,
        sources: Cloud<'_>,
        wanted: SearchTask<'_>,
        list: &mut NeighborList,
    ) -> Result<(), NeighborError> {
        let radius = self.grid_of(targets, sources, wanted)?;
        list.offsets.truncate(1);
        self.fill(targets, radius, wanted, list);
        Ok(())
    }

    /// Sorts the sources into the grid and returns the maximum pair radius, m.
    fn grid_of(
        &mut self,
        targets: Cloud<'_>,
        sources: Cloud<'_>,
        wanted: SearchTask<'_>,
    ) -> Result<f64, NeighborError> {
        let SearchTask { same_set, periodic, .. } = wanted;
        sources.check(if same_set { "target" } else { "source" })?;
        if !same_set {
            targets.check("target")?;
        }
        let count = sources.positions.len();
        self.sources = GridSources {
            count,
            largest_support: sources.largest_support(),
            bounds: if count == 0 { Default::default() } else { sources.bounds() },
        };
        let radius = self.radius(targets, wanted)?;
        let mut bounds = self.sources.bounds;
        if !same_set && periodic.any() {
            let more = targets.bounds();
            for a in (0..3).filter(|&a| periodic.axes()[a]) {
                bounds.low[a] = bounds.low[a].min(more.low[a]);
                bounds.high[a] = bounds.high[a].max(more.high[a]);
            }
        }
        let uniform = matches!(
            (targets.support, sources.support),
            (SupportRadii::Uniform(_), SupportRadii::Uniform(_))
        );
        let particles = targets.positions.len().max(count);
        let around = GridBounds { bounds, radius, periodic };
        self.grid.build(sources, !uniform, around, particles);
        Ok(radius)
    }

    /// The maximum pair radius, m.
    fn radius(
        &self,
        targets: Cloud<'_>,
        SearchTask { skin, periodic, .. }: SearchTask<'_>,
    ) -> Result<f64, NeighborError> {
        if !(skin >= 0.0 && skin.is_finite()) {
            return Err(NeighborError::Skin(skin));
        }
        let radius = 0.5 * (targets.largest_support() + self.sources.largest_support) + skin;
        for a in (0..3).filter(|&a| periodic.axes()[a]) {
            let (length, needed) = (periodic.lengths()[a], 2.0 * radius);
            if length < needed {
                return Err(NeighborError::PeriodicTooShort { axis: AXIS_NAMES[a], length, needed });
            }
        }
        Ok(radius)
    }

    /// Lists the neighbours of the targets in the grid, behind the rows that there are.
    fn fill(&mut self, targets: Cloud<'_>, radius: f64, wanted: SearchTask<'_>, list: &mut NeighborList) {
        let mut buffers = std::mem::take(&mut self.buffers);
        self.query(targets, radius, wanted).fill(&mut buffers, list);
        self.buffers = buffers;
    }

    fn query<'a>(&'a self, targets: Cloud<'a>, radius: f64, wanted: SearchTask<'a>) -> Query<'a> {
        let SearchTask { same_set, skin, groups, periodic, halves, only, sift } = wanted;
        let GridSources { count, bounds, .. } = self.sources;
        let more = if same_set { bounds } else { targets.bounds() };
        let solid = bounds.low.z.min(more.low.z) < bounds.high.z.max(more.high.z);
        let order = match groups {
            None => Order::Rows,
            Some(ends) if ends.iter().all(|&end| end as usize >= count) => Order::Cells,
            Some(ends) => Order::Groups(ends),
        };
        Query {
            grid: &self.grid,
            targets,
            same_set,
            radius,
            skin,
            periodic,
            solid,
            order,
            halves,
            only,
            sift,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

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
        search
            .of_first(FirstOfCloud { cloud, targets: 250 }, &groups, 0.05, &Periodic::NONE, &mut first)
            .expect("a list");
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

        // The other particles, some outside the bounding box of the sources, have their own radius.
        let others: Vec<DVec3> = (300..400).map(|k| 1.3 * place(k)).collect();
        let (mut between, mut again) = (NeighborList::default(), NeighborList::default());
        let targets = Cloud::uniform(&others, 0.5);
        search
            .of_first(FirstOfCloud { cloud, targets: 250 }, &groups, 0.05, &Periodic::NONE, &mut first)
            .expect("a list");
        search.of_others(&others, &groups, 0.15, &Periodic::NONE, &mut again).expect("a list");
        search.between(targets, cloud, 0.15, &Periodic::NONE, &mut between).expect("a list");
        for i in 0..others.len() {
            let mut row = again.row(i).to_vec();
            row.sort_unstable();
            assert_eq!(row, between.row(i));
        }

        // Rows are added behind others.
        let mut both = all.clone();
        search
            .append(FirstOfCloud { cloud, targets: 250 }, 0.05, &Periodic::NONE, &mut both)
            .expect("a list");
        assert_eq!(both.rows(), 650);
        assert!((0..400).all(|i| both.row(i) == all.row(i)));
        assert!((0..250).all(|i| both.row(400 + i) == all.row(i)));
    }
}
