//! Bounds of the motion and the stretches of the bodies in contact, which determine how long a list of candidates is valid.

use super::shape::squared_stretch;
use crate::parallel::{BlockSum, Largest, sum_over_blocks};
use crate::rigid::RigidBodies;
use crate::schedule::{Step, StepError};
use crate::world::{BodyId, DeformationGradient, Velocity};

/// How fast a body is at most, m/s, and a bound of how far it is stretched: in tenths, so that lists are seldom made for another one.
#[derive(Clone, Copy)]
pub(in crate::contact) struct MotionBounds {
    pub speed: f64,
    pub stretch: f64,
}

impl MotionBounds {
    /// Of a body that does not move.
    pub const NONE: Self = Self { speed: 0.0, stretch: 1.0 };

    /// Of a body, the shapes of whose particles follow their deformation if it is to `deform`.
    pub fn of(body: BodyId, deform: bool, step: &Step<'_>) -> Result<Self, StepError> {
        if let Some(bodies) = step.resources.try_get::<RigidBodies>()
            && let Some(rigid) = bodies.iter().find(|rigid| rigid.id == body)
        {
            // The points that touch are farther out than the particles.
            return Ok(Self { speed: rigid.largest_speed(), ..Self::NONE });
        }
        let (view, rows) = step.world.body_view(body);
        let velocity = view.read::<Velocity>()?;
        let fastest = |rows: &[Velocity]| Largest::of(rows.iter().map(|v| v.0.length_squared()));
        if !deform {
            let speed = sum_over_blocks(&velocity[rows], &|_, rows: &[Velocity]| fastest(rows));
            return Ok(Self { speed: speed.0.sqrt(), ..Self::NONE });
        }
        let gradient = view.read::<DeformationGradient>()?;
        let rows = (&velocity[rows.clone()], &gradient[rows]);
        type Rows<'a> = (&'a [Velocity], &'a [DeformationGradient]);
        let Squares { speed, stretch } = sum_over_blocks(rows, &|_, (velocity, gradient): Rows<'_>| {
            let stretch = Largest::of(gradient.iter().map(squared_stretch));
            Squares { speed: fastest(velocity), stretch }
        });
        let stretch = 0.1 + 0.1 * (10.0 * stretch.0.sqrt()).floor();
        Ok(Self { speed: speed.0.sqrt(), stretch })
    }
}

/// The largest squares.
#[derive(Clone, Copy, Default)]
struct Squares {
    speed: Largest,
    stretch: Largest,
}

impl BlockSum for Squares {
    fn add(&mut self, next: &Self) {
        self.speed.add(&next.speed);
        self.stretch.add(&next.stretch);
    }
}
