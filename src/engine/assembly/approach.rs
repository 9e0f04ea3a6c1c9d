//! Closing speed of the faces of two bodies at first contact: from initial velocities, prescribed motion, and
//! gravity.

use std::collections::BTreeMap;
use std::ops::Range;

use glam::DVec3;

use crate::boundaries::GivenVelocities;
use crate::plugin::{BodyKind, BodyPlan, MotionOfPlace, SimBuilder};
use crate::rigid::DrivenBody;
use crate::world::{BodyId, BodySet};

/// Particles of a face at which its motion is looked at.
const PLACES: usize = 16;
/// Largest difference of velocities within a face that comes flat, over its speed.
const FLAT: f64 = 0.02;
/// Times at which an approach is looked at, and again within the interval in which the faces touch.
const TIMES: u32 = 400;
/// Gap in spacings below which bodies touch from the start.
const TOUCHING: f64 = 0.05;
/// Minimum speed of the impact over the largest one that is prescribed: a tool that begins to press slowly
/// and then gets faster causes no front.
const SUDDEN: f64 = 0.25;

/// The motion of places of bodies until they touch anything.
pub(super) struct Motions {
    given: GivenVelocities,
    driven: BTreeMap<BodyId, [Option<MotionOfPlace>; 3]>,
    /// Gravity on bodies that fall freely, m/s2.
    gravity: DVec3,
    falling: BodySet,
    end: f64,
}

/// The velocity of a face as a function of time, m/s.
type Velocity<'a> = Box<dyn Fn(f64) -> DVec3 + 'a>;

impl Motions {
    /// The prescribed motions and loads of a scene, once all conditions are built.
    pub fn of(sim: &SimBuilder<'_>) -> Self {
        let mut driven: BTreeMap<BodyId, [Option<MotionOfPlace>; 3]> = BTreeMap::new();
        for body in sim.extensions::<DrivenBody>() {
            let own = driven.entry(body.body).or_default();
            for axis in (0..3).filter(|&axis| body.axes[axis]) {
                own[axis] = body.motion.velocity_of_place(1e-6 * sim.scene().time.end);
            }
        }
        let given = sim.extensions::<GivenVelocities>().next().cloned().unwrap_or_default();
        let falling = falling(sim, &driven);
        Self { given, driven, gravity: sim.gravity(), falling, end: sim.scene().time.end }
    }

    /// The velocity of a particle of a body, m/s.
    fn of_particle(&self, body: &BodyPlan, number: usize, sim: &SimBuilder<'_>, t: f64) -> DVec3 {
        let row = (body.rows.start + number) as u32;
        let point = body.sites[number].position;
        let start = body.velocity.map_or(DVec3::ZERO, |velocity| velocity.0);
        let given = self.given.of(body.id, row);
        let held = sim.prescribed.get(&(body.phase, row));
        let gravity = self.fall(body);
        let value = |axis: usize| {
            if let Some(motion) = self.driven.get(&body.id).and_then(|axes| axes[axis].as_ref()) {
                return motion(point, t)[axis];
            }
            if let Some(by) = held.and_then(|axes| axes[axis]) {
                let motion = sim.prescriptions[by].velocity_of_place(1e-6 * self.end);
                return motion.map_or(0.0, |motion| motion(point, t)[axis]);
            }
            given[axis].unwrap_or(start[axis]) + gravity[axis] * t
        };
        DVec3::from([0, 1, 2].map(value))
    }

    /// Whether nothing changes the velocity of a body until it touches another one.
    fn is_steady(&self, body: &BodyPlan, sim: &SimBuilder<'_>) -> bool {
        !is_held(sim, &self.driven, body) && self.fall(body) == DVec3::ZERO
    }

    /// Acceleration of a body by nothing but gravity, m/s2.
    fn fall(&self, body: &BodyPlan) -> DVec3 {
        if self.falling.contains(body.id) { self.gravity } else { DVec3::ZERO }
    }

    /// The mean velocity of some particles of a body.
    pub fn of_face<'a>(&'a self, body: &'a BodyPlan, face: &[u32], sim: &'a SimBuilder<'_>) -> Velocity<'a> {
        let some: Vec<usize> = some_of(face).collect();
        Box::new(move |t| {
            let all = some.iter().map(|&number| self.of_particle(body, number, sim, t));
            all.sum::<DVec3>() / some.len().max(1) as f64
        })
    }

    /// Whether a face moves as one at the start.
    pub fn is_flat(&self, body: &BodyPlan, face: &[u32], sim: &SimBuilder<'_>, speed: f64) -> bool {
        let mean = self.of_face(body, face, sim)(0.0);
        some_of(face).all(|number| self.of_particle(body, number, sim, 0.0).distance(mean) <= FLAT * speed)
    }

    /// The direction in which the first body comes towards the second one, if it moves towards it at all.
    pub fn direction(&self, [a, b]: [&BodyPlan; 2], sim: &SimBuilder<'_>) -> DVec3 {
        let all = |body: &BodyPlan| (0..body.sites.len() as u32).collect::<Vec<u32>>();
        let (of_a, of_b) = (all(a), all(b));
        let (of_a, of_b) = (self.of_face(a, &of_a, sim), self.of_face(b, &of_b, sim));
        let last = if [a, b].into_iter().all(|body| self.is_steady(body, sim)) { 0 } else { TIMES };
        let times = (0..=last).map(|k| self.end * f64::from(k) / f64::from(TIMES));
        let relative = times.map(|t| of_a(t) - of_b(t));
        let fastest = relative.max_by(|v, w| v.length_squared().total_cmp(&w.length_squared()));
        fastest.filter(|v| v.is_finite()).unwrap_or_default().normalize_or_zero()
    }

    /// Whether a condition moves a face along a direction at a time, s.
    pub fn is_driven(
        &self,
        body: &BodyPlan,
        face: &[u32],
        along: DVec3,
        sim: &SimBuilder<'_>,
        t: f64,
    ) -> bool {
        let (Some(&number), axis) = (face.first(), along.abs().max_position()) else { return false };
        let row = (body.rows.start as u32) + number;
        let of_body = self.driven.get(&body.id).is_some_and(|axes| axes[axis].is_some());
        let of_row = sim.prescribed.get(&(body.phase, row)).is_some_and(|axes| axes[axis].is_some());
        (of_body || of_row) && self.of_particle(body, number as usize, sim, t)[axis] != 0.0
    }

    /// Speed at which the faces of two bodies touch that are `gap` apart along a direction, m/s, and when, s,
    /// if they touch suddenly within the run.
    pub fn speed(
        &self,
        pair: [&BodyPlan; 2],
        of: [&Velocity<'_>; 2],
        along: DVec3,
        gap: f64,
    ) -> Option<(f64, f64)> {
        let closing = |t: f64| (of[0](t) - of[1](t)).dot(along);
        let fall = (self.fall(pair[0]) - self.fall(pair[1])).dot(along);
        let at = |k: u32| self.end * f64::from(k) / f64::from(TIMES);
        let largest = (0..=TIMES).map(|k| closing(at(k)) - fall * at(k)).fold(0.0, f64::max);
        let touch = if gap <= TOUCHING * pair[0].spacing.min(pair[1].spacing) {
            0.0
        } else {
            let part = first_beyond(&closing, 0.0..self.end, gap)?;
            let GapClosing { span, .. } =
                first_beyond(&closing, part.span.clone(), part.left).unwrap_or(part);
            0.5 * (span.start + span.end)
        };
        let speed = closing(touch);
        (speed > 0.0 && speed >= SUDDEN * largest).then_some((speed, touch))
    }
}

/// The particles of a face at which its motion is looked at.
fn some_of(face: &[u32]) -> impl Iterator<Item = usize> {
    let every = face.len().div_ceil(PLACES).max(1);
    face.iter().step_by(every).map(|&number| number as usize)
}

/// A part of a span of time in which a gap closes.
struct GapClosing {
    /// Begin and end, s.
    span: Range<f64>,
    /// What is left of the gap at its begin, m.
    left: f64,
}

/// The part of a span of time in which a gap closes that moves at a speed.
fn first_beyond(closing: &dyn Fn(f64) -> f64, span: Range<f64>, gap: f64) -> Option<GapClosing> {
    let step = (span.end - span.start) / f64::from(TIMES);
    let mut left = gap;
    for k in 0..TIMES {
        let from = span.start + step * f64::from(k);
        let moved = step * closing(from + 0.5 * step);
        if moved >= left {
            return Some(GapClosing { span: from..from + step, left });
        }
        left -= moved;
    }
    None
}

/// Bodies that nothing but gravity moves until they touch: no condition holds any of their particles, one
/// other body may touch them, and no fluid is there.
fn falling(sim: &SimBuilder<'_>, driven: &BTreeMap<BodyId, [Option<MotionOfPlace>; 3]>) -> BodySet {
    if sim.bodies().iter().any(|body| body.kind == BodyKind::Fluid) {
        return BodySet::default();
    }
    let touching = sim.touching_pairs();
    let falls = |body: &&BodyPlan| {
        matches!(touching.partners(body.id), [other] if *other != body.id) && !is_held(sim, driven, body)
    };
    BodySet::new(sim.bodies().iter().filter(falls).map(|body| body.id))
}

/// Whether a condition prescribes the motion of a body, or of some of its particles.
fn is_held(
    sim: &SimBuilder<'_>,
    driven: &BTreeMap<BodyId, [Option<MotionOfPlace>; 3]>,
    body: &BodyPlan,
) -> bool {
    let rows = body.rows.start as u32..body.rows.end as u32;
    sim.prescribed.range((body.phase, rows.start)..(body.phase, rows.end)).next().is_some()
        || driven.contains_key(&body.id)
}

/// Whether a body is one whose approach is known.
pub(super) fn is_known(body: &BodyPlan) -> bool {
    matches!(body.kind, BodyKind::Solid | BodyKind::Rigid)
}
