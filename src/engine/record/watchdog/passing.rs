//! Solids and rigid bodies that pass through each other because no contact holds them apart.

use glam::DVec3;

use super::particles_in::{ParticlesIn, bounds};
use crate::neighbors::{Cloud, NeighborList, Periodic, SupportRadii};
use crate::notation::{place, quantity};
use crate::plugin::{BodyKind, BodyPlan, SimBuilder};
use crate::schedule::{Step, StepError};
use crate::shapes::Aabb;
use crate::world::BodyId;

/// Distance of particles of two bodies, over their mean spacing, below which the bodies overlap: those that
/// touch are one spacing apart.
const OVERLAP: f64 = 0.6;

/// Checks whether particles of bodies are inside of each other.
pub(super) struct PassingBodies {
    pairs: Vec<[BodyId; 2]>,
    spacings: Vec<f64>,
    /// Pairs that the user has been warned of.
    pub told: Vec<bool>,
}

impl PassingBodies {
    /// All pairs of solids and rigid bodies that have no contact; two half-spaces always overlap.
    pub fn new(sim: &SimBuilder<'_>) -> Self {
        let touching = sim.touching_pairs();
        let solid = |body: &&BodyPlan| matches!(body.kind, BodyKind::Solid | BodyKind::Rigid);
        let bodies = || sim.bodies().iter().filter(solid);
        let all = bodies().flat_map(|a| bodies().filter(|b| a.id.0 < b.id.0).map(move |b| (a, b)));
        let all = all.filter(|(a, b)| a.bounds.is_bounded() || b.bounds.is_bounded());
        let pairs: Vec<[BodyId; 2]> =
            all.filter(|(a, b)| !touching.has(a.id, b.id)).map(|(a, b)| [a.id, b.id]).collect();
        let spacings = sim.bodies().iter().map(|body| body.spacing).collect();
        Self { told: vec![false; pairs.len()], pairs, spacings }
    }

    /// Checks all pairs.
    ///
    /// # Errors
    /// A column is missing.
    pub fn look(&mut self, step: &mut Step<'_>) -> Result<(), StepError> {
        for (&[a, b], told) in self.pairs.iter().zip(&mut self.told).filter(|(_, told)| !**told) {
            let mean_spacing = 0.5 * (self.spacings[a.0] + self.spacings[b.0]);
            let Some(at) = overlap(step, [a, b], OVERLAP * mean_spacing)? else { continue };
            *told = true;
            let [first, second] = [a, b].map(|body| &step.world.body(body).name);
            step.warnings.push(format!(
                "`{first}` and `{second}` pass through each other, at {} and {}, and no contact holds them apart: add \
                 `contacts: [Contact(between: (\"{first}\", \"{second}\"), law: Penalty())]`",
                place(at),
                quantity(step.clock.time, "s")
            ));
        }
        Ok(())
    }
}

/// Where particles of two bodies are nearer than `distance`.
fn overlap(step: &Step<'_>, bodies: [BodyId; 2], distance: f64) -> Result<Option<DVec3>, StepError> {
    let boxes = [bounds(step, bodies[0])?, bounds(step, bodies[1])?];
    let common = Aabb {
        min: boxes[0].min.max(boxes[1].min) - distance,
        max: boxes[0].max.min(boxes[1].max) + distance,
    };
    if !common.min.cmple(common.max).all() {
        return Ok(None);
    }
    let mut near = ParticlesIn::default();
    near.find(step, bodies[0], Some(&common))?;
    let mut positions = near.places.clone();
    let firsts = positions.len();
    near.find(step, bodies[1], Some(&common))?;
    positions.extend(&near.places);
    let cloud = Cloud { positions: &positions, support: SupportRadii::Uniform(distance) };
    let Ok(list) = NeighborList::reference(cloud, &Periodic::NONE) else { return Ok(None) };
    let meets = |i: &usize| list.row(*i).iter().any(|&j| j as usize >= firsts);
    Ok((0..firsts).find(meets).map(|i| positions[i]))
}
