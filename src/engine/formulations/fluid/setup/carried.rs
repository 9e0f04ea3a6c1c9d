//! Fluids that something carries at the start: a wall, a body that a condition holds or loads, or anything
//! that stands on one of these, by bodies and fluids that touch each other. What nothing carries falls
//! freely, a drop as a flask full of water.

use glam::DVec3;
use rayon::prelude::*;

use crate::plugin::{BodyKind, BodyPlan, SimBuilder};
use crate::shapes::{Region, Site, images_near};
use crate::world::BodyId;

/// A body that others may touch.
pub(super) struct Touchable<'a> {
    pub id: BodyId,
    pub region: &'a dyn Region,
}

/// Whether each of the first `fluids` of these bodies is carried; `reach`, m, is the distance of a particle
/// from another body below which the two touch.
pub(super) fn carried(
    bodies: &[Touchable<'_>],
    fluids: usize,
    gravity: DVec3,
    reach: f64,
    sim: &SimBuilder<'_>,
) -> Vec<bool> {
    let mut found: Vec<bool> = bodies.iter().map(|body| carries(sim.body(body.id), gravity, sim)).collect();
    let mut due: Vec<usize> = (0..bodies.len()).filter(|&k| found[k]).collect();
    while let Some(below) = due.pop() {
        if found[..fluids].iter().all(|is_carried| *is_carried) {
            break;
        }
        for k in 0..bodies.len() {
            if !found[k] && touches(&bodies[k], &bodies[below], reach, sim) {
                found[k] = true;
                due.push(k);
            }
        }
    }
    found.truncate(fluids);
    found
}

/// Whether a body carries others against gravity, m/s^2, by itself.
fn carries(body: &BodyPlan, gravity: DVec3, sim: &SimBuilder<'_>) -> bool {
    body.kind == BodyKind::Boundary || sim.is_carried(body.id, gravity)
}

/// The warning of a body beside fluids where nothing carries anything against gravity, m/s^2.
pub(super) fn uncarried(gravity: DVec3, sim: &SimBuilder<'_>) -> Option<String> {
    let mut others = sim.bodies().iter().filter(|body| body.kind != BodyKind::Fluid);
    let first = others.clone().next()?;
    let falls = gravity != DVec3::ZERO && !others.any(|body| carries(body, gravity, sim));
    falls.then(|| {
        format!(
            "nothing carries `{0}` and its fluid, which fall freely: there is no wall, and no body that a condition holds; if `{0}` is to stay, give it \
             `Fix(on: Select(body: \"{0}\"))`, or the formulation `Wall`",
            first.name
        )
    })
}

/// Whether a particle of a body is within `reach`, m, of another one.
fn touches(body: &Touchable<'_>, other: &Touchable<'_>, reach: f64, sim: &SimBuilder<'_>) -> bool {
    let periodic = sim.periodic();
    let is_near = |site: &Site| {
        let images = images_near(&other.region.bounds(), site.position, periodic.lengths(), reach);
        images.into_iter().any(|place| other.region.distance(place) < reach)
    };
    sim.body(body.id).sites.par_iter().any(is_near)
}
