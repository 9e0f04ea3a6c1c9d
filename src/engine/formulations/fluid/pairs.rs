//! The neighbour lists of a flow: of every fluid particle among all particles, of every boundary particle among the
//! fluid.

use glam::DVec3;
use rayon::prelude::*;

use super::sides::{Sides, ThinBody};
use crate::neighbors::{Cloud, NeighborError, NeighborList, NeighborSearch, Periodic};

/// Lists that hold every pair within the support as long as no particle has moved more than half the skin.
#[derive(Debug)]
pub(super) struct FlowPairs {
    support: f64,
    skin: f64,
    periodic: Periodic,
    /// Where the bodies end, as rows of the cloud: rows of the lists are ordered by them.
    groups: Vec<u32>,
    search: NeighborSearch,
    /// Neighbours of each fluid particle as rows of the cloud.
    pub fluid: NeighborList,
    /// Fluid neighbours of each boundary particle; row 0 is the first particle after the fluid.
    pub boundary: NeighborList,
    /// Positions that the lists were built from, m; empty where they have to be built.
    pub built: Vec<DVec3>,
    /// Bodies whose sides do not see each other.
    thin: Vec<ThinBody>,
    /// Number of builds.
    pub builds: u64,
}

impl FlowPairs {
    pub fn new(support: f64, skin: f64, periodic: Periodic, groups: Vec<u32>, thin: Vec<ThinBody>) -> Self {
        Self {
            support,
            skin,
            periodic,
            groups,
            search: NeighborSearch::default(),
            fluid: NeighborList::default(),
            boundary: NeighborList::default(),
            built: Vec::new(),
            thin,
            builds: 0,
        }
    }

    #[inline]
    pub fn periodic(&self) -> &Periodic {
        &self.periodic
    }

    /// Whether a particle is farther than half the skin from where it was when the lists were built, or they never were.
    pub fn is_stale(&self, positions: &[DVec3]) -> bool {
        let limit = 0.25 * self.skin * self.skin;
        let periodic = &self.periodic;
        self.built.len() != positions.len()
            || self.built.par_iter().with_min_len(4096).zip(positions).any(|(then, now)| {
                let moved = periodic.minimal_image(*now - *then).length_squared();
                moved > limit || moved.is_nan()
            })
    }

    /// Builds the lists; the first `fluid` positions are those of the fluid.
    pub fn build(&mut self, positions: &[DVec3], fluid: usize) -> Result<(), NeighborError> {
        self.built.clear();
        let cloud = |positions| Cloud::uniform(positions, self.support);
        let (all, wet, dry) = (cloud(positions), cloud(&positions[..fluid]), cloud(&positions[fluid..]));
        self.search.of_first((fluid, &self.groups), all, self.skin, &self.periodic, &mut self.fluid)?;
        self.search.between(dry, wet, self.skin, &self.periodic, &mut self.boundary)?;
        if !self.thin.is_empty() {
            let sides = Sides { thin: &self.thin, positions, periodic: &self.periodic, fluid };
            let all = self.fluid.clone();
            self.fluid.retain(|i, j| sides.sees(i, j as usize, &all));
            self.boundary.retain(|j, i| sides.sees(i as usize, fluid + j, &all));
        }
        self.built.extend_from_slice(positions);
        self.builds += 1;
        Ok(())
    }
}
