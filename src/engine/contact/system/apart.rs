//! Bodies that are far apart: nothing of them touches, and all that their contact does is to limit the time
//! step.
//!
//! Boxes around two bodies tell how far apart they are, and bounds of their velocities for how long. Between
//! many bodies the cost of contact is therefore that of those near each other.

use std::sync::Arc;

use glam::DVec3;

use super::touching::Touching;
use crate::contact::bodies::MotionBounds;
use crate::contact::response::time_step::{self, Touches};
use crate::contact::skins::{gap_of, speed_of_points};
use crate::contact::tools::SlowImpact;
use crate::neighbors::Periodic;
use crate::rigid::{RigidBodies, RigidBody};
use crate::schedule::{Step, StepError};
use crate::shapes::Aabb;
use crate::skins::{Skin, SkinColumns};
use crate::symmetry::Map;
use crate::world::{BodyId, Position};

/// Gap over the larger spacing beyond which two bodies are apart: all searches of what may touch find nothing
/// there, and the steps that contact allows do not lead from there into a contact.
const FAR: f64 = 4.0;

/// A body that touches others.
pub(super) struct InContact {
    pub body: BodyId,
    /// Whether the shapes of particles of it that touch follow their deformation.
    deform: bool,
    /// Its skin, if it touches with that, and the numbers of its vertices.
    skin: Option<Arc<Skin>>,
    vertices: Vec<u32>,
    /// Largest radius of particles that touch, m; none if they do not.
    radius: Option<f64>,
    pub motion: MotionBounds,
    /// Acceleration of a rigid body, m/s2.
    acceleration: f64,
    /// The box around what touches, if it is known in this step; nothing is around a body without bounds.
    around: Option<Option<Aabb>>,
}

impl InContact {
    /// The bodies of pairs that touch, ascending.
    pub fn of(bodies: impl Iterator<Item = BodyId>, touching: &[Touching]) -> Vec<Self> {
        let mut all: Vec<Self> = bodies.map(Self::new).collect();
        for pair in touching {
            for particles in pair.particles() {
                if let Ok(k) = all.binary_search_by_key(&particles.body, |known| known.body) {
                    let known = &mut all[k];
                    known.deform |= particles.deform;
                    known.radius = Some(particles.max_radius().max(known.radius.unwrap_or(0.0)));
                }
            }
            for skin in pair.skins() {
                if let Ok(k) = all.binary_search_by_key(&skin.body, |known| known.body) {
                    all[k].skin.get_or_insert_with(|| Arc::clone(skin));
                }
            }
        }
        for known in &mut all {
            known.vertices.extend(0..known.skin.as_ref().map_or(0, |skin| skin.vertices() as u32));
        }
        all
    }

    fn new(body: BodyId) -> Self {
        let (skin, vertices, radius) = (None, Vec::new(), None);
        let motion = MotionBounds::NONE;
        Self { body, deform: false, skin, vertices, radius, motion, acceleration: 0.0, around: None }
    }

    /// Takes in its motion in a step.
    pub fn follow(&mut self, step: &Step<'_>) -> Result<(), StepError> {
        self.around = None;
        self.motion = MotionBounds::of(self.body, self.deform, step)?;
        let bodies = step.resources.try_get::<RigidBodies>();
        self.acceleration = bodies
            .and_then(|bodies| bodies.of(self.body).map(RigidBody::last_acceleration))
            .unwrap_or_default();
        Ok(())
    }

    /// The box around what touches, m; none around a body without bounds.
    fn around(&mut self, step: &Step<'_>) -> Result<Option<Aabb>, StepError> {
        if self.around.is_none() {
            self.around = Some(self.look(step)?);
        }
        Ok(self.around.flatten())
    }

    fn look(&self, step: &Step<'_>) -> Result<Option<Aabb>, StepError> {
        if let Some(bodies) = step.resources.try_get::<RigidBodies>()
            && let Some(rigid) = bodies.of(self.body)
        {
            let is_bounded = rigid.surface.bounds().is_bounded();
            let center = Aabb { min: rigid.state.center, max: rigid.state.center };
            return Ok(is_bounded.then(|| center.grown(rigid.bounding_radius)));
        }
        let mut around = Aabb { min: DVec3::INFINITY, max: DVec3::NEG_INFINITY };
        if let Some(skin) = &self.skin {
            SkinColumns::new(skin, step.world)?.view().places(&self.vertices, &mut |_, x, _| {
                around = around.union(&Aabb { min: x, max: x });
            });
        }
        if let Some(radius) = self.radius {
            let (view, rows) = step.world.body_view(self.body);
            let centers = Aabb::around(view.read_near::<Position>()?[rows].iter().map(|x| x.0));
            around = around.union(&centers.grown(self.motion.stretch * radius));
        }
        Ok(Some(around))
    }
}

/// How far apart the two bodies of a pair are.
pub(super) struct PairDistance {
    /// Their numbers among the bodies in contact.
    numbers: [u32; 2],
    /// The larger and the smaller spacing, m.
    spacing: f64,
    smaller: f64,
    /// Distance at which particles of both just touch, m; none between rigid bodies.
    reach: Option<f64>,
    is_apart: bool,
    /// How far both may still move until this is looked at again, m.
    left: f64,
    /// Limit of an impact of two rigid bodies.
    slow: SlowImpact,
}

impl PairDistance {
    /// Of a pair of these bodies, ascending; nothing is known yet.
    pub fn new(pair: &Touching, bodies: &[InContact], spacing: impl Fn(BodyId) -> f64) -> Self {
        let [first, second] = pair.bodies();
        let number = |body: BodyId| bodies.partition_point(|known| known.body < body) as u32;
        Self {
            numbers: [number(first), number(second)],
            spacing: spacing(first).max(spacing(second)),
            smaller: spacing(first).min(spacing(second)),
            reach: pair.reach(),
            is_apart: false,
            left: 0.0,
            slow: SlowImpact::default(),
        }
    }

    /// The two bodies.
    #[inline]
    pub fn of<'b>(&self, bodies: &'b [InContact]) -> [&'b InContact; 2] {
        // By number: a mapped array would be called.
        [&bodies[self.numbers[0] as usize], &bodies[self.numbers[1] as usize]]
    }

    /// Bounds of the motion of both.
    #[inline]
    pub fn motion(&self, bodies: &[InContact]) -> [MotionBounds; 2] {
        let [first, second] = self.of(bodies);
        [first.motion, second.motion]
    }

    /// Takes in a step of the pair, and says whether its bodies are apart; then it proposes their limits.
    /// What is near or touches wakes them up; they fall asleep only twice as far apart, and when nothing
    /// touches any more.
    #[inline]
    pub fn follow(
        &mut self,
        pair: &mut Touching,
        bodies: &mut [InContact],
        periodic: &Periodic,
        step: &mut Step<'_>,
    ) -> Result<bool, StepError> {
        self.left -= speed_of_points(self.motion(bodies)) * step.clock.dt;
        // What is not a number must not keep bodies apart.
        if self.left.is_nan() || self.left <= 0.0 {
            self.look(pair, bodies, periodic, step)?;
        }
        if self.is_apart {
            self.limit(pair, bodies, step)?;
        }
        Ok(self.is_apart)
    }

    /// Looks at how far apart they are.
    fn look(
        &mut self,
        pair: &mut Touching,
        bodies: &mut [InContact],
        periodic: &Periodic,
        step: &Step<'_>,
    ) -> Result<(), StepError> {
        let [first, second] = self.numbers.map(|number| number as usize);
        let gap = match (bodies[first].around(step)?, bodies[second].around(step)?) {
            (Some(first), Some(second)) => gap_of(&first, &second, periodic),
            _ => 0.0,
        };
        let (far, was_apart) = (FAR * self.spacing, self.is_apart);
        self.is_apart = gap > 2.0 * far && pair.is_idle();
        self.left = if self.is_apart { gap - far } else { far };
        if was_apart && !self.is_apart {
            pair.come_near();
        }
        Ok(())
    }

    /// Proposes the limits of a pair whose bodies are apart.
    #[inline]
    fn limit(&mut self, pair: &Touching, bodies: &[InContact], step: &mut Step<'_>) -> Result<(), StepError> {
        let [first, second] = self.of(bodies);
        let motion = [first.motion, second.motion];
        let speed = MotionBounds::approach(motion, &Map::IDENTITY);
        let Some(reach) = self.reach else {
            if !self.is_slow(speed, [first, second], step)
                && let Touching::Surface(contact) = pair
            {
                self.slow = contact.limit_apart(step, motion)?;
            }
            return Ok(());
        };
        let touches = Touches { squared: 0.0, stored: 0.0, speed, reach };
        time_step::propose(step, [first.body, second.body], &touches)
    }

    /// Whether two rigid bodies are so slow and so far apart that their limits are above those of others: of
    /// many bodies nearly all are, and what is known here of them tells.
    #[inline]
    fn is_slow(&self, speed: f64, [first, second]: [&InContact; 2], step: &Step<'_>) -> bool {
        let Self { slow, .. } = self;
        let (gap, velocity) =
            (self.left + FAR * self.spacing, second.motion.velocity.distance(first.motion.velocity));
        speed <= slow.speed
            && first.acceleration.max(second.acceleration) <= slow.gain
            && step.limits.has_below(slow.limit)
            && step.limits.has_below(time_step::limit_of_approach(self.smaller, gap, velocity))
    }
}
