//! Particles that lose their neighbours get a larger support, or carry no stress.
//!
//! The support radius is constant while a body flows; the neighbours change. Where the material is stretched,
//! the next particle along that direction may be farther away than the support radius. The fit of the
//! deformation gradient is then singular, or nearly so, and the frequency of the particle unbounded. Such a
//! particle permanently gets a larger support radius; if that is not enough, it carries no stress.

use hecs::ArchetypeColumn;

use super::phase::UpdatedRows;
use crate::formulations::bonded::{BodyKernel, Ellipsoid};
use crate::linalg::{Eigen, Sym3};
use crate::notation::quantity;
use crate::plugin::Setup;
use crate::schedule::{Step, raise_warning};
use crate::world::{BodyId, Damage, MissingColumn, ReferencePosition, Removed, SupportRadius, World};

/// Smallest eigenvalue of a moment matrix, which is 1 inside of a body, 1/2 at a face and 1/8 in a corner,
/// below which the support grows.
const FEW: f64 = 0.05;
/// Smallest eigenvalue below which a particle carries no stress.
const LOST: f64 = 0.02;
/// Factor by which a support radius grows at a time.
const GROWTH: f64 = 1.2;
/// Largest support radius over the first one.
const MAX_SUPPORT: f64 = 2.0;

/// Widens the support of particles that have lost neighbours; returns whether there are any, so that the
/// lists have to be built again. What can fail may tear.
pub(super) fn widen(
    packed: &UpdatedRows,
    world: &World,
    damage: Option<&[Damage]>,
    support: &mut [SupportRadius],
) -> bool {
    let mut has_grown = false;
    if damage.is_some() {
        return has_grown;
    }
    for kernel in &packed.kernels {
        let Some(first) = kernel.support else { continue };
        let rows = world.body(kernel.body).rows.clone();
        // Particles that no other one sees have no neighbours in any support.
        let hidden = packed.held.hidden_of(kernel.body);
        let is_hidden = |row: &usize| hidden.binary_search(&((row - rows.start) as u32)).is_ok();
        for row in rows.clone().filter(|&row| packed.volume[row] > 0.0) {
            let inverse = &packed.bonds.inverse_moment[row];
            let grown = GROWTH * support[row].0;
            if grown <= MAX_SUPPORT * first
                && (*inverse == Sym3::ZERO || is_below(FEW, inverse, &packed.ellipsoids[row]))
                && !is_hidden(&row)
            {
                support[row].0 = grown;
                has_grown = true;
            }
        }
    }
    has_grown
}

impl UpdatedRows {
    /// Lets go of particles whose fit is nearly singular.
    pub fn release_lost(&mut self) {
        for row in 0..self.bonds.inverse_moment.len() {
            if is_below(LOST, &self.bonds.inverse_moment[row], &self.ellipsoids[row]) {
                self.bonds.release(row);
            }
        }
    }

    /// Number of particles of a body that are there and carry no stress for want of neighbours.
    pub fn released(&self, world: &World, body: BodyId) -> usize {
        self.released_rows(world, body).count()
    }

    fn released_rows(&self, world: &World, body: BodyId) -> impl Iterator<Item = usize> {
        let rows = world.body(body).rows.clone();
        let hidden = self.held.hidden_of(body);
        let is_lost = move |row: &usize| {
            let row = *row;
            let number = || (row - rows.start) as u32;
            rows.contains(&row) && self.volume[row] > 0.0 && hidden.binary_search(&number()).is_err()
        };
        self.bonds.free.iter().map(|row| *row as usize).filter(is_lost)
    }

    /// Says of every body how many of its particles have too few neighbours from the start on.
    pub fn warn_of_released_at_start(&mut self, setup: &mut Setup<'_>) {
        let released = |kernel: &BodyKernel| self.released(setup.world, kernel.body);
        self.released_at_start = self.kernels.iter().map(released).collect();
        for (kernel, free) in self.kernels.iter().zip(&self.released_at_start).filter(|(_, free)| **free > 0)
        {
            let name = &setup.world.body(kernel.body).name;
            let text =
                format!("{free} particles of body `{name}` have too few neighbours and carry no stress");
            setup.warnings.push(text);
        }
    }

    /// Says of every body how many of its particles an update has let go of; the last word counts. What has
    /// failed, and what has lost neighbours by failure or as they left the domain, is expected.
    pub fn warn_of_released(&self, step: &mut Step<'_>) -> Result<(), MissingColumn> {
        for (kernel, at_start) in self.kernels.iter().zip(&self.released_at_start) {
            if self.released(step.world, kernel.body) <= *at_start {
                continue;
            }
            let cracks = CrackPlaces::of_body(step.world, kernel.body)?;
            let is_expected = |row: usize| cracks.has_at(row);
            let now = self.released_rows(step.world, kernel.body).filter(|&row| !is_expected(row)).count();
            if now <= *at_start {
                continue;
            }
            let begin = format!(
                "particles of body `{}` have lost their neighbours and carry no stress:",
                step.world.body(kernel.body).name
            );
            let help = match cracks.can_fail {
                true => "the body has been torn there before its material failed",
                false => {
                    "smaller spacings or a larger `support` keep the body together, the plugin `failure` lets it break"
                }
            };
            let time = step.clock.time;
            raise_warning(step.warnings, &begin, now, || {
                format!("of them at {}; {help}", quantity(time, "s"))
            });
        }
        Ok(())
    }
}

/// The particles of a body that have failed or have been removed.
struct CrackPlaces<'a> {
    places: ArchetypeColumn<'a, ReferencePosition>,
    support: ArchetypeColumn<'a, SupportRadius>,
    lost: Vec<usize>,
    /// Whether the material can fail.
    can_fail: bool,
}

impl<'a> CrackPlaces<'a> {
    /// Of a body that cannot fail, those that have left the domain.
    fn of_body(world: &'a World, body: BodyId) -> Result<Self, MissingColumn> {
        let (view, rows) = world.body_view(body);
        let (damage, removed) = (view.read::<Damage>().ok(), view.read::<Removed>()?);
        let has_failed = |row: usize| damage.as_ref().is_some_and(|damage| damage[row].0 >= 1.0);
        let lost = rows.filter(|&row| has_failed(row) || removed[row] != Removed::NO).collect();
        let can_fail = damage.is_some();
        let (places, support) = (view.read::<ReferencePosition>()?, view.read::<SupportRadius>()?);
        Ok(Self { places, support, lost, can_fail })
    }

    /// Whether a particle is one of them, or had one as its neighbour at the start.
    fn has_at(&self, row: usize) -> bool {
        let (place, reach) = (self.places[row].0, self.support[row].0);
        self.lost.iter().any(|&lost| self.places[lost].0.distance(place) <= reach)
    }
}

/// Whether the moment matrix that has this inverse has an eigenvalue below a limit, as seen in the ellipsoid
/// of the particle.
fn is_below(limit: f64, inverse: &Sym3, ellipsoid: &Ellipsoid) -> bool {
    // The largest eigenvalue of a positive matrix is at most its trace.
    let most = 1.0 / limit;
    ellipsoid.rounded_trace(inverse) > most
        && Eigen::new(&ellipsoid.rounded(inverse)).values.max_element() > most
}
