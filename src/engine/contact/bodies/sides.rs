//! The two sides of a contact with a rigid body: nodes and a surface.

use glam::DVec3;

use super::error::failed;
use super::members::{MemberColumns, MemberParticles};
use super::node_view::{NodeTurn, NodeView};
use super::shape::Proximity;
use crate::neighbors::Periodic;
use crate::rigid::{RigidBodies, RigidBody};
use crate::schedule::{Resources, StepError};
use crate::shapes::SurfacePoint;
use crate::symmetry::Repeat;
use crate::world::{BodyId, World};

/// Where the nodes are.
#[derive(Clone)]
pub(in crate::contact) enum SideNodes {
    /// Particles.
    Particles(MemberParticles),
    /// The points of a rigid body.
    Rigid,
}

impl SideNodes {
    /// The particles, if they are.
    pub fn particles(&self) -> Option<&MemberParticles> {
        match self {
            Self::Particles(particles) => Some(particles),
            Self::Rigid => None,
        }
    }
}

/// The nodes of one body and the surface of another.
#[derive(Clone)]
pub(in crate::contact) struct ContactSides {
    /// Body with the nodes.
    pub first: BodyId,
    pub nodes: SideNodes,
    /// Rigid body with the surface.
    pub second: BodyId,
    /// Which of the contacts of a pair of rigid bodies it is.
    pub turn: NodeTurn,
    /// Periodic axes: the image of a node that is nearest to the centre of the surface's body touches it.
    pub periodic: Periodic,
    /// The periods that the body with the surface fills.
    pub seams: Vec<Repeat>,
}

/// How near to the end of a period a point of a surface counts as one of the side there, over the period, and
/// cosine of its normal from which on it does.
const AT_SEAM: f64 = 1e-6;
const TO_SEAM: f64 = 0.5;
/// Shares of the way to the middle of the body at which the surface is looked for in place of a point near
/// its end.
const INWARD: [f64; 2] = [0.03, 0.25];

/// Overlap at the start that is let pass, over the radius of a node, and over the spacing of nodes without
/// radius.
const RADIUS_SHARE: f64 = 0.5;
const SPACING_SHARE: f64 = 0.05;

impl ContactSides {
    /// Calls `f` with the nodes and the body with the surface.
    pub fn with<T>(
        &self,
        world: &World,
        resources: &Resources,
        bodies: &RigidBodies,
        f: impl FnOnce(&NodeView<'_>, &RigidBody) -> T,
    ) -> Result<T, StepError> {
        let tool = find(bodies, self.second)?;
        Ok(match &self.nodes {
            SideNodes::Rigid => f(&NodeView::Rigid(find(bodies, self.first)?), tool),
            SideNodes::Particles(particles) => {
                let columns = MemberColumns::new(particles, world, resources)?;
                f(&NodeView::Particles(columns.members()), tool)
            }
        })
    }

    /// The image of a place that is nearest to the body with the surface, m.
    pub fn near(&self, x: DVec3, tool: &RigidBody) -> DVec3 {
        if self.periodic.any() {
            tool.state.center + self.periodic.minimal_image(x - tool.state.center)
        } else {
            x
        }
    }

    /// The nearest point of the surface to that image of a place which is nearest to its body, in the
    /// reference configuration of the body. Where the body spans a period its ends are no surface: it
    /// continues beyond them.
    pub fn closest(&self, x: DVec3, tool: &RigidBody) -> SurfacePoint {
        self.closest_to(tool.reference(self.near(x, tool)), tool)
    }

    /// The same of a place of the body as it is at the start.
    pub fn closest_at_start(&self, x: DVec3, tool: &RigidBody) -> SurfacePoint {
        let center = tool.reference_center;
        let image = if self.periodic.any() { center + self.periodic.minimal_image(x - center) } else { x };
        self.closest_to(image, tool)
    }

    fn closest_to(&self, at: DVec3, tool: &RigidBody) -> SurfacePoint {
        let mut found = tool.surface.closest(at);
        for seam in &self.seams {
            let (axis, [min, max]) = (seam.axis(), seam.sides());
            let is_end = |found: &SurfacePoint| {
                let is_at = |end: f64| (found.point[axis] - end).abs() < AT_SEAM * (max - min);
                found.normal[axis].abs() > TO_SEAM && (is_at(min) || is_at(max))
            };
            // Farther inside the end is no longer the nearest surface.
            for share in INWARD {
                if is_end(&found) {
                    let mut way = DVec3::ZERO;
                    way[axis] = share * (0.5 * (min + max) - at[axis]);
                    let inside = tool.surface.closest(at + way);
                    let point = inside.point - if is_end(&inside) { DVec3::ZERO } else { way };
                    found = SurfacePoint { point, ..inside };
                }
            }
        }
        found
    }

    /// How far two rigid bodies are apart at least, m, by the balls around their centres; zero for particles
    /// and unbounded bodies.
    pub fn gap(&self, nodes: &NodeView<'_>, tool: &RigidBody) -> f64 {
        let NodeView::Rigid(body) = nodes else { return 0.0 };
        if !(tool.surface.bounds().is_bounded() && body.surface.bounds().is_bounded()) {
            return 0.0;
        }
        let distance = self.near(body.state.center, tool).distance(tool.state.center);
        (distance - body.bounding_radius - tool.bounding_radius).max(0.0)
    }

    /// Place of the first node that is deeper inside the other body than one may start, m.
    pub fn inside(&self, nodes: &NodeView<'_>, tool: &RigidBody) -> Option<DVec3> {
        let deep = |i: usize, x: DVec3| {
            let x = self.near(x, tool);
            let Some(nearest) = nodes.nearest(i, x, tool) else { return false };
            let Proximity { overlap, .. } = nodes.nearness(i, nearest.signed_distance, nearest.normal);
            if !nodes.reaches(i, x, nearest.normal, tool) {
                return false;
            }
            let radius = nodes.radius(i);
            overlap > if radius > 0.0 { RADIUS_SHARE * radius } else { SPACING_SHARE * nodes.size(i) }
        };
        (0..nodes.len()).map(|i| (i, nodes.position(i))).find(|&(i, x)| deep(i, x)).map(|(_, x)| x)
    }
}

fn find(bodies: &RigidBodies, id: BodyId) -> Result<&RigidBody, StepError> {
    bodies.of(id).ok_or_else(|| failed(format!("body {} is not rigid", id.0)))
}
