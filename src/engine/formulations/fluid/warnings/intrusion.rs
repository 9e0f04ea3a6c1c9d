//! Fluid particles inside of the boundaries of the flow.
//!
//! The position of a particle is mapped back to the reference configuration of the body, by the affine map
//! that fits the particles of the body around it, and compared with the shape there.

use glam::{DMat3, DVec3};

use crate::formulations::fluid::cloud::{FlowCloud, Group, part};
use crate::formulations::fluid::walls::apart;
use crate::linalg::dyad;
use crate::parallel::own_rows;
use crate::plugin::SimBuilder;
use crate::schedule::{Intruders, Step, StepError};
use crate::shapes::Region;
use crate::world::{BodyId, ParticleId, ReferencePosition};

/// Depth below the surface of a body at which a fluid particle is inside, over the spacing of the fluid.
pub const DEPTH: f64 = 0.5;
/// Distance of the nearest particle of a body beyond which a fluid particle is outside of it, over the
/// spacing of the body; the middle of a cube is 0.87 away.
const NEAREST: f64 = 0.9;

/// Checks for particles inside boundaries.
pub struct Intrusion {
    bodies: Vec<IntrudedShape>,
    /// Depth at which a particle is inside, m.
    min_depth: f64,
    /// Pairs of a fluid and a body, by number, that the user has been warned of, with the most particles at
    /// once.
    pub told: Vec<(usize, usize, u32)>,
}

/// The shape of a body that bounds the flow.
pub struct IntrudedShape {
    id: BodyId,
    pub region: Box<dyn Region>,
    /// Of its particles, m.
    pub spacing: f64,
    /// Whether it has lost particles.
    is_worn: bool,
}

impl Intrusion {
    /// The shapes of all bodies that have one, and the spacing of the fluid, m.
    pub fn new(sim: &SimBuilder<'_>, spacing: f64) -> Self {
        let body = |body: &crate::plugin::BodyPlan| {
            let shape = &sim.scene().bodies[body.id.0].shape;
            let region = shape.region(sim.dimension(), sim.folder(), "shape").ok()?;
            Some(IntrudedShape { id: body.id, region, spacing: body.spacing, is_worn: false })
        };
        let bodies = sim.bodies().iter().filter_map(body).collect();
        Self { bodies, min_depth: DEPTH * spacing, told: Vec::new() }
    }

    /// The shape of a body, if it is known and still the same.
    pub fn shape(&self, id: BodyId) -> Option<&IntrudedShape> {
        self.bodies.iter().find(|body| body.id == id && !body.is_worn)
    }

    /// Checks all particles, and warns of new ones.
    pub fn look(&mut self, cloud: &FlowCloud, step: &mut Step<'_>) -> Result<(), StepError> {
        for fluid in cloud.groups.iter().filter(|group| group.fluid().is_some()) {
            for other in cloud.groups.iter().filter(|group| group.fluid().is_none()) {
                let Some(body) = self.bodies.iter_mut().find(|body| body.id == other.body) else { continue };
                let reference = step.world.phase(other.phase).read::<ReferencePosition>()?;
                let reference = &reference[other.rows.clone()];
                body.is_worn |=
                    cloud.records[other.cloud.clone()].iter().any(|record| record.volume() <= 0.0);
                let body = &*body;
                if let Some(deepest) = deepest(cloud, [fluid, other], body, reference, self.min_depth) {
                    self.warn([fluid, other], &deepest, cloud, step)?;
                }
            }
        }
        Ok(())
    }

    fn warn(
        &mut self,
        [fluid, other]: [&Group; 2],
        deepest: &Intruders,
        cloud: &FlowCloud,
        step: &mut Step<'_>,
    ) -> Result<(), StepError> {
        let key = (fluid.body.0, other.body.0);
        if let Some((_, _, most)) = self.told.iter_mut().find(|(fluid, body, _)| (*fluid, *body) == key) {
            *most = deepest.count.max(*most);
            return Ok(());
        }
        self.told.push((key.0, key.1, deepest.count));
        let id = step.world.phase(fluid.phase).read::<ParticleId>()?[fluid.rows.start + deepest.row].0;
        let names = [fluid, other].map(|group| &step.world.body(group.body).name[..]);
        let x = cloud.records[fluid.cloud.start + deepest.row].position();
        step.warnings.push(format!(
            "{}: nothing may enter a body; more particles across it, a larger `sound_speed`, `density_diffusion()` or a \
             smaller step may keep them out",
            deepest.text(id, names, x, step.clock.time)
        ));
        Ok(())
    }
}

/// The deepest particle of a fluid in a boundary body; every rank checks its own.
fn deepest(
    cloud: &FlowCloud,
    [fluid, other]: [&Group; 2],
    body: &IntrudedShape,
    reference: &[ReferencePosition],
    min_depth: f64,
) -> Option<Intruders> {
    let beside = BoundingBody { cloud, group: other, spacing: body.spacing, reference };
    let mut found = None;
    for i in own_rows(&fluid.cloud).filter(|i| cloud.records[*i].volume() > 0.0) {
        let row = i - fluid.cloud.start;
        let near = part(cloud.near_row(i), &other.cloud);
        let Some(place) = beside.place_in_body(i, near) else { continue };
        // The shape is not that of a body that has lost particles.
        if body.is_worn && !is_enclosed(cloud, i, near, body.spacing) {
            continue;
        }
        let depth = -body.region.distance(place);
        if depth < min_depth {
            continue;
        }
        Intruders::add(&mut found, row, depth);
    }
    Intruders::of_ranks(found)
}

/// A body that bounds the flow, and where its particles are in the scene.
struct BoundingBody<'a> {
    cloud: &'a FlowCloud,
    group: &'a Group,
    spacing: f64,
    reference: &'a [ReferencePosition],
}

impl BoundingBody<'_> {
    /// Where fluid particle `i` would be in the body as the scene has it; none if it is not among the
    /// particles of it that are near.
    fn place_in_body(&self, i: usize, near: &[u32]) -> Option<DVec3> {
        let Self { cloud, group, spacing, reference } = *self;
        let position = |j: u32| cloud.records[j as usize].position();
        let from = cloud.records[i].position();
        let away = |j: u32| -cloud.offset(from, position(j));
        let is_there = |j: &u32| cloud.records[*j as usize].volume() > 0.0;
        let nearest = near
            .iter()
            .copied()
            .filter(is_there)
            .min_by(|a, b| away(*a).length().total_cmp(&away(*b).length()))?;
        let x = away(nearest);
        if x.length() > NEAREST * spacing {
            return None;
        }
        let (mut moment, mut map) = (DMat3::ZERO, DMat3::ZERO);
        for &j in near.iter().filter(|j| is_there(j)) {
            let [now, home] = apart(cloud, group, reference, from, [nearest, j]);
            moment += dyad(now, now);
            map += dyad(home, now);
        }
        if cloud.plane {
            moment.z_axis.z = 1.0;
            map.z_axis.z = 1.0;
        }
        // Too few particles to fit a map to: those of a body that has barely moved.
        let fits = moment.determinant() > 1e-6 * spacing.powi(if cloud.plane { 4 } else { 6 });
        let moved = if fits { map * (moment.inverse() * x) } else { x };
        Some(reference[nearest as usize - group.cloud.start].0 + moved)
    }
}

/// Mean direction of the particles of a body, over the sum of their distances, below which they surround a
/// fluid particle.
const ENCLOSED: f64 = 0.1;
/// Distance of the nearest of them beyond which it is not among them, over their spacing; the middle of a
/// square is 0.71 away.
const AMONG: f64 = 0.75;
/// Distance of a removed particle within which a fluid particle is in its place, over their spacing: the
/// sides of a crack come together again.
const IN_PLACE: f64 = 1.5;

/// Whether the particles of a body that are left surround a fluid particle, away from those removed.
fn is_enclosed(cloud: &FlowCloud, i: usize, near: &[u32], spacing: f64) -> bool {
    let from = cloud.records[i].position();
    let (mut sum, mut total, mut nearest) = (DVec3::ZERO, 0.0, f64::INFINITY);
    for other in near.iter().map(|&j| &cloud.records[j as usize]) {
        let x = cloud.offset(from, other.position());
        if other.volume() <= 0.0 {
            if x.length() < IN_PLACE * spacing {
                return false;
            }
            continue;
        }
        let weight = other.volume() * cloud.kernel.weight(x.length());
        sum += weight * x;
        total += weight * x.length();
        nearest = nearest.min(x.length());
    }
    // In a crack that is a particle wide, both sides are farther away.
    nearest < AMONG * spacing && sum.length() < ENCLOSED * total
}
