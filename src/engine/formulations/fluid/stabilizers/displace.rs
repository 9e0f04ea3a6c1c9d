//! Non-advective displacements: shifting and smoothing of fluid particles.

use glam::DVec3;

use crate::parallel::sum_over_blocks;
use crate::schedule::{AccountKind, Step, StepError};
use crate::world::{BodyId, Mass, Position, Removed};

/// Moves the particles of a body; velocities stay, and densities follow where a plugin adds to
/// [`DensityShift`](crate::formulations::fluid::DensityShift). The change of potential energy is supplied by
/// gravity, as in any motion, and booked as dissipated in the account of that name.
///
/// # Errors
/// A column is missing.
pub fn displace(
    step: &mut Step<'_>,
    body: BodyId,
    moves: &[DVec3],
    gravity: DVec3,
    account: &str,
) -> Result<(), StepError> {
    let (view, rows) = step.world.body_view(body);
    let mut position = view.write::<Position>()?;
    let (mass, removed) = (view.read::<Mass>()?, view.read::<Removed>()?);
    let slices = (&mut position[rows.clone()], moves, &mass[rows.clone()], &removed[rows]);
    type Rows<'a> = (&'a mut [Position], &'a [DVec3], &'a [Mass], &'a [Removed]);
    let work = sum_over_blocks(slices, &|_, (x, moves, m, removed): Rows<'_>| {
        let mut work = 0.0;
        for k in (0..x.len()).filter(|&k| removed[k] == Removed::NO) {
            x[k].0 += moves[k];
            work += m[k].0 * gravity.dot(moves[k]);
        }
        work
    });
    let supplied = step.ledger.account("gravity", AccountKind::Supplied);
    step.ledger.add(supplied, body, work);
    let taken = step.ledger.account(account, AccountKind::Dissipated);
    step.ledger.add(taken, body, work);
    Ok(())
}
