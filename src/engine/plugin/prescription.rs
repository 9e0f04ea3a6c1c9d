//! Motion that conditions prescribe, and whether two prescriptions are equal.

use std::fmt;
use std::sync::Arc;

use glam::DVec3;

/// A function of the reference position, m, and of time, s.
pub type MotionOfPlace = Arc<dyn Fn(DVec3, f64) -> DVec3 + Send + Sync>;

/// The motion that a condition prescribes to particles, or to a rigid body.
#[derive(Clone)]
pub struct Prescription {
    by: &'static str,
    motion: Motion,
}

#[derive(Clone)]
enum Motion {
    Unknown,
    Velocity(MotionOfPlace),
    Displacement(MotionOfPlace),
}

/// Times of a run at which two motions are compared.
const TIMES: u32 = 64;
/// Difference of two values that is round-off, over the larger one.
const ROUNDING: f64 = 1e-9;

impl Prescription {
    /// No motion at all, by the condition of that name.
    pub fn rest(by: &'static str) -> Self {
        Self::velocity(by, Arc::new(|_, _| DVec3::ZERO))
    }

    /// A velocity, m/s, by the condition of that name.
    pub fn velocity(by: &'static str, value: MotionOfPlace) -> Self {
        Self { by, motion: Motion::Velocity(value) }
    }

    /// A displacement from the reference position, m, by the condition of that name.
    pub fn displacement(by: &'static str, value: MotionOfPlace) -> Self {
        Self { by, motion: Motion::Displacement(value) }
    }

    /// Name of the condition.
    pub fn by(&self) -> &'static str {
        self.by
    }

    /// The velocity of a place, m/s; of a displacement the difference over `apart`, s. None where only the
    /// condition knows it.
    pub fn velocity_of_place(&self, apart: f64) -> Option<MotionOfPlace> {
        match &self.motion {
            Motion::Unknown => None,
            Motion::Velocity(value) => Some(Arc::clone(value)),
            Motion::Displacement(value) => {
                let value = Arc::clone(value);
                Some(Arc::new(move |point, t| (value(point, t + apart) - value(point, t)) / apart))
            }
        }
    }

    /// Whether both prescribe the same motion along an axis, until `end`, s, of the particle at `point` in
    /// the reference configuration. An unknown motion agrees with none, and a velocity with a displacement
    /// where both are zero.
    pub fn agrees(&self, other: &Self, axis: usize, point: DVec3, end: f64) -> bool {
        let of = |value: &MotionOfPlace, k: u32| value(point, end * f64::from(k) / f64::from(TIMES))[axis];
        let same = |a: f64, b: f64| (a - b).abs() <= ROUNDING * a.abs().max(b.abs());
        match (&self.motion, &other.motion) {
            (Motion::Velocity(one), Motion::Velocity(two))
            | (Motion::Displacement(one), Motion::Displacement(two)) => {
                (0..=TIMES).all(|k| same(of(one, k), of(two, k)))
            }
            (Motion::Unknown, _) | (_, Motion::Unknown) => false,
            (
                Motion::Velocity(one) | Motion::Displacement(one),
                Motion::Velocity(two) | Motion::Displacement(two),
            ) => (0..=TIMES).all(|k| of(one, k) == 0.0 && of(two, k) == 0.0),
        }
    }
}

/// A motion that only the condition of that name knows.
impl From<&'static str> for Prescription {
    fn from(by: &'static str) -> Self {
        Self { by, motion: Motion::Unknown }
    }
}

impl fmt::Debug for Prescription {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_tuple("Prescription").field(&self.by).finish()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn motions_agree_where_their_values_do() {
        let of = |f: fn(DVec3, f64) -> DVec3| Prescription::velocity("Velocity", Arc::new(f));
        let rest = Prescription::rest("Fix");
        let ramp = of(|x, t| DVec3::new(x.x * t, 0.0, 0.0));
        let (left, right) = (DVec3::ZERO, DVec3::X);
        assert!(rest.agrees(&ramp, 0, left, 1.0) && rest.agrees(&ramp, 1, right, 1.0));
        assert!(!rest.agrees(&ramp, 0, right, 1.0));
        assert!(ramp.agrees(&of(|x, t| DVec3::X * t * x.x * (1.0 + 1e-15)), 0, right, 1.0));
        let moved = Prescription::displacement("Displacement", Arc::new(|x, t| DVec3::X * x.x * t));
        assert!(!ramp.agrees(&moved, 0, right, 1.0) && rest.agrees(&moved, 0, left, 1.0));
        assert!(!Prescription::from("Own").agrees(&rest, 0, left, 1.0));
    }
}
