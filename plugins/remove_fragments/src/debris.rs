//! Which particles are debris.

use meshless_engine::glam::DVec3;
use meshless_engine::plugin::SimBuilder;
use meshless_engine::removal::RemovalRule;
use meshless_engine::schedule::{Access, Mode, Run, Stage, Step, StepError, System};
use meshless_engine::solids::{PACKED_SOLID, SolidPhase};
use meshless_engine::world::{BodyId, BodySet, Column, DeformationGradient, Removed};

use crate::IsDebris;

/// Adds what marks and removes the debris of some bodies.
pub(crate) fn add(
    sim: &mut SimBuilder<'_>,
    bodies: Vec<BodyId>,
    minimum_volume_ratio: f64,
    particles: usize,
) {
    let set = BodySet::new(bodies.iter().copied());
    sim.add_column_to::<IsDebris>(&set);
    sim.add_removal_rule(Debris { bodies: bodies.clone() });
    let marking =
        Marking { bodies, minimum_volume_ratio, pieces: Fragments { particles, found: Vec::new() } };
    sim.add_system(
        System::new(Stage::PostStep, "debris", marking)
            .on_bodies(set)
            .by_body()
            .reads::<DeformationGradient>()
            .touches(PACKED_SOLID, Mode::ReadsNear)
            .reads::<Removed>()
            .writes::<IsDebris>(),
    );
}

/// Marks debris at the end of a step, with the lists of that step, so that a resumed run finds the same.
struct Marking {
    bodies: Vec<BodyId>,
    minimum_volume_ratio: f64,
    pieces: Fragments,
}

impl Run for Marking {
    fn run(&mut self, step: &mut Step<'_>) -> Result<(), StepError> {
        let Self { bodies, minimum_volume_ratio, pieces } = self;
        for &body in bodies.iter().filter(|&&body| step.part.is_due(step.world, body)) {
            let (view, rows) = step.world.body_view(body);
            let Some(solid) = step.resources.solid(step.world.body(body).phase) else { continue };
            let (deformation, removed) = (view.read::<DeformationGradient>()?, view.read::<Removed>()?);
            let mut debris = view.write::<IsDebris>()?;
            for row in rows {
                let is_debris = removed[row] == Removed::NO
                    && (deformation[row].0.determinant() < *minimum_volume_ratio
                        || solid.has_lost_its_fit(row)
                        || pieces.is_small(&*solid, row));
                debris[row] = IsDebris(u32::from(is_debris));
            }
        }
        Ok(())
    }
}

/// Finds pieces of few particles.
struct Fragments {
    /// Pieces of fewer particles are small.
    particles: usize,
    /// Rows found in the piece of a particle; at most `particles` rows.
    found: Vec<usize>,
}

impl Fragments {
    /// Whether a particle belongs to a piece of fewer particles. A particle with so many neighbours that it
    /// cannot ends the search at once, so that an intact body costs one pass over its rows. A piece that is
    /// connected to its mirror image behind a symmetry plane is one with it.
    fn is_small(&mut self, solid: &dyn SolidPhase, row: usize) -> bool {
        let Self { particles, found } = self;
        found.clear();
        found.push(row);
        let (mut next, mut mirrored) = (0, DVec3::ONE);
        let count = |found: &[usize], mirrored: DVec3| {
            found.len()
                * mirrored.to_array().iter().map(|&sign| if sign < 0.0 { 2 } else { 1 }).product::<usize>()
        };
        while next < found.len() && count(found, mirrored) < *particles {
            solid.neighbors(found[next], &mut |j, _| {
                if found.len() >= *particles {
                    return;
                }
                let source = solid.ghosts().source(j);
                if let Some(signs) = solid.ghosts().mirror(j) {
                    mirrored = mirrored.min(signs);
                }
                if !found.contains(&source) {
                    found.push(source);
                }
            });
            next += 1;
        }
        count(found, mirrored) < *particles
    }
}

/// Names what has been marked.
struct Debris {
    bodies: Vec<BodyId>,
}

impl RemovalRule for Debris {
    fn rows(&mut self, step: &Step<'_>, body: BodyId, out: &mut Vec<u32>) -> Result<(), StepError> {
        if !self.bodies.contains(&body) {
            return Ok(());
        }
        let (view, rows) = step.world.body_view(body);
        let debris = view.read::<IsDebris>()?;
        out.extend(rows.filter(|&row| debris[row].0 == 1).map(|row| row as u32));
        Ok(())
    }

    fn access(&self) -> Vec<Access> {
        vec![Access { column: IsDebris::NAME, mode: Mode::Reads }]
    }
}
