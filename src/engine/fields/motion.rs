//! Fields of the motion.

use glam::DVec3;

use super::field::Field;
use crate::world::{Position, ReferencePosition, Velocity};

/// Displacement u = x - X and speed |v|.
pub(super) fn fields() -> Vec<Field> {
    vec![
        Field::new::<(ReferencePosition, Position), DVec3>("displacement", "m", |(from, to)| to.0 - from.0)
            .about("Displacement from the reference position"),
        Field::new::<(Velocity,), f64>("speed", "m/s", |(v,)| v.0.length())
            .about("Magnitude of the velocity"),
    ]
}
