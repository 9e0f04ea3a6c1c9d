//! Bodies that pass through walls because no contact holds them off.

use glam::DVec3;

use crate::plugin::{BodyKind, SimBuilder};
use crate::schedule::{Step, StepError};
use crate::shapes::Region;
use crate::world::{BodyId, ParticleId, Position, ReferencePosition, Removed};

/// Depth of the centre of a particle in a wall from which on it is inside, over its spacing.
const DEPTH: f64 = 0.25;

/// Checks for particles of bodies inside of walls.
pub struct PassingWalls {
    pairs: Vec<BodyAndWall>,
    /// Pairs that the user has been warned of.
    pub told: Vec<bool>,
}

/// A body and a wall without a contact.
struct BodyAndWall {
    body: BodyId,
    wall: BodyId,
    region: Box<dyn Region>,
    spacing: f64,
}

impl PassingWalls {
    /// All pairs of a scene that have no contact.
    pub fn new(sim: &SimBuilder<'_>) -> Self {
        let touching = sim.touching_pairs();
        let of = |kind: BodyKind| sim.bodies().iter().filter(move |body| body.kind == kind);
        let mut pairs = Vec::new();
        for wall in of(BodyKind::Boundary) {
            for body in of(BodyKind::Rigid).chain(of(BodyKind::Solid)) {
                let shape = &sim.scene().bodies[wall.id.0].shape;
                let Ok(region) = shape.region(sim.dimension(), sim.folder(), "shape") else { continue };
                if !touching.has(&body.name, &wall.name) {
                    pairs.push(BodyAndWall { body: body.id, wall: wall.id, region, spacing: body.spacing });
                }
            }
        }
        Self { told: vec![false; pairs.len()], pairs }
    }

    /// Checks all pairs; rotation of walls is ignored.
    pub fn look(&mut self, step: &mut Step<'_>) -> Result<(), StepError> {
        for (pair, told) in self.pairs.iter().zip(&mut self.told).filter(|(_, told)| !**told) {
            let (view, rows) = step.world.body_view(pair.wall);
            let (x, reference) = (view.read::<Position>()?, view.read::<ReferencePosition>()?);
            let shift = rows.clone().next().map_or(DVec3::ZERO, |row| x[row].0 - reference[row].0);
            let (view, rows) = step.world.body_view(pair.body);
            let (position, removed) = (view.read::<Position>()?, view.read::<Removed>()?);
            let is_inside = |row: &usize| {
                removed[*row] == Removed::NO
                    && pair.region.distance(position[*row].0 - shift) < -DEPTH * pair.spacing
            };
            let Some(row) = rows.clone().find(is_inside) else { continue };
            *told = true;
            let name = |body| &step.world.body(body).name;
            step.warnings.push(format!(
                "particle {} of `{1}` is inside of `{2}`, at {3} and {4:.6e} s, and no contact holds the two apart: add \
                 `contacts: [Contact(between: (\"{1}\", \"{2}\"), law: Penalty())]`",
                view.read::<ParticleId>()?[row].0,
                name(pair.body),
                name(pair.wall),
                position[row].0,
                step.clock.time
            ));
        }
        Ok(())
    }
}
