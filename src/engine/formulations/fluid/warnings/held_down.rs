//! Light rigid bodies that the flow presses against what they touch.
//!
//! Where no particle of the fluid fits between a body and a wall, the fluid has no pressure there, and its
//! force on the rest of the body presses the two together. A heavy body rests on the wall in any case; one
//! that is lighter than the fluid should rise. A container that stands in the dry with its fluid inside does
//! not.

use glam::DVec3;
use serde::{Deserialize, Serialize};

use crate::formulations::fluid::cloud::FlowCloud;
use crate::notation::quantity;
use crate::parallel::sum_over_blocks;
use crate::rigid::{RigidBodies, RigidBody};
use crate::schedule::{Step, StepError};
use crate::world::{BodyId, ReferenceVolume};

/// Frames in sequence in which a body is held down before it is reported: what falls onto a body presses it
/// down for a moment.
const FRAMES: u32 = 3;
/// Way from one frame to the next, over the spacing of the fluid, up to which a body stays where it is.
const STILL: f64 = 0.05;
/// Force over the weight of the fluid in the place of a body from which on it holds the body down. Sound that
/// crosses a body of next to no mass exerts less, and the body follows it: 1e-4 on a disc of a thousandth of
/// the density of the fluid.
const PRESSED: f64 = 0.01;

/// Observations of a body in the last frames.
#[derive(Clone, Serialize, Deserialize)]
pub struct SeenFrames {
    body: u32,
    /// In the frame in which energies count, m.
    place: DVec3,
    frames: u32,
}

/// Checks for light bodies that stay below.
pub struct HeldDown {
    /// Acceleration of gravity, m/s2.
    gravity: DVec3,
    /// Spacing of the fluid, m.
    spacing: f64,
    pub seen: Vec<SeenFrames>,
}

impl HeldDown {
    /// Under this gravity, m/s2, in a fluid of this spacing, m.
    pub fn new(gravity: DVec3, spacing: f64) -> Self {
        Self { gravity, spacing, seen: Vec::new() }
    }

    /// Checks all rigid bodies that are free along gravity.
    pub fn look(&mut self, cloud: &FlowCloud, step: &mut Step<'_>) -> Result<(), StepError> {
        let Self { gravity, spacing, .. } = *self;
        let Some(bodies) = step.resources.try_get::<RigidBodies>() else { return Ok(()) };
        if gravity == DVec3::ZERO {
            return Ok(());
        }
        let lightest = cloud.groups.iter().filter_map(|group| group.fluid());
        let lightest = lightest.map(|state| state.density).fold(f64::INFINITY, f64::min);
        let falls =
            |body: &&RigidBody| (0..3).all(|axis| gravity[axis] == 0.0 || !body.is_driven_along(axis));
        for body in bodies.iter().filter(falls) {
            let (view, rows) = step.world.body_view(body.id);
            let volume =
                sum_over_blocks(&view.read::<ReferenceVolume>()?[rows], &|_, rows: &[ReferenceVolume]| {
                    rows.iter().map(|volume| volume.0).sum::<f64>()
                });
            let number = body.id.0 as u32;
            let before = self.seen.iter().find(|seen| seen.body == number).cloned();
            let place = body.state.center - step.clock.time * step.ledger.frame();
            let moved = before.as_ref().map_or(f64::INFINITY, |seen| seen.place.distance(place));
            let is_still = moved < STILL * spacing;
            let is_light = body.mass < lightest * volume;
            let Some(down) = is_light.then(|| force_on(cloud, body.id).dot(gravity.normalize())) else {
                continue;
            };
            let is_pressed = down > PRESSED * lightest * volume * gravity.length();
            let held = is_still && is_pressed && is_wet_below(cloud, body.id, gravity.normalize(), spacing);
            let frames = if held { before.map_or(0, |seen| seen.frames) + 1 } else { 0 };
            self.seen.retain(|seen| seen.body != number);
            self.seen.push(SeenFrames { body: number, place, frames });
            if frames == FRAMES {
                step.warnings.push(format!(
                    "the rigid body `{}` is lighter than the fluid, which presses it down with {} at {}: no particle of the fluid fits between it and what it \
                     touches, so that its pressure is missing there; start the body two spacings of the fluid away from it, or use smaller spacings",
                    step.world.body(body.id).name,
                    quantity(down, "N"),
                    quantity(step.clock.time, "s")
                ));
            }
        }
        Ok(())
    }
}

/// Whether fluid beside a body reaches as far down as the body itself, to a spacing, m.
fn is_wet_below(cloud: &FlowCloud, body: BodyId, down: DVec3, spacing: f64) -> bool {
    let rows = cloud.groups.iter().filter(|group| group.body == body).flat_map(|group| group.cloud.clone());
    let (mut lowest, mut lowest_fluid) = (f64::NEG_INFINITY, f64::NEG_INFINITY);
    for row in rows {
        let own = cloud.records[row].position();
        lowest = own.dot(down).max(lowest);
        let way = |&j: &u32| cloud.offset(own, cloud.records[j as usize].position());
        let near = cloud.near_row(row).iter().map(way).filter(|x| x.length() < cloud.kernel.support);
        lowest_fluid = near.fold(lowest_fluid, |depth, x| depth.max((own + x).dot(down)));
    }
    lowest_fluid > lowest - spacing
}

/// Force of the fluids on a body, N.
fn force_on(cloud: &FlowCloud, body: BodyId) -> DVec3 {
    let forces = cloud.forces_on(body).unwrap_or_default();
    sum_over_blocks(&forces[..], &|_, rows: &[(DVec3, DVec3)]| {
        rows.iter().map(|(force, _)| *force).sum::<DVec3>()
    })
}
