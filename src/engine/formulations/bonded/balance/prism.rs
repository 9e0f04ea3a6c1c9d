//! Whether a body is a prism beside a held side.

use glam::DVec3;

use super::body::HeldBody;
use crate::neighbors::{Cloud, NeighborList, NeighborSearch, Periodic};
use crate::plugin::HeldSide;

/// Distance from its place at which a particle still counts as being there, over the spacing.
const THERE: f64 = 1e-4;

/// The particles of a body around a side, where they have been in the lattice.
pub(super) struct SideParticles<'a> {
    pub side: &'a HeldSide,
    /// Their places, m.
    pub places: &'a [DVec3],
    /// Depth, m, up to which what is beside the side counts.
    pub depth: f64,
}

impl SideParticles<'_> {
    /// Whether the layers repeat along the normal up to that depth, after any distance: a uniform stress
    /// along the normal is then in balance without loads on other surfaces.
    pub fn is_prism(&self, body: &HeldBody<'_>) -> bool {
        let near = THERE * body.plan.spacing;
        let by_depth = |a: &&DVec3, b: &&DVec3| self.depth_of(**a).total_cmp(&self.depth_of(**b));
        let Some(&first) = self.places.iter().min_by(by_depth) else { return false };
        let is_behind = |x: &&DVec3| (**x - first).reject_from_normalized(self.side.normal).length() < near;
        let distances =
            self.places.iter().filter(is_behind).map(|x| self.depth_of(*x) - self.depth_of(first));
        let mut periods: Vec<f64> =
            distances.filter(|period| *period > near && *period < body.support).collect();
        periods.sort_by(f64::total_cmp);
        periods.into_iter().any(|period| self.repeats(period, near))
    }

    /// Distance of a place from the side, m.
    fn depth_of(&self, x: DVec3) -> f64 {
        let (axis, at) = self.side.plane;
        self.side.normal[axis] * (at - x[axis])
    }

    /// Whether all but the last layers are there once more after that distance, and all but the first before
    /// it.
    fn repeats(&self, period: f64, near: f64) -> bool {
        let layers = |from: f64, to: f64, shift: f64| -> Vec<DVec3> {
            let is_there = |x: &&DVec3| (from..to).contains(&(self.depth_of(**x) + near));
            self.places.iter().filter(is_there).map(|x| *x - shift * self.side.normal).collect()
        };
        let (first, next) = (layers(0.0, self.depth - period, period), layers(period, self.depth, 0.0));
        if first.is_empty() || first.len() != next.len() {
            return false;
        }
        let mut found = NeighborList::default();
        let (targets, sources) = (Cloud::uniform(&first, near), Cloud::uniform(&next, near));
        let search = NeighborSearch::default().between(targets, sources, 0.0, &Periodic::NONE, &mut found);
        search.is_ok() && (0..first.len()).all(|row| found.row(row).len() == 1)
    }
}
