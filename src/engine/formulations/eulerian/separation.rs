//! Bodies that come apart because their kernels do not reach far enough.
//!
//! Particles drawn apart by more than the support no longer see each other. In tension a body then breaks,
//! at a stretch that depends on the support and on no strength of the material. Its particles show it: those
//! that were inside of it have an open side.

use super::lists::EulerianBody;
use super::rows::EulerianRows;
use super::supports::length_in;
use crate::notation::quantity;
use crate::parallel::sum_over_own_blocks;
use crate::schedule::{Step, raise_warning};
use crate::world::{Damage, PhaseId};

/// Offset of the weighted mean of the neighbours of a particle inside of a body, over the support radius, at
/// most; it is 0 there, and 0.2 half a spacing below a flat surface, at the default support.
const INSIDE: f64 = 0.1;
/// The same, at least, of a particle at an open side.
const OPEN: f64 = 0.15;
/// Least number of particles laid open that is worth a warning: a single one may stray.
const FEW: f64 = 3.0;
/// The same over the particles in a section of the body: where a curved side of steps of the lattice is
/// upset, a ring of particles below the steps comes to lie in the side. A body that comes apart opens two
/// sections.
const OF_SECTION: f64 = 0.1;
/// Cosine of the angle about the direction away from the neighbours within which an open side has none.
const CONE: f64 = 0.766;
/// Steps between two looks.
const EVERY: u64 = 16;

/// Of all rows, as they are in the reference configuration, whether they are inside of their body.
pub(super) fn inside(packed: &EulerianRows) -> Vec<bool> {
    let mut inside = vec![false; packed.near.around.len()];
    for body in &packed.lists.bodies {
        for row in body.rows.clone() {
            inside[row] = offset(packed, body, row) < INSIDE && !is_one_sided(packed, row);
        }
    }
    inside
}

/// Offset of the weighted mean of the neighbours of a row over the support radius.
fn offset(packed: &EulerianRows, body: &EulerianBody, row: usize) -> f64 {
    let around = &packed.near.around[row];
    length_in(packed.supports.ellipsoid(body, row), around.first_moment) / (body.support * around.weight_sum)
}

/// Whether a row has no neighbour within a cone about the direction away from their mean.
fn is_one_sided(packed: &EulerianRows, row: usize) -> bool {
    let Some(inward) = packed.near.around[row].first_moment.try_normalize() else { return false };
    let place = |row: usize| packed.points[row].place.xyz();
    let (neighbors, _) = packed.near.row(packed.lists.pairs.offsets()[row], row);
    neighbors.iter().all(|&j| {
        let x_ij = place(j as usize) - place(row);
        -x_ij.dot(inward) < CONE * x_ij.length()
    })
}

/// The neighbours of rows that are removed are inside of their body no longer: these do not lay them open as
/// particles that are drawn apart do.
pub(super) fn open_beside(packed: &mut EulerianRows, removed: impl Iterator<Item = usize>) {
    let EulerianRows { lists, inside, .. } = packed;
    for row in removed {
        for &j in lists.pairs.row(row) {
            inside[lists.ghosts.source(j as usize)] = false;
        }
    }
}

/// Says of every body that cannot fail how many of its particles have been laid open; the largest number
/// counts.
pub(super) fn warn(phase: PhaseId, packed: &EulerianRows, step: &mut Step<'_>) {
    if !step.clock.step.is_multiple_of(EVERY) || step.world.phase(phase).has::<Damage>() {
        return;
    }
    for body in &packed.lists.bodies {
        let Some(open) = laid_open(packed, body) else { continue };
        let begin = format!("Eulerian body `{}` has come apart:", step.world.body(body.id).name);
        let time = step.clock.time;
        raise_warning(step.warnings, &begin, open, || {
            format!(
                "of its inner particles lay open at {}; particles drawn apart by more than the support do not hold together, \
                 whatever the strength of the material: the plugin `failure` lets it break where the material does, and `TotalLagrangian` and \
                 `UpdatedLagrangian` bodies can be drawn farther",
                quantity(time, "s")
            )
        });
    }
}

/// Number of inner particles of a body that have an open side, over all ranks, if it is worth a warning.
fn laid_open(packed: &EulerianRows, body: &EulerianBody) -> Option<usize> {
    // What has been removed has no neighbours.
    let is_there = |row: usize| packed.points[row].place.0[3] > 0.0;
    let is_open = |row: usize| offset(packed, body, row) > OPEN && is_one_sided(packed, row);
    let inside = &packed.inside[body.rows.clone()];
    let count = sum_over_own_blocks(inside, &|first, inside: &[bool]| {
        let rows = body.rows.start + first..;
        rows.zip(inside).filter(|&(row, inside)| *inside && is_there(row) && is_open(row)).count() as f64
    });
    let inner: f64 =
        sum_over_own_blocks(inside, &|_, inside: &[bool]| inside.iter().filter(|is| **is).count() as f64);
    let section = if packed.plane { inner.sqrt() } else { inner.cbrt().powi(2) };
    (count >= FEW.max(OF_SECTION * section)).then_some(count as usize)
}
