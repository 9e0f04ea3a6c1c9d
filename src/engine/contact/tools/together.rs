//! Dashpots that move one rigid body together.
//!
//! A dashpot is as strong as its spring and the mass that it moves require. The points of a flat face move one mass together: if each took it for its own, a block on n of them would be damped sqrt(n) times as much as
//! a linear oscillator of that restitution, and thrown away where that is more than a step can bear. So a contact counts as if it moved `1/w_i` over its share,
//!
//! ```text
//! share_i = n_i . (response at i to all forces k_j n_j) / (k_i w_i)        k = stiffness, n = normal, w = inverse mass along it
//! ```
//!
//! which is one for a contact alone, and n for n equal ones. The dashpots of a face then are together that of its springs, and act on the velocity that all of them leave.

use glam::DVec3;

use crate::contact::bodies::NodeView;
use crate::parallel::BlockSum;
use crate::rigid::{RigidBody, Wrench};

/// A contact as far as the others are concerned.
#[derive(Clone, Copy)]
pub(super) struct Spot {
    /// Where the surface is pushed, m, and from there to where the node is.
    pub place: DVec3,
    pub shift: DVec3,
    pub normal: DVec3,
    /// Stiffness, N/m.
    pub stiffness: f64,
}

/// What the springs of all contacts of two bodies do to them by one metre, about the centres of the rigid ones.
#[derive(Clone, Copy, Debug, Default)]
pub(in crate::contact) struct Together {
    on_node: Wrench,
    on_tool: Wrench,
}

impl BlockSum for Together {
    fn add(&mut self, next: &Self) {
        self.on_node.add(&next.on_node);
        self.on_tool.add(&next.on_tool);
    }
}

impl Together {
    /// What one contact does.
    pub fn of(spot: &Spot, nodes: &NodeView<'_>, tool: &RigidBody) -> Self {
        let force = spot.stiffness * spot.normal;
        let mut together = Self::default();
        together.on_tool.push(spot.place - tool.state.center, force);
        if let NodeView::Rigid(body) = nodes {
            together.on_node.push(spot.place + spot.shift - body.state.center, force);
        }
        together
    }

    /// The share of a contact whose inverse mass is `alone`, 1/kg, of which `own` is that of a particle.
    pub fn share(&self, spot: &Spot, nodes: &NodeView<'_>, tool: &RigidBody, alone: f64, own: f64) -> f64 {
        let of_node = match nodes {
            NodeView::Rigid(body) => {
                spot.normal.dot(body.response_at(spot.place + spot.shift, &self.on_node))
            }
            NodeView::Particles(_) => spot.stiffness * own,
        };
        let of_tool = spot.normal.dot(tool.response_at(spot.place, &self.on_tool));
        let share = (of_node + of_tool) / (spot.stiffness * alone);
        // Where springs begin without stiffness, or beside a contact that others turn away, it is alone.
        if share.is_finite() { share.max(1.0) } else { 1.0 }
    }
}
