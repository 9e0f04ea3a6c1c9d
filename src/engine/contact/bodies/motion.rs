//! Bounds of the motion and the stretches of the bodies in contact, which determine how long a list of candidates is valid.

use glam::DVec3;

use super::shape::squared_stretch;
use crate::parallel::{BlockSum, Largest, sum_over_blocks};
use crate::rigid::RigidBodies;
use crate::schedule::{Step, StepError};
use crate::world::{BodyId, DeformationGradient, Velocity};

/// How fast a body is at most, m/s, and a bound of how far it is stretched: in tenths, so that lists are seldom built for another one.
#[derive(Clone, Copy)]
pub(in crate::contact) struct MotionBounds {
    pub speed: f64,
    /// The same in the frame that moves with one of the bodies.
    pub beside: f64,
    pub stretch: f64,
}

impl MotionBounds {
    /// Of a body that does not move.
    pub const NONE: Self = Self { speed: 0.0, beside: 0.0, stretch: 1.0 };

    /// Bounds of the speeds of two bodies whose sum bounds how fast they approach each other, m/s: where all moves with a common velocity, in the frame that moves with it.
    pub fn speeds([first, second]: [Self; 2]) -> [f64; 2] {
        if first.beside + second.beside < first.speed + second.speed {
            [first.beside, second.beside]
        } else {
            [first.speed, second.speed]
        }
    }

    /// A velocity of a body, m/s, which may be that of a frame.
    pub fn velocity(body: BodyId, step: &Step<'_>) -> Result<DVec3, StepError> {
        if let Some(bodies) = step.resources.try_get::<RigidBodies>()
            && let Some(rigid) = bodies.iter().find(|rigid| rigid.id == body)
        {
            return Ok(rigid.state.velocity);
        }
        let (view, rows) = step.world.body_view(body);
        let velocity = view.read::<Velocity>()?[rows.start].0;
        Ok(velocity)
    }

    /// Of a body, the shapes of whose particles follow their deformation if it is to `deform`, and in a `frame` of that velocity, m/s.
    pub fn of(body: BodyId, deform: bool, frame: DVec3, step: &Step<'_>) -> Result<Self, StepError> {
        if let Some(bodies) = step.resources.try_get::<RigidBodies>()
            && let Some(rigid) = bodies.iter().find(|rigid| rigid.id == body)
        {
            // The points that touch are farther out than the particles.
            let [speed, beside] = [DVec3::ZERO, frame].map(|frame| rigid.largest_speed_in(frame));
            return Ok(Self { speed, beside, ..Self::NONE });
        }
        let (view, rows) = step.world.body_view(body);
        let velocity = view.read::<Velocity>()?;
        let fastest = |rows: &[Velocity]| Squares {
            speed: Largest::of(rows.iter().map(|v| v.0.length_squared())),
            beside: Largest::of(rows.iter().map(|v| (v.0 - frame).length_squared())),
            ..Squares::default()
        };
        if !deform {
            let squares = sum_over_blocks(&velocity[rows], &|_, rows: &[Velocity]| fastest(rows));
            return Ok(squares.bounds(Self::NONE.stretch));
        }
        let gradient = view.read::<DeformationGradient>()?;
        let rows = (&velocity[rows.clone()], &gradient[rows]);
        type Rows<'a> = (&'a [Velocity], &'a [DeformationGradient]);
        let squares = sum_over_blocks(rows, &|_, (velocity, gradient): Rows<'_>| {
            let stretch = Largest::of(gradient.iter().map(squared_stretch));
            Squares { stretch, ..fastest(velocity) }
        });
        Ok(squares.bounds(0.1 + 0.1 * (10.0 * squares.stretch.0.sqrt()).floor()))
    }
}

/// The largest squares.
#[derive(Clone, Copy, Default)]
struct Squares {
    speed: Largest,
    beside: Largest,
    stretch: Largest,
}

impl Squares {
    fn bounds(&self, stretch: f64) -> MotionBounds {
        MotionBounds { speed: self.speed.0.sqrt(), beside: self.beside.0.sqrt(), stretch }
    }
}

impl BlockSum for Squares {
    fn add(&mut self, next: &Self) {
        self.speed.add(&next.speed);
        self.beside.add(&next.beside);
        self.stretch.add(&next.stretch);
    }
}
