//! Directions for quantities of probes.

use glam::DVec3;

use crate::plugin::SimBuilder;
use crate::scene::{Dimension, Problem, Vec3};

/// The unit vector of a direction that the field `field` of the quantity of probe `k` gives.
pub(super) fn direction(
    k: usize,
    field: &str,
    vector: Vec3,
    sim: &SimBuilder<'_>,
) -> Result<DVec3, Vec<Problem>> {
    let plane = sim.dimension() == Dimension::Two;
    vector.0.try_normalize().filter(|unit| !plane || unit.z == 0.0).ok_or_else(|| {
        let path = format!("probes[{k}].quantity.{field}");
        let message = "the direction must not be a zero vector";
        vec![Problem::at_path(path, message).help("in two dimensions it has no z component")]
    })
}
