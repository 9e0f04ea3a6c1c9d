//! Which nodes are near a surface: found again when the bodies may have moved by the skin.

use glam::DVec3;

use super::node_view::NodeView;
use super::sides::Sides;
use crate::rigid::RigidBody;

/// Skin over the size of a node.
const SKIN: f64 = 1.0;
/// Gap, over the size of a node, up to which a node counts as near the surface. All that are so near are candidates whenever the list was made, so
/// that what follows from them follows from positions alone.
pub(super) const NEAR: f64 = 0.5;

/// The nodes of a body that are near a surface.
pub(super) struct Nearby {
    /// Nodes that may touch, ascending.
    candidates: Vec<u32>,
    budget: f64,
    travelled: f64,
    /// Largest radius of a node, m, and how far nodes were stretched at most when the candidates were found.
    largest: f64,
    stretch: f64,
}

impl Nearby {
    /// None yet, of nodes with this largest radius, m.
    pub fn new(largest: f64) -> Self {
        Self { candidates: Vec::new(), budget: -1.0, travelled: 0.0, largest, stretch: 1.0 }
    }

    /// Nodes that may touch, ascending.
    pub fn candidates(&self) -> &[u32] {
        &self.candidates
    }

    /// Takes in how far the two bodies may have moved together, m, and how far the nodes are stretched at most; finds the candidates anew if
    /// they may be others.
    pub fn update(
        &mut self,
        sides: &Sides,
        nodes: &NodeView<'_>,
        tool: &RigidBody,
        distance: f64,
        stretch: f64,
    ) {
        self.travelled += distance;
        let used = self.travelled + self.largest * (stretch - self.stretch).max(0.0);
        // A distance that is not a number must not keep old candidates.
        if used.is_nan() || used > self.budget {
            (self.travelled, self.stretch) = (0.0, stretch);
            self.budget = self.find(sides, nodes, tool);
        }
    }

    /// Finds the nodes near the surface; returns how far both bodies may move together until others are, m.
    fn find(&mut self, sides: &Sides, nodes: &NodeView<'_>, tool: &RigidBody) -> f64 {
        self.candidates.clear();
        self.candidates.reserve(nodes.len());
        let bounds = tool.surface.bounds();
        let mut budget = f64::INFINITY;
        for i in 0..nodes.len() {
            let x = tool.reference(sides.near(nodes.position(i), tool));
            let size = nodes.size(i);
            let (reach, skin, near) = (self.stretch * nodes.radius(i), SKIN * size, NEAR * size);
            let gap = (bounds.min - x).max(x - bounds.max).max(DVec3::ZERO).length() - reach;
            if gap < skin {
                budget = budget.min(skin - near);
                if tool.surface.closest(x).signed_distance - reach < skin {
                    self.candidates.push(i as u32);
                }
            } else {
                budget = budget.min(gap - near);
            }
        }
        budget
    }
}
