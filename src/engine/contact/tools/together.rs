//! Dashpots of several contacts of one rigid body.
//!
//! The coefficient of a dashpot follows from its spring and the mass that it moves. The points of a flat face
//! move one mass together: with the whole mass for each, a block on n of them would be damped sqrt(n) times
//! as much as a linear oscillator of that restitution, and the step would be unstable for large n. So the
//! mass of a contact is `1/w_i` over its share,
//!
//! ```text
//! share_i = n_i . (response at i to all forces k_j n_j) / (k_i w_i)        k = stiffness, n = normal, w = inverse mass along it
//! ```
//!
//! which is one for a single contact, and n for n equal ones. The dashpots of a face together then have the
//! coefficient that belongs to all of its springs, and act on the velocity that results from all of them.
//!
//! The response is to the forces between the two bodies (of the points of both on the surface of the other),
//! or to all contact forces on them, whichever is larger: a body may lie on several others side by side, or
//! between two others.

use glam::DVec3;

use crate::contact::bodies::NodeView;
use crate::parallel::BlockSum;
use crate::rigid::{RigidBody, Wrench};

/// A contact as far as the others are concerned.
#[derive(Clone, Copy)]
pub(super) struct ContactSite {
    /// Where the surface is pushed, m, and from there to where the node is.
    pub place: DVec3,
    pub shift: DVec3,
    pub normal: DVec3,
    /// Stiffness, N/m.
    pub stiffness: f64,
}

/// Response of two bodies to the springs of contacts for one metre, about the centres of the rigid ones.
#[derive(Clone, Copy, Debug, Default)]
pub(in crate::contact) struct CoupledResponse {
    pub on_node: Wrench,
    pub on_tool: Wrench,
}

impl BlockSum for CoupledResponse {
    fn add(&mut self, next: &Self) {
        self.on_node.add(&next.on_node);
        self.on_tool.add(&next.on_tool);
    }
}

impl CoupledResponse {
    /// The response to one contact.
    pub(super) fn of(spot: &ContactSite, nodes: &NodeView<'_>, tool: &RigidBody) -> Self {
        let force = spot.stiffness * spot.normal;
        let mut together = Self::default();
        together.on_tool.push(spot.place - tool.state.center, -force);
        if let NodeView::Rigid(body) = nodes {
            together.on_node.push(spot.place + spot.shift - body.state.center, force);
        }
        together
    }

    /// Those between the two bodies, of the points of both, and all that are on them.
    pub fn with_others(mut self, beside: Option<Self>, nodes: &NodeView<'_>, tool: &RigidBody) -> [Self; 2] {
        beside.iter().for_each(|beside| self.add(beside));
        let on_node = match nodes {
            NodeView::Rigid(body) => body.contact_stiffness,
            NodeView::Particles(_) => Wrench::default(),
        };
        [self, Self { on_node, on_tool: tool.contact_stiffness }]
    }

    /// The same, of the other body on the surface of this one.
    pub fn turned_around(self) -> Self {
        Self { on_node: self.on_tool, on_tool: self.on_node }
    }

    /// The share of a contact whose inverse mass is `alone`, 1/kg, of which `own` is that of a particle.
    pub(super) fn share(
        &self,
        spot: &ContactSite,
        nodes: &NodeView<'_>,
        tool: &RigidBody,
        alone: f64,
        own: f64,
    ) -> f64 {
        let of_node = match nodes {
            NodeView::Rigid(body) => {
                spot.normal.dot(body.response_at(spot.place + spot.shift, &self.on_node))
            }
            NodeView::Particles(_) => spot.stiffness * own,
        };
        let of_tool = spot.normal.dot(tool.response_at(spot.place, &self.on_tool));
        let share = (of_node - of_tool) / (spot.stiffness * alone);
        // Where springs begin without stiffness, or beside a contact that others turn away, it is alone.
        if share.is_finite() { share.max(1.0) } else { 1.0 }
    }
}
