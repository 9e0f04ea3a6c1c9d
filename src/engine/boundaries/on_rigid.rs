//! Loads on rigid bodies act on the surface; the particles lie half a spacing inside.

use glam::DVec3;

use crate::plugin::{BodyKind, BodyPlan, Selection, SimBuilder};
use crate::rigid::{RigidBodies, Wrench};
use crate::scene::{Face, Select};
use crate::schedule::Step;
use crate::shapes::Region;
use crate::world::BodyId;

/// Distance from the surface, over the spacing, up to which a point is on it.
const ON: f64 = 0.2;

/// From the selected particles of every body to the points on which a load acts, in the reference
/// configuration, m; none for bodies that deform. That is the stated point of a selection by `nearest`, and
/// the foot of the particle on the side of one by `face`. Where the shape has no such point, a load acts on
/// the particle itself.
pub(super) fn arms_of(select: &Select, selection: &Selection, sim: &SimBuilder<'_>) -> Vec<Vec<DVec3>> {
    let of = |(id, rows): &(BodyId, Vec<u32>)| {
        let body = sim.body(*id);
        let shape = &sim.scene().bodies[id.0].shape;
        let is_beside = select.nearest.is_some() || select.face.is_some();
        if body.kind != BodyKind::Rigid || !is_beside {
            return Vec::new();
        }
        let Ok(region) = shape.region(sim.dimension(), sim.folder(), "shape") else { return Vec::new() };
        let arm =
            |&row: &u32| arm(select, body.sites[row as usize - body.rows.start].position, body, &*region);
        rows.iter().map(arm).collect()
    };
    selection.parts.iter().map(of).collect()
}

fn arm(select: &Select, particle: DVec3, body: &BodyPlan, region: &dyn Region) -> DVec3 {
    let point = if let Some(point) = select.nearest {
        point.0
    } else if let Some((axis, sign)) = select.face.map(Face::outward) {
        let mut foot = particle;
        foot[axis] = if sign > 0.0 { body.bounds.max[axis] } else { body.bounds.min[axis] };
        foot
    } else {
        particle
    };
    if region.distance(point) <= ON * body.spacing { point - particle } else { DVec3::ZERO }
}

/// Adds what forces do beside the particles of a rigid body: their torques about these. `forces` are those at
/// the ends of the step, N. Returns the power of their mean, W.
pub(super) fn push_beside(id: BodyId, arms: &[DVec3], [last, next]: [&[DVec3]; 2], step: &Step<'_>) -> f64 {
    let resources = step.resources;
    let mut bodies = resources.get_mut::<RigidBodies>();
    let Some(body) = bodies.iter_mut().find(|body| body.id == id) else { return 0.0 };
    let (turn, spin) = (body.state.rotation, body.state.angular_velocity);
    let (mut torque, mut power) = (DVec3::ZERO, 0.0);
    for ((arm, last), next) in arms.iter().zip(last).zip(next) {
        let arm = turn * *arm;
        torque += arm.cross(*next);
        power += 0.5 * (*last + *next).dot(spin.cross(arm));
    }
    body.push(&Wrench { force: DVec3::ZERO, torque });
    power
}
