//! Damping of bodies that take sub-steps beside a fluid, against vibrations driven by its frozen force.

use glam::DVec3;

use super::light_body::{STIFFNESS, surface_area};
use crate::formulations::fluid::walls::has_suction;
use crate::materials::Law;
use crate::plugin::{BodyKind, BodyPlan, SimBuilder};
use crate::solids::{DampedSubSteps, LeastTime};
use crate::world::{BodyId, BodySet};

/// Share of the damping of bodies with the spacing of the fluid, in the sub-steps that the body alone would
/// take. A strip of rubber, four particles of the water beside it thick and two of its own to each, rings
/// with 0.02 and is quiet with 0.05.
///
/// Modes that swing to and fro in two steps of the fluid grow the fastest, by the stiffness of the fluid over
/// the mass of the body, per mode. The damping acts in each sub-step by what has changed in it, so that a
/// body of finer particles, in more sub-steps, needs a larger share: what it needs is a time. A sheet with
/// two particles of the water to its thickness, four and eight of its own, grows with 0.1 and not with 0.2;
/// with suction it grows with 0.2, eight across with 0.4 too, and not with 0.4 and 0.8.
const SHARE: f64 = 0.1;
/// The same where bodies have suction. Their rate of compression counts both the particles of the body and
/// the adjoint of its pressure, which doubles the stiffness of the fluid beside it: modes that swing to and
/// fro in two steps of the fluid, such as the breathing of a sheet between two layers of water, grow with 0.1
/// for some moduli. With 0.2 none grew, at 2.2 to 40 MPa in steps of 4.5 %.
const SHARE_WITH_SUCTION: f64 = 0.2;
/// Largest share of a body that touches nothing.
const MOST: f64 = 0.65;
/// The same of others, and with steps longer than the stable ones: bonds and contacts together may take 0.9
/// of those, which leaves room for 0.22.
const MOST_IN_CONTACT: f64 = 0.2;
/// Largest share with which sub-steps of it need not be shorter. By the estimate of the stable step, of which
/// sub-steps take 0.65, that would be 0.68; a sheet of two layers is stable with 0.28, and not with 0.44.
const ROOM: f64 = 0.25;

/// Thickness in spacings of the fluid from which a body is not thin. At 2, with suction, breathing modes grow
/// in steps of 0.9 of the longest for some moduli between 0.2 and 30 MPa (500 and 1000 kg/m3), and do not in
/// steps of 0.8; at 3 none does.
const THICK: f64 = 3.0;
/// Share in the longest long step over the largest one otherwise.
const LONGEST: f64 = 2.0;
/// Stable step of usual bodies over that in which longitudinal waves cross a spacing.
const STABLE: f64 = 0.7;
/// Margin of the damping over the growth of modes that move the whole thickness of a body.
const MARGIN: f64 = 2.0;

/// Asks for the damping of all deformable bodies of a scene with fluids, if they may take sub-steps.
pub fn damp_sub_cycled_bodies(sim: &mut SimBuilder<'_>) {
    let soft = sim.bodies().iter().filter(|body| body.kind == BodyKind::Solid);
    let soft: Vec<_> = soft.map(|body| body.id).collect();
    for id in soft {
        if let Some((needed, most)) = share_of(id, sim) {
            let factor = sim.scene().time.step.factor();
            let least = least_time(id, mean_thickness(id, sim), sim);
            let touches = most < MOST;
            let room = if touches { most } else { ROOM };
            let share = needed.min(most);
            let damping = DampedSubSteps { share, room, touches, factor, least, most: LONGEST * most };
            sim.extend_bodies(BodySet::new([id]), "damping of its sub-steps", damping);
        }
    }
}

/// What remains of the long step beside a body, and the largest one, s.
///
/// The growth falls with the square of the step: where the share would be too large the step is smaller, and
/// in thin bodies, on whose little mass the fluid acts. The time of the damping grows with the square of the
/// step and shortens the sub-steps once it exceeds what they have room for: at the largest one by about a
/// half.
pub fn limits_of_long_step(id: BodyId, sim: &SimBuilder<'_>) -> (f64, f64) {
    let body = sim.body(id);
    let Some((needed, most)) = share_of(id, sim).filter(|_| body.kind == BodyKind::Solid) else {
        return (1.0, f64::INFINITY);
    };
    let thickness = mean_thickness(id, sim);
    let flow = flow(sim).map_or(body.spacing, |flow| flow.spacing);
    let share = ((most / needed).min(1.0) * (thickness / (THICK * flow)).min(1.0)).sqrt();
    let speed = body.material.sound_speed().unwrap_or(0.0);
    let longest = least_time(id, thickness, sim).longest_step(LONGEST * most * STABLE * body.spacing / speed);
    (share, longest)
}

/// Least time of the damping of a body of that mean thickness, m. A mode on whose mass m the fluid acts with
/// the stiffness `kappa m` gains no energy if that time is `kappa dt^3 / 24` in a long step dt of half its
/// period. Of the modes of a stiff body, those that matter move its whole thickness, so that kappa is the
/// stiffness of the fluid before all of its surface over its mass; and dt is at most 0.4 h / c_0, so that
/// `dt / h` is at most 0.4 / c_0.
fn least_time(id: BodyId, thickness: f64, sim: &SimBuilder<'_>) -> LeastTime {
    let impedance = |body: &BodyPlan| match body.material.law {
        Law::Fluid(_) => body.material.density * body.material.sound_speed().unwrap_or(0.0),
        _ => 0.0,
    };
    let impedance = sim.bodies().iter().map(impedance).fold(0.0, f64::max);
    let body = sim.body(id);
    let sides = if has_suction(sim) { 1.0 } else { 0.5 };
    let area_over_mass = 2.0 / (thickness * body.material.density);
    let rate = MARGIN * sides * STIFFNESS * 0.4 / 24.0 * impedance * area_over_mass;
    LeastTime { rate, lowest: lowest_frequency(body, thickness) }
}

/// Twice the volume of a body over its surface, m; infinite where its shape is not known.
fn mean_thickness(id: BodyId, sim: &SimBuilder<'_>) -> f64 {
    surface_area(id, sim).map_or(f64::INFINITY, |area| 2.0 * sim.body(id).volume() / area)
}

/// The first fluid.
fn flow<'s>(sim: &'s SimBuilder<'_>) -> Option<&'s BodyPlan> {
    sim.bodies().iter().find(|body| matches!(body.material.law, Law::Fluid(_)))
}

/// Lowest frequency of a body, rad/s: the first bending of a cantilever of its `thickness`, m, and its
/// length, `3.52 (E / (12 rho))^(1/2) t / l^2`; those of bodies that are held otherwise, and of compact ones,
/// are higher.
fn lowest_frequency(body: &BodyPlan, thickness: f64) -> f64 {
    let (min, max) = body.sites.iter().fold((DVec3::INFINITY, DVec3::NEG_INFINITY), |(min, max), site| {
        (min.min(site.position), max.max(site.position))
    });
    let young = match &body.material.law {
        Law::Solid(law) => law.elastic().young,
        Law::Fluid(_) | Law::Nothing => 0.0,
    };
    3.52 * (young / (12.0 * body.material.density)).sqrt() * thickness / (max - min).length_squared()
}

/// Share of the damping that a body needs, and the largest one; none where it takes no sub-steps.
fn share_of(id: BodyId, sim: &SimBuilder<'_>) -> Option<(f64, f64)> {
    let time = &sim.scene().time;
    if time.sub_steps <= 1 {
        return None;
    }
    let (flow, body) = (flow(sim)?, sim.body(id));
    let share = if has_suction(sim) { SHARE_WITH_SUCTION } else { SHARE };
    let is_long = time.step.factor() > 1.0;
    let has_room = !is_long && !sim.touching_pairs().names(id);
    let most = if has_room { MOST } else { MOST_IN_CONTACT };
    Some((share * (flow.spacing / body.spacing).max(1.0), most))
}
