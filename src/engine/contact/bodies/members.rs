//! The particles of a body in contact, in their current state.

use std::cell::Ref;

use glam::{DMat3, DVec3};
use hecs::ArchetypeColumn;

use super::shape::ParticleShape;
use crate::plugin::{BodyPlan, Offer};
use crate::removal::LeavingParticles;
use crate::scene::Dimension;
use crate::schedule::Resources;
use crate::solids::{LocalMotion, SolidPhase};
use crate::world::{
    BodyId, DeformationGradient, MissingColumn, Mobility, Position, Removed, Velocity, World,
};

/// Note on contact of particles for a sliding body.
pub(in crate::contact) const BUMPS: &str = "in sliding, the bumps of a surface of particles cause tangential forces of up to a third of the normal force, with and without friction";

/// Parts of one body closer than this in the reference configuration do not touch, over the distance of two
/// particles that do: bonds hold them apart.
pub(in crate::contact) const APART: f64 = 2.5;

/// Contact data of the particles of a body.
#[derive(Clone)]
pub(in crate::contact) struct MemberParticles {
    pub body: BodyId,
    /// Radius of every particle in the reference configuration, m: half the side of the square or cube of its
    /// volume.
    pub radius: Vec<f64>,
    /// Whether their shapes follow their deformation. In a body that may fail they stay spheres: the
    /// deformation gradient of a failed particle is that of a crack.
    pub deform: bool,
    /// Number of particles on the largest side of the box around the body: what may touch at once, of most
    /// bodies.
    pub on_a_side: usize,
}

impl MemberParticles {
    /// Those of a body.
    pub fn of(body: &BodyPlan, dimension: Dimension) -> Self {
        let root = |volume: f64| if dimension == Dimension::Two { volume.sqrt() } else { volume.cbrt() };
        let radius: Vec<f64> = body.sites.iter().map(|site| 0.5 * root(site.volume)).collect();
        let deform = body.offers(Offer::DeformedContact) && !body.can_fail();
        let on_a_side = on_a_side(body.sites.iter().map(|site| site.position), &radius, dimension);
        Self { body: body.id, radius, deform, on_a_side }
    }

    /// The maximum radius, m.
    pub fn max_radius(&self) -> f64 {
        self.radius.iter().copied().fold(0.0, f64::max)
    }

    /// The minimum radius, m.
    pub fn min_radius(&self) -> f64 {
        self.radius.iter().copied().fold(f64::INFINITY, f64::min)
    }
}

fn on_a_side(places: impl Iterator<Item = DVec3>, radius: &[f64], dimension: Dimension) -> usize {
    let bounds = (DVec3::INFINITY, DVec3::NEG_INFINITY);
    let (low, high) = places.fold(bounds, |(low, high), x| (low.min(x), high.max(x)));
    let size = 2.0 * radius.iter().sum::<f64>() / radius.len().max(1) as f64;
    let along = (high - low) / size + DVec3::ONE;
    let largest = match dimension {
        Dimension::Two => along.x.max(along.y),
        Dimension::Three => (along.x * along.y).max(along.y * along.z).max(along.z * along.x),
    };
    radius.len().min(largest.ceil() as usize)
}

/// The columns of the particles of a body in this step.
pub(in crate::contact) struct MemberColumns<'a> {
    particles: &'a MemberParticles,
    first_row: usize,
    position: ArchetypeColumn<'a, Position>,
    velocity: ArchetypeColumn<'a, Velocity>,
    mobility: ArchetypeColumn<'a, Mobility>,
    removed: ArchetypeColumn<'a, Removed>,
    gradient: Option<ArchetypeColumn<'a, DeformationGradient>>,
    solid: Option<Ref<'a, dyn SolidPhase>>,
    body: Option<Ref<'a, dyn SolidPhase>>,
    leaving: Option<Ref<'a, LeavingParticles>>,
}

impl<'a> MemberColumns<'a> {
    /// Those of a body.
    pub fn new(
        particles: &'a MemberParticles,
        world: &'a World,
        resources: &'a Resources,
    ) -> Result<Self, MissingColumn> {
        let (view, rows) = world.body_view(particles.body);
        Ok(Self {
            particles,
            first_row: rows.start,
            position: view.read_near()?,
            velocity: view.read_near()?,
            mobility: view.read_near()?,
            removed: view.read_near()?,
            gradient: if particles.deform { Some(view.read_near()?) } else { None },
            solid: if particles.deform { resources.solid(world.body(particles.body).phase) } else { None },
            body: resources.solid(world.body(particles.body).phase),
            leaving: resources.try_get_of(world.body(particles.body).phase),
        })
    }

    /// The particles.
    pub fn members(&self) -> Members<'_> {
        Members {
            first_row: self.first_row,
            radius: &self.particles.radius,
            position: &self.position,
            velocity: &self.velocity,
            mobility: &self.mobility,
            removed: &self.removed,
            gradient: self.gradient.as_deref(),
            solid: self.solid.as_deref(),
            body: self.body.as_deref(),
            leaving: self.leaving.as_deref(),
        }
    }
}

/// The particles of a body in this step.
#[derive(Clone, Copy)]
pub(in crate::contact) struct Members<'a> {
    first_row: usize,
    radius: &'a [f64],
    position: &'a [Position],
    velocity: &'a [Velocity],
    mobility: &'a [Mobility],
    removed: &'a [Removed],
    gradient: Option<&'a [DeformationGradient]>,
    /// The body, where its particles deform with it.
    solid: Option<&'a dyn SolidPhase>,
    body: Option<&'a dyn SolidPhase>,
    leaving: Option<&'a LeavingParticles>,
}

impl Members<'_> {
    /// Number of particles.
    pub fn len(&self) -> usize {
        self.radius.len()
    }

    /// Whether a particle takes part: a removed one does not.
    pub fn is_there(&self, i: usize) -> bool {
        self.removed[self.first_row + i] == Removed::NO
    }

    /// Whether nothing moves a particle but conditions, such as one of a wall.
    pub fn is_held(&self, i: usize) -> bool {
        self.mobility[self.first_row + i] == Mobility::default()
    }

    /// Where a particle is, m.
    pub fn position(&self, i: usize) -> DVec3 {
        self.position[self.first_row + i].0
    }

    /// Radius of a particle in the reference configuration, m.
    pub fn radius(&self, i: usize) -> f64 {
        self.radius[i]
    }

    /// Whether kernels hold two particles of the body together.
    pub fn holds_together(&self, i: usize, j: usize) -> bool {
        self.body.is_some_and(|body| body.holds_together(self.first_row + i, self.first_row + j))
    }

    /// Current shape of a particle.
    pub fn shape(&self, i: usize) -> ParticleShape {
        let gradient = self.gradient.map(|f| f[self.first_row + i].0);
        ParticleShape { radius: self.radius[i], gradient }
    }

    /// The point `arm` beside a particle in the reference configuration, at present, relative to the
    /// particle, m.
    pub fn carry(&self, i: usize, arm: DVec3) -> DVec3 {
        self.gradient.map_or(DMat3::IDENTITY, |f| f[self.first_row + i].0) * arm
    }

    /// Motion of the material around a particle, if it is requested, and can be moved.
    pub fn local_motion(&self, i: usize, moving: bool) -> LocalMotion {
        let row = self.first_row + i;
        if !self.is_there(i) {
            let velocity = self.leaving.map_or(DVec3::ZERO, |leaving| leaving.velocity(row));
            return LocalMotion::alone(Velocity(velocity), self.mobility[row]);
        }
        match self.solid {
            Some(solid) => solid.local_motion(row, self.velocity, self.mobility[row], moving),
            None => LocalMotion::alone(self.velocity[row], self.mobility[row]),
        }
    }
}
