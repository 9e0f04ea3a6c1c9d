//! Bounds of the motion and the stretches of the bodies in contact, which determine how long a list of
//! candidates is valid.
//!
//! Velocities of a body lie in a ball around a velocity of its own. The closing speed of two bodies is
//! therefore at most the distance of these two velocities plus both radii. It depends neither on a common
//! velocity nor on a third body.

use glam::DVec3;

use super::shape::squared_stretch;
use crate::parallel::{BlockSum, Maximum, sum_over_blocks};
use crate::rigid::RigidBodies;
use crate::schedule::{Step, StepError};
use crate::symmetry::Map;
use crate::world::{BodyId, DeformationGradient, Velocity};

/// Velocities that are looked at side by side.
const LANES: usize = 4;

/// Bounds of the velocities of a body, and a bound of how far it is stretched: in tenths, so that lists are
/// seldom built for another one.
#[derive(Clone, Copy)]
pub(in crate::contact) struct MotionBounds {
    /// In the middle of the velocities, m/s.
    pub velocity: DVec3,
    /// How far any of them is from it at most, m/s.
    pub spread: f64,
    pub stretch: f64,
}

impl MotionBounds {
    /// Of a body that does not move.
    pub const NONE: Self = Self { velocity: DVec3::ZERO, spread: 0.0, stretch: 1.0 };

    /// Bounds of the speeds of two bodies in the frame of the first one, whose sum bounds how fast they
    /// approach each other, m/s.
    #[inline]
    pub fn speeds([first, second]: [Self; 2]) -> [f64; 2] {
        [first.spread, first.velocity.distance(second.velocity) + second.spread]
    }

    /// Bound of how fast a body and an image of another approach each other, m/s.
    #[inline]
    pub fn approach([first, second]: [Self; 2], image: &Map) -> f64 {
        let second = Self { velocity: image.vector(second.velocity), ..second };
        let [one, other] = Self::speeds([first, second]);
        one + other
    }

    /// Of a body, the shapes of whose particles follow their deformation if it is to `deform`.
    pub fn of(body: BodyId, deform: bool, step: &Step<'_>) -> Result<Self, StepError> {
        if let Some(bodies) = step.resources.try_get::<RigidBodies>()
            && let Some(rigid) = bodies.of(body)
        {
            // The points that touch are farther out than the particles.
            let spread = rigid.state.angular_velocity.length() * rigid.bounding_radius;
            return Ok(Self { velocity: rigid.state.velocity, spread, ..Self::NONE });
        }
        let (view, rows) = step.world.body_view(body);
        let velocity = &view.read::<Velocity>()?[rows.clone()];
        let first = velocity.first().map_or(DVec3::ZERO, |v| v.0);
        let range = sum_over_blocks(velocity, &|_, rows: &[Velocity]| Range::around(first, rows));
        let middle = first + range.middle();
        let farthest = |rows: &[Velocity]| Squares { spread: farthest(rows, middle), ..Squares::default() };
        if !deform {
            let squares = sum_over_blocks(velocity, &|_, rows: &[Velocity]| farthest(rows));
            return Ok(Self { velocity: middle, spread: squares.spread.0.sqrt(), ..Self::NONE });
        }
        let gradient = view.read::<DeformationGradient>()?;
        type Rows<'a> = (&'a [Velocity], &'a [DeformationGradient]);
        let squares = sum_over_blocks((velocity, &gradient[rows]), &|_, (velocity, gradient): Rows<'_>| {
            let stretch = Maximum::of(gradient.iter().map(squared_stretch));
            Squares { stretch, ..farthest(velocity) }
        });
        let stretch = 0.1 + 0.1 * (10.0 * squares.stretch.0.sqrt()).floor();
        Ok(Self { velocity: middle, spread: squares.spread.0.sqrt(), stretch })
    }
}

/// The smallest and the largest components of velocities, from one of them.
#[derive(Clone, Copy, Default)]
struct Range {
    min: DVec3,
    max: DVec3,
}

impl Range {
    fn around(first: DVec3, rows: &[Velocity]) -> Self {
        rows.iter()
            .map(|v| v.0 - first)
            .fold(Self::default(), |Self { min, max }, v| Self { min: min.min(v), max: max.max(v) })
    }

    fn middle(&self) -> DVec3 {
        0.5 * (self.min + self.max)
    }
}

impl BlockSum for Range {
    fn add(&mut self, next: &Self) {
        self.min = self.min.min(next.min);
        self.max = self.max.max(next.max);
    }
}

/// The largest squared distance of a velocity from that, m2/s2.
fn farthest(rows: &[Velocity], middle: DVec3) -> Maximum {
    // Several at once, each without a branch; the sum tells whether one is no number.
    let (mut largest, mut sums) = ([0.0_f64; LANES], [0.0; LANES]);
    let mut take = |k: usize, v: &Velocity| {
        let squared = v.0.distance_squared(middle);
        largest[k] = if squared > largest[k] { squared } else { largest[k] };
        sums[k] += squared;
    };
    let chunks = rows.chunks_exact(LANES);
    let rest = chunks.remainder();
    chunks.for_each(|rows| (0..LANES).for_each(|k| take(k, &rows[k])));
    rest.iter().enumerate().for_each(|(k, v)| take(k, v));
    if sums.iter().any(|sum| sum.is_nan()) { Maximum(f64::NAN) } else { Maximum::of(largest.into_iter()) }
}

/// The largest squares.
#[derive(Clone, Copy, Default)]
struct Squares {
    spread: Maximum,
    stretch: Maximum,
}

impl BlockSum for Squares {
    fn add(&mut self, next: &Self) {
        self.spread.add(&next.spread);
        self.stretch.add(&next.stretch);
    }
}
