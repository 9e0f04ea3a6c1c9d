//! Bodies that pass through walls because no contact holds them off.

use glam::{DMat3, DVec3};

use crate::formulations::fluid::cloud::smallest_eigenvalue;
use crate::linalg::{Sym3, dyad};
use crate::neighbors::Periodic;
use crate::notation::{place, quantity};
use crate::plugin::{BodyKind, SimBuilder};
use crate::scene::Dimension;
use crate::schedule::{Step, StepError};
use crate::shapes::{Region, images_near};
use crate::world::{BodyId, ParticleId, Position, ReferencePosition, Removed};

/// Depth of the centre of a particle in a wall from which on it is inside, over its spacing.
const DEPTH: f64 = 0.25;
/// Distance of the nearest particle of a wall beyond which a particle is outside of it, over the spacing of
/// the wall; the middle of a cube is 0.87 away.
const NEAREST: f64 = 0.9;
/// Root mean square distance of the particles of a wall from a line or plane, over their spacing, below which
/// they are on it.
const FLAT: f64 = 0.1;

/// Checks for particles of bodies inside of walls.
pub struct PassingWalls {
    pairs: Vec<BodyAndWall>,
    periodic: Periodic,
    /// Pairs that the user has been warned of.
    pub told: Vec<bool>,
}

/// A body and a wall without a contact.
struct BodyAndWall {
    body: BodyId,
    wall: BodyId,
    region: Box<dyn Region>,
    /// Spacings of body and wall, m.
    spacings: [f64; 2],
    is_plane: bool,
}

/// The affine map that fits the motion of a wall best, back to where its shape was at the start; a shift
/// alone where its particles are on a line, or in space in a plane.
struct WallMotion {
    map: DMat3,
    /// Mean positions now and at the start, m.
    now: DVec3,
    start: DVec3,
}

impl WallMotion {
    /// Of particles of this spacing, m, at these places now and at the start; none if there are none.
    fn of(
        places: impl Iterator<Item = (DVec3, DVec3)> + Clone,
        spacing: f64,
        is_plane: bool,
    ) -> Option<Self> {
        let count = places.clone().count() as f64;
        if count == 0.0 {
            return None;
        }
        let sums =
            places.clone().fold([DVec3::ZERO; 2], |sums, (now, start)| [sums[0] + now, sums[1] + start]);
        let [now, start] = sums.map(|sum| sum / count);
        let (mut moment, mut map) = (Sym3::ZERO, DMat3::ZERO);
        for (x, home) in places {
            moment += Sym3::dyad(x - now);
            map += dyad(home - start, x - now);
        }
        let is_flat = smallest_eigenvalue(&moment, is_plane) < count * (FLAT * spacing).powi(2);
        if is_plane {
            // Along z nothing moves.
            (moment.zz, map.z_axis.z) = (1.0, 1.0);
        }
        let map = if is_flat { DMat3::IDENTITY } else { map * moment.inverse().to_matrix() };
        Some(Self { map, now, start })
    }

    fn back(&self, x: DVec3) -> DVec3 {
        self.start + self.map * (x - self.now)
    }
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
                if !touching.has(body.id, wall.id) {
                    let spacings = [body.spacing, wall.spacing];
                    let is_plane = sim.dimension() == Dimension::Two;
                    pairs.push(BodyAndWall { body: body.id, wall: wall.id, region, spacings, is_plane });
                }
            }
        }
        Self { told: vec![false; pairs.len()], pairs, periodic: sim.periodic() }
    }

    /// Checks all pairs. Where parts of a wall move against each other no map fits, so that a particle of the
    /// wall has to be near.
    pub fn look(&mut self, step: &mut Step<'_>) -> Result<(), StepError> {
        // Of the wall of the pair before: walls come one after the other.
        let mut fitted: Option<(BodyId, Option<WallMotion>)> = None;
        for (pair, told) in self.pairs.iter().zip(&mut self.told).filter(|(_, told)| !**told) {
            let (view, rows) = step.world.body_view(pair.wall);
            let (x, reference) = (view.read::<Position>()?, view.read::<ReferencePosition>()?);
            let gone = view.read::<Removed>()?;
            let wall = rows.filter(|row| gone[*row] == Removed::NO).map(|row| (x[row].0, reference[row].0));
            let (_, motion) = match fitted.take().filter(|(wall, _)| *wall == pair.wall) {
                Some(known) => fitted.insert(known),
                None => {
                    let motion = WallMotion::of(wall.clone(), pair.spacings[1], pair.is_plane);
                    fitted.insert((pair.wall, motion))
                }
            };
            let Some(motion) = motion else { continue };
            let (view, rows) = step.world.body_view(pair.body);
            let (position, removed) = (view.read::<Position>()?, view.read::<Removed>()?);
            let [depth, nearest] = [DEPTH * pair.spacings[0], NEAREST * pair.spacings[1]];
            let (bounds, lengths) = (pair.region.bounds(), self.periodic.lengths());
            let is_inside = |row: &usize| {
                let at = position[*row].0;
                let mut images = images_near(&bounds, motion.back(at), lengths, 0.0);
                removed[*row] == Removed::NO
                    && images.any(|place| pair.region.distance(place) < -depth)
                    && wall.clone().any(|(x, _)| self.periodic.minimal_image(x - at).length() < nearest)
            };
            let Some(row) = rows.clone().find(is_inside) else { continue };
            *told = true;
            let name = |body| &step.world.body(body).name;
            step.warnings.push(format!(
                "particle {} of `{1}` is inside of `{2}`, at {3} and {4}, and no contact holds the two apart: add \
                 `contacts: [Contact(between: (\"{1}\", \"{2}\"), law: Penalty())]`",
                view.read::<ParticleId>()?[row].0,
                name(pair.body),
                name(pair.wall),
                place(position[row].0),
                quantity(step.clock.time, "s")
            ));
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// How far places of a wall of so many columns and rows are from where they were, after it has turned by
    /// 1 rad and its motion has been taken back.
    fn left(columns: usize, rows: usize) -> f64 {
        let turn = DMat3::from_rotation_z(1.0);
        let home = (0..columns * rows).map(|k| DVec3::new((k % columns) as f64, (k / columns) as f64, 0.0));
        let places: Vec<(DVec3, DVec3)> = home.map(|home| (turn * home + DVec3::X, home)).collect();
        let motion = WallMotion::of(places.iter().copied(), 1.0, true).expect("particles");
        places.iter().map(|(now, home)| motion.back(*now).distance(*home)).fold(0.0, f64::max)
    }

    #[test]
    fn the_turn_of_a_wall_is_known_however_long_and_thin_it_is_and_that_of_a_single_row_is_not() {
        for (columns, rows) in [(4, 3), (100, 2), (3000, 3)] {
            assert!(left(columns, rows) < 1e-8 * columns as f64, "{columns} {rows}");
        }
        assert!(left(20, 1) > 1.0);
    }
}
