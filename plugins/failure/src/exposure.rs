//! Wear: failed particles at a surface of their body are removed, those inside stay.
//!
//! The neighbours of a particle lie on one side of it where there is a surface: their mean direction, with
//! the weights of the gradient, leads inwards. A particle is at the surface if no neighbour lies outwards of
//! it, within 40 degrees of the normal. A hole of single particles inside a body is no surface, because there
//! are particles beyond it.

use glam::DVec3;
use meshless_engine::bytemuck;
use meshless_engine::plugin::SimBuilder;
use meshless_engine::removal::RemovalRule;
use meshless_engine::schedule::{Access, Mode, Run, Stage, Step, StepError, System};
use meshless_engine::solids::{PACKED_SOLID, SolidPhase};
use meshless_engine::world::{BodyId, BodySet, Column, Damage, Position, Removed};

use crate::Exposed;

/// Cosine of the angle around the normal within which a surface has no neighbours.
const CONE: f64 = 0.766;
/// Mean direction of the neighbours, of the sum of lengths, below which they surround a particle.
const SURROUNDED: f64 = 0.05;

/// Adds what marks and removes the failed particles of some bodies.
pub(crate) fn add(sim: &mut SimBuilder<'_>, bodies: &[BodyId]) {
    let set = BodySet::new(bodies.iter().copied());
    sim.add_column_to::<Exposed>(&set);
    sim.add_system(
        System::new(Stage::PostStep, "exposure", Exposure { bodies: bodies.to_vec() })
            .on_bodies(set)
            .by_body()
            .reads::<Position>()
            .touches(PACKED_SOLID, Mode::ReadsNear)
            .reads::<Damage>()
            .reads::<Removed>()
            .writes::<Exposed>(),
    );
    sim.add_removal_rule(Worn { bodies: bodies.to_vec() });
}

/// Marks the failed particles that are at a surface.
struct Exposure {
    bodies: Vec<BodyId>,
}

impl Run for Exposure {
    fn run(&mut self, step: &mut Step<'_>) -> Result<(), StepError> {
        for &body in self.bodies.iter().filter(|&&body| step.part.is_due(step.world, body)) {
            let (view, rows) = step.world.body_view(body);
            let Some(solid) = step.resources.solid(step.world.body(body).phase) else { continue };
            let (damage, removed) = (view.read::<Damage>()?, view.read::<Removed>()?);
            let position = view.read::<Position>()?;
            let mut exposed = view.write::<Exposed>()?;
            for row in rows {
                let has_failed = damage[row].0 >= 1.0 && removed[row] == Removed::NO;
                let is_exposed = has_failed && is_at_surface(&*solid, bytemuck::cast_slice(&position), row);
                exposed[row] = Exposed(u32::from(is_exposed));
            }
        }
        Ok(())
    }
}

/// Whether a particle is at a surface of its body.
fn is_at_surface(solid: &dyn SolidPhase, position: &[DVec3], row: usize) -> bool {
    let ghosts = solid.ghosts();
    let (mut inwards, mut total) = (DVec3::ZERO, 0.0);
    solid.neighbors(row, &mut |j, weight| {
        let x = ghosts.pair(position, row, j);
        inwards += weight * x;
        total += weight * x.length();
    });
    if inwards.length() < SURROUNDED * total {
        return false;
    }
    let outwards = -inwards.normalize_or_zero();
    let mut is_free = true;
    solid.neighbors(row, &mut |j, _| {
        let x = ghosts.pair(position, row, j);
        is_free &= x.dot(outwards) <= CONE * x.length();
    });
    is_free
}

/// Names the failed particles that have been at a surface.
struct Worn {
    bodies: Vec<BodyId>,
}

impl RemovalRule for Worn {
    fn rows(&mut self, step: &Step<'_>, body: BodyId, out: &mut Vec<u32>) -> Result<(), StepError> {
        if !self.bodies.contains(&body) {
            return Ok(());
        }
        let (view, rows) = step.world.body_view(body);
        let exposed = view.read::<Exposed>()?;
        out.extend(rows.filter(|&row| exposed[row].0 == 1).map(|row| row as u32));
        Ok(())
    }

    fn access(&self) -> Vec<Access> {
        vec![Access { column: Exposed::NAME, mode: Mode::Reads }]
    }
}
