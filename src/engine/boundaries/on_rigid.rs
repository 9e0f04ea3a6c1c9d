//! Loads on rigid bodies act on the surface; the particles lie half a spacing inside.

use glam::DVec3;

use super::part::Part;
use crate::parallel::{BlockSum, sum_over_blocks};
use crate::plugin::{BodyKind, BodyPlan, Selection, SetupError, SimBuilder};
use crate::rigid::{RigidBodies, RigidState, Wrench};
use crate::scene::{Face, Select};
use crate::schedule::Step;
use crate::shapes::Region;
use crate::skins::selected_facets;
use crate::world::BodyId;

/// Distance from the surface, over the spacing, up to which a point is on it.
const ON: f64 = 0.2;

/// Length of the facets in which a part of a face is measured, over the spacing.
const FACETS: f64 = 0.5;

/// The stated part of a face.
#[derive(Clone, Copy)]
pub(super) struct FacePart {
    /// m2; m in two dimensions.
    pub area: f64,
    /// m.
    pub middle: DVec3,
}

/// The part of a `face` of a rigid body that is `within` a shape. Its particles are a part that ends between
/// particles, up to half a spacing away.
///
/// # Errors
/// The shape of the selection is not one of this dimension.
pub(super) fn face_part(
    select: &Select,
    id: BodyId,
    sim: &SimBuilder<'_>,
) -> Result<Option<FacePart>, SetupError> {
    let (body, shape) = (sim.body(id), &sim.scene().bodies[id.0].shape);
    let is_part = select.face.is_some() && select.within.is_some() && select.nearest.is_none();
    if body.kind != BodyKind::Rigid || !is_part {
        return Ok(None);
    }
    let Some(facets) = shape.facets(sim.dimension(), sim.folder(), FACETS * body.spacing) else {
        return Ok(None);
    };
    let (mut area, mut moment) = (0.0, DVec3::ZERO);
    for loaded in selected_facets(select, id, &facets, &[], sim)? {
        let part = loaded.share * facets.normal_and_measure(loaded.facet as usize).1;
        area += part;
        moment += part * loaded.middle(&facets);
    }
    Ok((area > 0.0).then(|| FacePart { area, middle: moment / area }))
}

/// From the selected particles of every body to the points on which a load acts, in the reference
/// configuration, m; none for bodies that deform. That is the stated point of a selection by `nearest`, and
/// the foot of the particle on the side of one by `face`; on a part of a face the feet are moved together, so
/// that their middle is that of the part. Where the shape has no such point, a load acts on the particle
/// itself.
///
/// # Errors
/// The shape of the selection is not one of this dimension.
pub(super) fn arms_of(
    select: &Select,
    selection: &Selection,
    sim: &SimBuilder<'_>,
) -> Result<Vec<Vec<DVec3>>, SetupError> {
    let of = |(id, rows): &(BodyId, Vec<u32>)| {
        let body = sim.body(*id);
        let shape = &sim.scene().bodies[id.0].shape;
        let is_beside = select.nearest.is_some() || select.face.is_some();
        if body.kind != BodyKind::Rigid || !is_beside {
            return Ok(Vec::new());
        }
        let Ok(region) = shape.region(sim.dimension(), sim.folder(), "shape") else { return Ok(Vec::new()) };
        let particle = |row: u32| body.sites[row as usize - body.rows.start].position;
        let mut arms: Vec<DVec3> =
            rows.iter().map(|&row| arm(select, particle(row), body, &*region)).collect();
        if let Some(part) = face_part(select, *id, sim)? {
            let feet = rows.iter().zip(&arms).map(|(&row, arm)| particle(row) + *arm);
            let beside = part.middle - feet.sum::<DVec3>() / rows.len() as f64;
            arms.iter_mut().for_each(|arm| *arm += beside);
        }
        Ok(arms)
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

/// Adds the torques that forces have about the particles of a rigid body, beside which they act. The forces
/// are those at both ends of the step, N, on the particles of a part. Returns the power of all of them, W: of
/// the first at the places that the body leaves in this step, of the second at those that it reaches, which
/// is what the two kicks spend. With the places of one end, it would be off by half the angle of a step.
pub(super) fn push_beside(part: &Part, arms: &[DVec3], [last, next]: [&[DVec3]; 2], step: &Step<'_>) -> f64 {
    let mut bodies = step.resources.get_mut::<RigidBodies>();
    let Some(body) = bodies.of_mut(part.body).filter(|body| !body.state.gone) else {
        return 0.0;
    };
    let (turn, center) = (body.state.rotation, body.reference_center);
    let left = body.left;
    let rows = (&part.points[..], last, next);
    let sums = sum_over_blocks(rows, &|first, (points, last, next): (&[DVec3], &[DVec3], &[DVec3])| {
        let mut sums = OnRigid::default();
        for (k, ((point, last), next)) in points.iter().zip(last).zip(next).enumerate() {
            let beside = arms.get(first + k).copied().unwrap_or_default();
            let arm = *point - center + beside;
            sums.last.push(left.rotation * arm, *last);
            let turned = turn * arm;
            sums.next.push(turned, *next);
            sums.add_moments([next.x, next.y, next.z].map(|force| turned * force));
            sums.beside += (turn * beside).cross(*next);
        }
        sums
    });
    body.push(&Wrench { force: DVec3::ZERO, torque: sums.beside });
    (0..3).for_each(|axis| body.load_moments[axis] += sums.moments[axis]);
    let RigidState { velocity, angular_velocity, .. } = body.state;
    let spent = |sum: Wrench, spin: DVec3| 0.5 * (sum.force.dot(velocity) + sum.torque.dot(spin));
    spent(sums.last, left.angular_velocity) + spent(sums.next, angular_velocity)
}

/// Forces of a load on a rigid body, with their torques about its centre, at both ends of a step.
#[derive(Clone, Copy, Default)]
struct OnRigid {
    last: Wrench,
    next: Wrench,
    /// Torque at the end of the step that the forces have about their particles, N m.
    beside: DVec3,
    /// Sum of the arms times the components of the forces at the end of the step, N m.
    moments: [DVec3; 3],
}

impl OnRigid {
    fn add_moments(&mut self, moments: [DVec3; 3]) {
        self.moments.iter_mut().zip(moments).for_each(|(sum, moment)| *sum += moment);
    }
}

impl BlockSum for OnRigid {
    fn add(&mut self, next: &Self) {
        self.last.add(&next.last);
        self.next.add(&next.next);
        self.beside += next.beside;
        self.add_moments(next.moments);
    }
}
