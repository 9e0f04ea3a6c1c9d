//! A field at a point: an average over the particles nearby, corrected so that a linear field comes out
//! exactly.

use glam::DVec3;
use rayon::prelude::*;

use super::shares::shares;
use crate::fields::ChosenField;
use crate::materials::Law;
use crate::neighbors::Periodic;
use crate::plugin::BodyPlan;
use crate::schedule::Resources;
use crate::shapes::Site;
use crate::world::{BodyId, MissingColumn, PhaseId, Position, Removed, World};

/// Reach of the average over the spacing of a body: less would leave a single particle at a corner.
const REACH: f64 = 2.0;

/// A field interpolated at a point of space, from the bodies that have it and are of the phase of the nearest
/// particle: a solid and the fluid beside it have their own pressure and velocity, and no mean of the two is
/// that of either.
pub struct PointGauge {
    pub(super) at: DVec3,
    pub(super) field: ChosenField,
    pub(super) periodic: Periodic,
}

/// A particle near the point.
struct NearPoint {
    phase: PhaseId,
    weight: f64,
    offset: DVec3,
    values: Vec<f64>,
}

impl PointGauge {
    /// The field at the point, one number for each component; NaN where no particle is near.
    pub(super) fn read(&self, world: &World, resources: &Resources) -> Result<Vec<f64>, MissingColumn> {
        let near = self.near(world, resources)?;
        if near.is_empty() {
            return Ok(vec![f64::NAN; self.field.width()]);
        }
        let places: Vec<(f64, DVec3)> = near.iter().map(|p| (p.weight, p.offset)).collect();
        let shares = shares(&places, world.dimension().count());
        let component = |c: usize| near.iter().zip(&shares).map(|(p, share)| share * p.values[c]).sum();
        Ok((0..self.field.width()).map(component).collect())
    }

    /// Whether none of the bodies that have the field is near the point at the start, and none of them flows
    /// there later.
    pub(super) fn is_empty(&self, bodies: &[BodyPlan]) -> bool {
        let measured = || bodies.iter().filter(|body| self.field.is_in(body.id));
        let distance = |site: &Site| self.periodic.minimal_image(site.position - self.at).length();
        let is_near = |body: &BodyPlan| body.sites.iter().any(|site| distance(site) < REACH * body.spacing);
        let flows = measured().any(|body| matches!(body.material.law, Law::Fluid(_)));
        !flows && !measured().any(is_near)
    }

    /// Particles of one phase within reach, in the order of bodies and rows. The weight is volume times (1 -
    /// r / reach)^2.
    fn near(&self, world: &World, resources: &Resources) -> Result<Vec<NearPoint>, MissingColumn> {
        let mut near = Vec::new();
        for (k, body) in world.bodies().iter().enumerate().filter(|(k, _)| self.field.is_in(BodyId(*k))) {
            let reach = REACH * body.spacing;
            let volume = body.spacing.powi(world.dimension().count() as i32);
            let found: Vec<(usize, DVec3)> = {
                let position = world.phase(body.phase).read::<Position>()?;
                let position: &[Position] = &position;
                let removed = world.phase(body.phase).read::<Removed>()?;
                let removed: &[Removed] = &removed;
                let offset = |row: usize| (row, self.periodic.minimal_image(position[row].0 - self.at));
                let within = |(row, offset): &(usize, DVec3)| {
                    offset.length_squared() < reach * reach && removed[*row] == Removed::NO
                };
                body.rows.clone().into_par_iter().with_min_len(4096).map(offset).filter(within).collect()
            };
            for (row, offset) in found {
                let weight = volume * (1.0 - offset.length() / reach).powi(2);
                let values = self.field.read(world, resources, BodyId(k), row..row + 1)?;
                near.push(NearPoint { phase: body.phase, weight, offset, values });
            }
        }
        let distance = |particle: &NearPoint| particle.offset.length_squared();
        let nearest = near.iter().min_by(|a, b| distance(a).total_cmp(&distance(b)));
        if let Some(phase) = nearest.map(|particle| particle.phase) {
            near.retain(|particle| particle.phase == phase);
        }
        Ok(near)
    }
}
