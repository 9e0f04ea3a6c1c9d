//! The acceleration of rigid bodies that the fluid moves, as its pressure on them sees it.
//!
//! The pressure of a wall contains its acceleration, `p_w = p_f + (a_w - g) . rho x` (`wall_pressure`), and
//! so does that of a rigid body: without it, a container in free fall pushes its water off. But the
//! acceleration follows from the pressure. That of the step before acts as a mass M that is added explicitly,
//! `m a' = F - M a`, which grows without bounds where M > m. The pressure therefore follows it by a share b
//! of the difference in each step,
//!
//! ```text
//! a' = a + b ((F - M a) / m - a)
//! ```
//!
//! which is stable for b (1 + M / m) < 2. M is that of some 0.6 of a layer of fluid on all sides of the body;
//! the fluid in the place of all of its particles, m_f, has more except at bodies of one such layer. b is
//! half of the inverse of 1 + m_f / m, with which any M below 3 m_f is stable.

use glam::DVec3;
use serde::{Deserialize, Serialize};

use crate::formulations::fluid::cloud::{Group, Role};
use crate::plugin::{BodyKind, BodyPlan, SimBuilder};
use crate::rigid::{RigidAcceleration, RigidBodies, RigidBody};
use crate::schedule::Clock;
use crate::world::BodyId;

/// b (1 + m_f / m).
const SHARE: f64 = 0.5;

/// The motions of the rigid bodies in a flow.
pub struct SeenMotions {
    /// In the order of the scene.
    bodies: Vec<SeenMotion>,
    /// Middle of the step before, s, which has its velocities; none before the first one.
    middle: Option<f64>,
}

/// The motion of a rigid body.
struct SeenMotion {
    body: BodyId,
    /// Mass of the fluid in the place of its particles, kg.
    displaced: f64,
    known: KnownMotion,
    /// Acceleration of its points in this step.
    now: Option<RigidAcceleration>,
}

/// What is known of a motion.
#[derive(Clone, Copy, Debug, Default, Serialize, Deserialize)]
struct KnownMotion {
    /// Velocity of the centre, m/s, and of the rotation, 1/s, in the step before; none before the first one.
    before: Option<[DVec3; 2]>,
    /// Accelerations beside the prescribed ones that the pressure sees, m/s2 and 1/s2.
    seen: [DVec3; 2],
}

impl SeenMotions {
    pub fn new(groups: &[Group], sim: &SimBuilder<'_>) -> Self {
        let densities = groups.iter().filter_map(Group::fluid).map(|fluid| fluid.density);
        let densest = densities.fold(0.0, f64::max);
        let moved = |group: &&Group| matches!(&group.role, Role::Boundary(surface) if surface.moved);
        let mut ids: Vec<BodyId> = groups.iter().filter(moved).map(|group| group.body).collect();
        ids.sort_unstable();
        ids.dedup();
        let rigid = ids.into_iter().map(|id| sim.body(id)).filter(|body| body.kind == BodyKind::Rigid);
        let motion = |body: &BodyPlan| SeenMotion {
            body: body.id,
            displaced: densest * body.volume(),
            known: KnownMotion::default(),
            now: None,
        };
        Self { bodies: rigid.map(motion).collect(), middle: None }
    }

    /// Time from the velocities of the step before to those of this one, s; zero where there is no step. The
    /// last step of a run may be shorter than all others by any factor.
    pub fn elapsed(&mut self, clock: &Clock) -> f64 {
        if clock.dt <= 0.0 {
            return 0.0;
        }
        let middle = clock.middle();
        self.middle.replace(middle).map_or(clock.dt, |before| middle - before)
    }

    /// Follows the bodies over the time `elapsed`, s.
    pub fn follow(&mut self, bodies: &RigidBodies, elapsed: f64) {
        for body in bodies.iter() {
            let Some(n) = self.index(body.id) else { continue };
            let motion = &mut self.bodies[n];
            if elapsed > 0.0 {
                motion.known.follow(body, SHARE / (1.0 + motion.displaced / body.mass), elapsed);
            }
            let (driven, seen) = (body.driven_part(), motion.known.seen);
            motion.now = Some(body.acceleration([driven[0] + seen[0], driven[1] + seen[1]]));
        }
    }

    /// The acceleration of a body in this step; none unless it is rigid.
    pub fn of(&self, body: BodyId) -> Option<RigidAcceleration> {
        self.bodies[self.index(body)?].now
    }

    pub fn save(&self) -> Vec<u8> {
        let known: Vec<KnownMotion> = self.bodies.iter().map(|motion| motion.known).collect();
        postcard::to_stdvec(&(self.middle, known)).unwrap_or_default()
    }

    pub fn restore(&mut self, state: &[u8]) -> bool {
        let Ok((middle, known)) = postcard::from_bytes::<(Option<f64>, Vec<KnownMotion>)>(state) else {
            return false;
        };
        self.middle = middle;
        self.bodies.iter_mut().zip(&known).for_each(|(motion, known)| motion.known = *known);
        known.len() == self.bodies.len()
    }

    fn index(&self, body: BodyId) -> Option<usize> {
        self.bodies.binary_search_by_key(&body, |motion| motion.body).ok()
    }
}

impl KnownMotion {
    fn follow(&mut self, body: &RigidBody, share: f64, elapsed: f64) {
        let now = [body.state.velocity, body.state.angular_velocity];
        let before = self.before.replace(now).unwrap_or(now);
        let free = body.free_part([0, 1].map(|k| (now[k] - before[k]) / elapsed));
        (0..2).for_each(|k| self.seen[k] += share * (free[k] - self.seen[k]));
    }
}
