//! The default speed of sound of fluids.

use glam::DVec3;

use crate::materials::Law;
use crate::plugin::{BodyKind, BodyPlan};
use crate::scene::{Problem, Scene};

/// Speed of sound over the largest speed that the flow is expected to reach: density then changes by about 1
/// %.
const RATIO: f64 = 10.0;

/// Gives the fluids without a speed of sound ten times the largest of the speeds of all bodies at the start,
/// against rest or against the one that bounds the flow, or, where nothing does, against the centre of mass
/// of all, and of a fall through the height of all fluid bodies.
///
/// # Errors
/// Nothing moves, so that there is nothing to estimate from.
pub fn estimate(bodies: &mut [BodyPlan], scene: &Scene) -> Result<(), Vec<Problem>> {
    let gravity = scene.gravity.0;
    let heights = bodies.iter().filter(|body| matches!(body.material.law, Law::Fluid(_)));
    let heights = heights.flat_map(|body| body.sites.iter()).map(|site| -site.position.dot(gravity));
    let (low, high) = heights.fold((f64::INFINITY, f64::NEG_INFINITY), |(a, b), x| (a.min(x), b.max(x)));
    let fall = if high > low { (2.0 * (high - low)).sqrt() } else { 0.0 };
    let velocity = |body: &BodyPlan| body.velocity.map_or(DVec3::ZERO, |v| v.0);
    let fastest = |frame: DVec3| bodies.iter().map(|body| velocity(body).distance(frame)).fold(0.0, f64::max);
    let bounds = || bodies.iter().filter(|body| body.kind != BodyKind::Fluid);
    let at_rest = fastest(DVec3::ZERO);
    let slowest = if bounds().next().is_some() {
        bounds().map(|body| fastest(velocity(body))).fold(at_rest, f64::min)
    } else {
        fastest(mean_velocity(bodies))
    };
    let fastest = if fall.max(slowest) > 0.0 { fall.max(slowest) } else { at_rest };
    let mut problems = Vec::new();
    for body in bodies {
        let Law::Fluid(law) = &mut body.material.law else { continue };
        if law.sound_speed.is_none() && fastest > 0.0 {
            law.sound_speed = Some(RATIO * fastest);
        } else if law.sound_speed.is_none() {
            let message = format!(
                "the fluid `{}` gives no `sound_speed`, and without gravity and velocities there is nothing to estimate it from",
                body.material_name
            );
            let at = format!("materials.{}", body.material_name);
            problems.push(
                Problem::at_path(at, message)
                    .help("give ten times the largest of the speed that the flow will reach and of sqrt(p / density) of its pressure differences p, which friction and loads make too"),
            );
        }
    }
    if problems.is_empty() { Ok(()) } else { Err(problems) }
}

/// Velocity of the centre of mass of all bodies, m/s.
fn mean_velocity(bodies: &[BodyPlan]) -> DVec3 {
    let (mut mass, mut momentum) = (0.0, DVec3::ZERO);
    for body in bodies {
        let of_body = body.mass();
        mass += of_body;
        momentum += of_body * body.velocity.map_or(DVec3::ZERO, |v| v.0);
    }
    if mass > 0.0 { momentum / mass } else { DVec3::ZERO }
}
