//! Fluids that lie on each other: what the upper ones press with at the start.

use glam::DVec3;

use crate::plugin::BodyPlan;

/// Pressure that fluids at rest exert on the top of a body, Pa: of one that lies on it and covers it, and of those above that. Only gravity along an axis makes layers.
pub(super) fn pressure_above(body: &BodyPlan, fluids: &[&BodyPlan], gravity: DVec3) -> f64 {
    let Some(up) = (0..3).find(|&axis| gravity[axis].abs() == gravity.length() && gravity[axis] != 0.0)
    else {
        return 0.0;
    };
    let height = |body: &BodyPlan| {
        let (low, high) = (body.bounds.min[up], body.bounds.max[up]);
        if gravity[up] < 0.0 { (low, high) } else { (-high, -low) }
    };
    let top = height(body).1;
    let lies_on = |other: &&&BodyPlan| {
        let covers = |axis: usize| {
            other.bounds.min[axis] < body.bounds.min[axis] + body.spacing
                && other.bounds.max[axis] > body.bounds.max[axis] - body.spacing
        };
        (height(other).0 - top).abs() < 0.5 * body.spacing
            && height(other).1 > top + body.spacing
            && (0..3).filter(|&axis| axis != up).all(covers)
    };
    let press = |other: &&BodyPlan| {
        let (low, high) = height(other);
        other.material.density * gravity.length() * (high - low) + pressure_above(other, fluids, gravity)
    };
    fluids.iter().filter(lies_on).map(press).fold(0.0, f64::max)
}
