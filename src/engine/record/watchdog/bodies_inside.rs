//! Particles of a body inside of another one that it touches: contact that does not hold them apart.
//!
//! Contact acts at points of surfaces, a fraction of a spacing apart, which move with the particles behind
//! them. An edge that is sharper, or a part that is thinner, than that spacing passes between them, or the
//! surface follows it and particles do not.
//!
//! The distance from a rigid body is that from its exact surface. A place in a deformable body is mapped back
//! to the reference configuration by the deformation gradient of the nearest particle, and compared with the
//! shape there. As bodies may have been cut or torn, particles of the body also have to surround the place.
//! Failed particles do not count: debris flies anywhere, and its deformation gradients say nothing of where
//! the body is.

use glam::DVec3;

use super::particles_in::{ParticlesIn, bounds, holds};
use crate::neighbors::{Cloud, NeighborList, NeighborSearch, Periodic};
use crate::plugin::{BodyKind, BodyPlan, SimBuilder};
use crate::rigid::{RigidBodies, RigidBody};
use crate::schedule::{Intruders, Step, StepError};
use crate::shapes::{Aabb, Region};
use crate::world::{BodyId, Damage, DeformationGradient, ParticleId, Position, ReferencePosition, Removed};

/// Depth below a surface at which a particle is inside, over the spacing of the deformable body. Particles
/// begin as deep behind their own surface, so that surfaces then overlap by a whole spacing.
const DEPTH: f64 = 0.5;
/// Range of the particles that may surround a place, over their spacing, and distance of the nearest one
/// beyond which the place is not among them; the middle of a cube is 0.87 away.
const RANGE: f64 = 2.0;
const NEAREST: f64 = 0.9;
/// Mean direction of the particles around a place over their mean distance, up to which they surround it: at
/// the outermost particles of a flat side it is about 0.5.
const ENCLOSED: f64 = 0.3;

/// Checks for particles inside other bodies.
pub(super) struct BodiesInside {
    pairs: Vec<[BodyId; 2]>,
    /// Shapes in the reference configuration of the deformable bodies among them.
    solids: Vec<(BodyId, Box<dyn Region>)>,
    spacings: Vec<f64>,
    /// Whether each body ends somewhere: half-spaces do not.
    is_bounded: Vec<bool>,
    periodic: Periodic,
    /// The box around each body of a pair; none where a body has no end, or its images count as well.
    boxes: Vec<Option<Aabb>>,
    near: NearParticles,
    /// Pairs that the user has been warned of.
    pub told: Vec<bool>,
}

/// Particles of two bodies near each other: of one the particles, and which of the other are around them.
#[derive(Default)]
struct NearParticles {
    particles: ParticlesIn,
    others: ParticlesIn,
    search: NeighborSearch,
    around: NeighborList,
}

impl BodiesInside {
    /// All pairs of solids, rigid bodies and walls that have a contact.
    pub fn new(sim: &SimBuilder<'_>) -> Self {
        let is_solid = |body: &BodyPlan| body.kind == BodyKind::Solid;
        // The distance from a rigid body is the exact one.
        let solid_first = |a: &BodyPlan, b: &BodyPlan| {
            let [a, b] = if a.id.0 < b.id.0 { [a, b] } else { [b, a] };
            let [a, b] = if is_solid(a) || !is_solid(b) { [a, b] } else { [b, a] };
            [a.id, b.id]
        };
        let of = |(_, pair): (usize, [BodyId; 2])| {
            let [a, b] = pair.map(|body| sim.body(body));
            let are_two = a.id != b.id && [a, b].iter().all(|body| body.kind != BodyKind::Fluid);
            are_two.then(|| solid_first(a, b))
        };
        let mut pairs: Vec<[BodyId; 2]> = sim.contact_pairs().filter_map(of).collect();
        pairs.sort_unstable();
        pairs.dedup();
        let shape = |id: &BodyId| {
            let shape = &sim.scene().bodies[id.0].shape;
            Some((*id, shape.region(sim.dimension(), sim.folder(), "shape").ok()?))
        };
        let mut solids: Vec<BodyId> =
            pairs.iter().flatten().copied().filter(|id| is_solid(sim.body(*id))).collect();
        solids.sort_unstable();
        solids.dedup();
        Self {
            solids: solids.iter().filter_map(shape).collect(),
            spacings: sim.bodies().iter().map(|body| body.spacing).collect(),
            is_bounded: sim.bodies().iter().map(|body| body.bounds.is_bounded()).collect(),
            periodic: sim.periodic(),
            boxes: vec![None; sim.bodies().len()],
            near: NearParticles::default(),
            told: vec![false; pairs.len()],
            pairs,
        }
    }

    /// Checks all pairs that have not been warned of.
    ///
    /// # Errors
    /// A column is missing.
    pub fn look(&mut self, step: &mut Step<'_>) -> Result<(), StepError> {
        self.find_boxes(step)?;
        for number in 0..self.pairs.len() {
            let [a, b] = self.pairs[number];
            let are_apart = self.boxes[a.0]
                .zip(self.boxes[b.0])
                .is_some_and(|(a, b)| (a.max.cmplt(b.min) | b.max.cmplt(a.min)).any());
            for pair in [[a, b], [b, a]] {
                if !are_apart
                    && !self.told[number]
                    && let Some(found) = self.inside(step, pair)?
                {
                    self.told[number] = true;
                    self.warn(step, &found, pair)?;
                }
            }
        }
        Ok(())
    }

    fn find_boxes(&mut self, step: &Step<'_>) -> Result<(), StepError> {
        let Self { pairs, spacings, is_bounded, boxes, periodic, .. } = self;
        boxes.fill(None);
        if periodic.any() {
            return Ok(());
        }
        for &body in pairs.iter().flatten().filter(|body| is_bounded[body.0]) {
            if boxes[body.0].is_none() {
                boxes[body.0] = Some(bounds(step, body)?.grown(spacings[body.0]));
            }
        }
        Ok(())
    }

    fn warn(&self, step: &mut Step<'_>, found: &Intruders, pair: [BodyId; 2]) -> Result<(), StepError> {
        let (view, rows) = step.world.body_view(pair[0]);
        let row = rows.start + found.row;
        let (id, x) = (view.read::<ParticleId>()?[row].0, view.read::<Position>()?[row].0);
        let names = pair.map(|body| &step.world.body(body).name[..]);
        let is_solid = |body: &BodyId| self.solids.iter().any(|(solid, _)| solid == body);
        let what_to_do = match pair.each_ref().map(is_solid) {
            [false, false] => "take a stiffer law or shorter steps".to_owned(),
            [true, true] => finer("both"),
            [true, false] => finer(&format!("`{}`", names[0])),
            [false, true] => finer(&format!("`{}`", names[1])),
        };
        step.warnings.push(format!(
            "{}: contact does not hold them apart there, and its forces may be off by half or more; {what_to_do}",
            found.text(id, names, x, step.clock.time)
        ));
        Ok(())
    }

    /// The particles of the first body inside of the second.
    fn inside(
        &mut self,
        step: &Step<'_>,
        [body, other]: [BodyId; 2],
    ) -> Result<Option<Intruders>, StepError> {
        if let Some((_, region)) = self.solids.iter().find(|(solid, _)| *solid == other) {
            let spacing = self.spacings[other.0];
            return InSolid { step, solid: other, region: &**region, spacing, periodic: &self.periodic }
                .particles_of(body, &mut self.near);
        }
        // A wall has particles alone, which a deformable body may have inside.
        let Some(bodies) = step.resources.try_get::<RigidBodies>() else { return Ok(None) };
        let Ok(at) = bodies.binary_search_by_key(&other, |tool| tool.id) else { return Ok(None) };
        let tool = &bodies[at];
        if tool.state.gone {
            return Ok(None);
        }
        in_rigid(step, body, tool, DEPTH * self.spacings[body.0], &self.periodic)
    }
}

/// What to do where contact of a deformable body fails.
fn finer(solid: &str) -> String {
    format!(
        "round edges and tips to some spacings and make thin parts thicker than one, or take smaller particles in {solid}, or a stiffer law"
    )
}

/// The particles of a body deeper than `depth`, m, below the surface of a rigid one.
fn in_rigid(
    step: &Step<'_>,
    body: BodyId,
    tool: &RigidBody,
    depth: f64,
    periodic: &Periodic,
) -> Result<Option<Intruders>, StepError> {
    let (view, rows) = step.world.body_view(body);
    let (position, removed) = (view.read::<Position>()?, view.read::<Removed>()?);
    let bounds = tool.surface.bounds();
    let mut found = None;
    for (row, (x, removed)) in position[rows.clone()].iter().zip(&removed[rows]).enumerate() {
        let image = tool.state.center + periodic.minimal_image(x.0 - tool.state.center);
        let x = tool.reference(image);
        if *removed != Removed::NO || !holds(&bounds, x) {
            continue;
        }
        let below = -tool.surface.closest(x).signed_distance;
        if below > depth {
            Intruders::add(&mut found, row, below);
        }
    }
    Ok(found)
}

/// The inside of a deformable body.
struct InSolid<'a> {
    step: &'a Step<'a>,
    solid: BodyId,
    region: &'a dyn Region,
    spacing: f64,
    periodic: &'a Periodic,
}

impl InSolid<'_> {
    /// The particles of another body in it.
    fn particles_of(&self, body: BodyId, near: &mut NearParticles) -> Result<Option<Intruders>, StepError> {
        let Self { step, solid, region, spacing, periodic } = *self;
        let NearParticles { particles, others, search, around } = near;
        let open = |bounds: Aabb| (!periodic.any()).then_some(bounds);
        // What is inside lies between its particles.
        particles.find(step, body, open(bounds(step, solid)?).as_ref())?;
        if particles.rows.is_empty() {
            return Ok(None);
        }
        // No image counts twice.
        let periods = periodic.lengths().to_array().into_iter().filter(|length| *length > 0.0);
        let range = periods.fold(RANGE * spacing, |range, length| range.min(0.49 * length));
        let reach = Aabb::around(particles.places.iter().copied()).grown(range);
        others.find(step, solid, open(reach).as_ref())?;
        let view = step.world.body_view(solid).0;
        if let Ok(damage) = view.read::<Damage>() {
            others.keep(|row| damage[row].0 < 1.0);
        }
        let [targets, sources] = [&*particles, &*others].map(|of| Cloud::uniform(&of.places, range));
        if search.between(targets, sources, 0.0, periodic, around).is_err() {
            return Ok(None);
        }
        let (reference, gradient) = (view.read::<ReferencePosition>()?, view.read::<DeformationGradient>()?);
        let mut found = None;
        let first = step.world.body_view(body).1.start;
        for (i, row) in particles.rows.iter().enumerate() {
            let near = around.row(i).iter().map(|&j| j as usize);
            let offset = |j: usize| periodic.minimal_image(others.places[j] - particles.places[i]);
            let distances = near.clone().map(|j| (offset(j).length(), j));
            let Some((_, nearest)) = distances.min_by(|a, b| a.0.total_cmp(&b.0)) else { continue };
            let own_row = others.rows[nearest];
            let back = gradient[own_row].0.inverse();
            let away = back * offset(nearest);
            let below = -region.distance(reference[own_row].0 - away);
            let is_among = away.length() < NEAREST * spacing && below > DEPTH * spacing;
            if is_among && is_enclosed(near.map(|j| back * offset(j)), range) {
                Intruders::add(&mut found, row - first, below);
            }
        }
        Ok(found)
    }
}

/// Whether particles at these places, m, from another one surround it.
fn is_enclosed(places: impl Iterator<Item = DVec3>, range: f64) -> bool {
    let (mut sum, mut total) = (DVec3::ZERO, 0.0);
    for x in places {
        let weight = (1.0 - x.length() / range).max(0.0);
        sum += weight * x;
        total += weight * x.length();
    }
    sum.length() < ENCLOSED * total
}
