//! Solids and rigid bodies that go through a symmetry plane.
//!
//! The half of a problem stands for the whole: what goes through the plane has met its own mirror image
//! there. A body that ends at the plane is held by its image, one that was farther from it has none, and
//! nothing stops it.

use crate::notation::{number, place, quantity};
use crate::plugin::{BodyKind, BodyPlan, SimBuilder};
use crate::rigid::RigidBodies;
use crate::schedule::{Step, StepError};
use crate::symmetry::MirrorPlane;
use crate::world::{BodyId, Mobility, Position, Removed};

/// Distance behind the plane at which a particle has gone through it, over the spacing: the surface of its
/// body is then a whole spacing behind the plane.
const DEPTH: f64 = 0.5;

/// A body on one side of a plane.
struct BodyAtPlane {
    body: BodyId,
    axis: usize,
    /// Coordinate of the plane, m.
    at: f64,
    /// Side on which the body starts: 1 for larger coordinates, else -1.
    side: f64,
    /// Distance behind the plane at which a particle has gone through it, m.
    depth: f64,
    /// Whether the body has a mirror image.
    is_mirrored: bool,
}

/// Checks whether bodies go through symmetry planes.
pub(super) struct CrossedPlanes {
    pairs: Vec<BodyAtPlane>,
    /// Pairs that the user has been warned of.
    pub told: Vec<bool>,
}

impl CrossedPlanes {
    /// All solids and rigid bodies that are wholly on a side of a plane on which bodies end at it.
    pub fn new(sim: &SimBuilder<'_>) -> Self {
        let planes = sim.mirror_planes();
        let pairs: Vec<BodyAtPlane> = planes.iter().flat_map(|plane| beside(plane, sim)).collect();
        Self { told: vec![false; pairs.len()], pairs }
    }

    /// Checks all pairs.
    ///
    /// # Errors
    /// A column is missing.
    pub fn look(&mut self, step: &mut Step<'_>) -> Result<(), StepError> {
        for (pair, told) in self.pairs.iter().zip(&mut self.told).filter(|(_, told)| !**told) {
            let Some(text) = pair.crossing(step)? else { continue };
            *told = true;
            step.warnings.push(text);
        }
        Ok(())
    }
}

impl BodyAtPlane {
    /// What to say if a particle of the body has gone through the plane; those whose motion along the axis is
    /// prescribed go where they are to go.
    fn crossing(&self, step: &Step<'_>) -> Result<Option<String>, StepError> {
        let Self { body, axis, at, side, depth, is_mirrored } = *self;
        let (view, rows) = step.world.body_view(body);
        let (position, removed) = (view.read::<Position>()?, view.read::<Removed>()?);
        // Particles of a rigid body have no mobility of their own.
        let all = step.resources.try_get::<RigidBodies>();
        let rigid = all.as_ref().and_then(|all| all.iter().find(|rigid| rigid.id == body));
        let mobility = view.read::<Mobility>()?;
        let is_driven = |row: usize| match rigid {
            Some(rigid) => rigid.is_driven_along(axis),
            None => mobility[row].0[axis] == 0.0,
        };
        let is_behind = |row: usize| side * (position[row].0[axis] - at) < -depth;
        let Some(row) =
            { rows }.find(|&row| removed[row] == Removed::NO && is_behind(row) && !is_driven(row))
        else {
            return Ok(None);
        };
        let help = if is_mirrored {
            "what has failed or come off there is held by nothing: let `failure` or `remove_fragments` take it out"
        } else {
            "it has met its mirror image there, which nothing stands for, as it did not end at the plane: a rigid \
             `HalfSpace` at the plane, in contact with it without friction, does"
        };
        Ok(Some(format!(
            "`{}` goes through the symmetry plane {} = {} m, at {} and {}: {help}",
            step.world.body(body).name,
            ["X", "Y", "Z"][axis],
            number(at),
            place(position[row].0),
            quantity(step.clock.time, "s")
        )))
    }
}

/// The bodies wholly on a side of a plane on which bodies end at it.
fn beside(plane: &MirrorPlane, sim: &SimBuilder<'_>) -> Vec<BodyAtPlane> {
    let axis = plane.axis;
    // Of the particles: a half-space has a single one.
    let side_of = |body: &BodyPlan| {
        let mut distances = body.sites.iter().map(|site| site.position[axis] - plane.at);
        let first = distances.next()?.signum();
        (body.bounds.is_bounded() && distances.all(|distance| distance * first > 0.0)).then_some(first)
    };
    let cut = sim.bodies().iter().filter(|body| plane.bodies.contains(body.id));
    let sides: Vec<f64> = cut.filter_map(side_of).collect();
    let solid = |body: &&BodyPlan| matches!(body.kind, BodyKind::Solid | BodyKind::Rigid);
    let all = sim.bodies().iter().filter(solid);
    let found = all.filter_map(|body| {
        let side = side_of(body).filter(|side| sides.contains(side))?;
        let is_mirrored = plane.bodies.contains(body.id);
        let depth = DEPTH * body.spacing;
        Some(BodyAtPlane { body: body.id, axis, at: plane.at, side, depth, is_mirrored })
    });
    found.collect()
}
