//! Nodes near a surface, searched again when the bodies may have moved by the skin of the search.

use glam::DVec3;

use crate::contact::active::{Filter, MinimumLength};
use crate::contact::bodies::{ContactSides, NodeView};
use crate::contact::response::PairKey;
use crate::rigid::RigidBody;

/// Skin over the size of a node.
const SKIN: f64 = 1.0;
/// Gap, over the size of a node, up to which a node counts as near the surface. All that are so near are
/// candidates whenever the list was built, so that what follows from them follows from positions alone.
pub(in crate::contact) const NEAR: f64 = 0.5;

/// The nodes of a body that are near a surface.
pub(super) struct Nearby {
    /// Nodes that may touch, ascending, with zero for the surface.
    candidates: Vec<PairKey>,
    filter: Filter<PairKey, MinimumLength>,
    /// How far both bodies may move together until there are others, m, and how far they have.
    budget: f64,
    travelled: f64,
    /// Largest radius of a node, m, and how far nodes were stretched at most when the candidates were found.
    largest: f64,
    stretch: f64,
}

impl Nearby {
    /// None yet, of so many nodes with this largest radius, m.
    pub fn new(nodes: usize, largest: f64) -> Self {
        let (candidates, filter) = (Vec::with_capacity(nodes), Filter::new(nodes));
        Self { candidates, filter, budget: -1.0, travelled: 0.0, largest, stretch: 1.0 }
    }

    /// Nodes that may touch, ascending, with zero for the surface.
    pub fn candidates(&self) -> &[PairKey] {
        &self.candidates
    }

    /// Has the candidates searched again.
    pub fn forget(&mut self) {
        self.budget = -1.0;
    }

    /// Updates the bounds of the joint motion of the two bodies, m, and of the stretch of the nodes; searches
    /// the candidates again if they may have changed, and says whether it has.
    pub fn update(
        &mut self,
        sides: &ContactSides,
        nodes: &NodeView<'_>,
        tool: &RigidBody,
        distance: f64,
        stretch: f64,
    ) -> bool {
        self.travelled += distance;
        let used = self.travelled + self.largest * (stretch - self.stretch).max(0.0);
        // A distance that is not a number must not keep old candidates.
        let is_old = used.is_nan() || used > self.budget;
        if is_old {
            (self.travelled, self.stretch) = (0.0, stretch);
            self.budget = self.find(sides, nodes, tool);
        }
        is_old
    }

    /// Finds the nodes near the surface; returns how far both bodies may move together until others are, m.
    fn find(&mut self, sides: &ContactSides, nodes: &NodeView<'_>, tool: &RigidBody) -> f64 {
        let bounds = tool.surface.bounds();
        let largest_stretch = self.stretch;
        let budget =
            self.filter.select(nodes.len(), &mut self.candidates, &|i, budget: &mut MinimumLength| {
                let x = tool.reference(sides.near(nodes.position(i), tool));
                let size = nodes.size(i);
                let (reach, skin, near) = (largest_stretch * nodes.reach(i), SKIN * size, NEAR * size);
                let gap = (bounds.min - x).max(x - bounds.max).max(DVec3::ZERO).length() - reach;
                if gap < skin {
                    budget.add_length(skin - near);
                    (tool.surface.closest(x).signed_distance - reach < skin).then_some((i as u32, 0))
                } else {
                    budget.add_length(gap - near);
                    None
                }
            });
        budget.0
    }
}
