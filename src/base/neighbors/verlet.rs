//! Verlet lists, which are valid for several steps.

use super::{Cloud, NeighborError, NeighborList, NeighborSearch, Periodic};
use glam::DVec3;
use rayon::prelude::*;

/// Neighbour list with a skin: it contains every pair within the mean support as long as no particle has
/// moved more than half the skin since the build. It also contains some pairs beyond the support, where the
/// kernel is zero.
///
/// Targets and sources are one set (`sources: None`) or two. Support radii must not grow between builds: call
/// [`VerletList::invalidate`] where they do, and after rows were removed or sorted.
#[derive(Debug)]
pub struct VerletList {
    skin: f64,
    search: NeighborSearch,
    list: NeighborList,
    targets: Vec<DVec3>,
    sources: Vec<DVec3>,
    valid: bool,
    builds: u64,
}

impl VerletList {
    /// An empty list, to be built by the first [`VerletList::update`]. Skin (m).
    pub fn new(skin: f64) -> Self {
        Self {
            skin,
            search: NeighborSearch::default(),
            list: NeighborList::default(),
            targets: Vec::new(),
            sources: Vec::new(),
            valid: false,
            builds: 0,
        }
    }

    /// Rebuilds the list if it is stale, and returns whether it did.
    ///
    /// # Errors
    /// See [`NeighborError`].
    pub fn update(
        &mut self,
        targets: Cloud<'_>,
        sources: Option<Cloud<'_>>,
        periodic: &Periodic,
    ) -> Result<bool, NeighborError> {
        let stale = self.is_stale(targets.positions, sources.map(|s| s.positions), periodic);
        if stale {
            self.rebuild(targets, sources, periodic)?;
        }
        Ok(stale)
    }

    /// Builds the list from the given positions. [`VerletList::built_targets`] and
    /// [`VerletList::built_sources`] of an earlier run reproduce its list.
    ///
    /// # Errors
    /// See [`NeighborError`]; the list is then stale.
    pub fn rebuild(
        &mut self,
        targets: Cloud<'_>,
        sources: Option<Cloud<'_>>,
        periodic: &Periodic,
    ) -> Result<(), NeighborError> {
        self.valid = false;
        match sources {
            None => self.search.within(targets, self.skin, periodic, &mut self.list)?,
            Some(sources) => {
                self.search.between(targets, sources, self.skin, periodic, &mut self.list)?;
            }
        }
        self.targets.clear();
        self.targets.extend_from_slice(targets.positions);
        self.sources.clear();
        self.sources.extend_from_slice(sources.map_or(&[], |s| s.positions));
        self.valid = true;
        self.builds += 1;
        Ok(())
    }

    /// True when a particle has moved more than half the skin, when the number of particles has changed, or
    /// when the list was never built. A NaN position also makes the list stale, so that the rebuild reports
    /// it.
    pub fn is_stale(&self, targets: &[DVec3], sources: Option<&[DVec3]>, periodic: &Periodic) -> bool {
        !self.valid
            || moved(&self.targets, targets, self.skin, periodic)
            || moved(&self.sources, sources.unwrap_or(&[]), self.skin, periodic)
    }

    /// Marks the list as stale, so that the next update rebuilds it.
    pub fn invalidate(&mut self) {
        self.valid = false;
    }

    /// The list as last built.
    pub fn list(&self) -> &NeighborList {
        &self.list
    }

    /// Skin (m).
    pub fn skin(&self) -> f64 {
        self.skin
    }

    /// Number of builds so far.
    pub fn builds(&self) -> u64 {
        self.builds
    }

    /// Target positions (m) at the last build, which a checkpoint stores.
    pub fn built_targets(&self) -> &[DVec3] {
        &self.targets
    }

    /// Source positions (m) at the last build; empty where the sources are the targets.
    pub fn built_sources(&self) -> &[DVec3] {
        &self.sources
    }
}

fn moved(then: &[DVec3], now: &[DVec3], skin: f64, periodic: &Periodic) -> bool {
    let limit = 0.25 * skin * skin;
    then.len() != now.len()
        || then.par_iter().with_min_len(4096).zip(now).any(|(a, b)| {
            let displacement_squared = periodic.minimal_image(*b - *a).length_squared();
            displacement_squared > limit || displacement_squared.is_nan()
        })
}
