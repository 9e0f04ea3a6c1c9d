//! The shares that balance a uniform stress.

use super::alike::{Kinds, ZoneParticles};
use super::body::HeldBody;
use super::equations::{Equations, Unknown};
use super::lattices::Lattices;
use super::least_squares::LeastSquares;
use super::zone::Zone;

/// Weight of the change of a share on the side against the part of b that is left, which is of the order of 1
/// where nothing is in balance. It grows with the fourth power of the distance from the side over the support
/// radius, as the shares of layers farther in need hardly change.
const DAMPING: f64 = 0.005;
/// The minimum and the maximum share: every particle resists.
const SHARES: (f64, f64) = (0.1, 2.5);

/// The balance of a uniform stress beside the sides of a body.
pub(in crate::formulations) struct Balanced {
    /// The shares of all particles that do not carry all of their stress, by their numbers.
    pub shares: Vec<(u32, f64)>,
    /// Imbalance of a uniform stress beside them: the root mean square of the forces on the particles, over
    /// that on the area of one.
    pub imbalance: f64,
}

/// The shares of the particles of a body.
pub(in crate::formulations) fn balanced_shares(body: &HeldBody<'_>) -> Balanced {
    let before = &body.plan.carried;
    find(body).unwrap_or_else(|| Balanced { shares: before.clone(), imbalance: 0.0 })
}

/// None where there is nothing to find, or where neighbours cannot be.
fn find(body: &HeldBody<'_>) -> Option<Balanced> {
    body.plan.sides.first()?;
    let before = &body.plan.carried;
    let mut shares = vec![1.0; body.plan.sites.len()];
    before.iter().for_each(|(k, share)| shares[*k as usize] = *share);
    let zone = Zone::of(body, &shares);
    let lists = ZoneParticles::of(body, &zone)?;
    let kinds = Kinds::of(&zone, &lists);
    let lattices = Lattices::of(body, &zone, &kinds)?;
    let equations = Equations::of(body, &zone, &kinds, &lattices, &shares);
    if !body.stays {
        let imbalance = equations.imbalance(&vec![0.0; equations.unknown.len()]);
        return Some(Balanced { shares: before.clone(), imbalance });
    }
    let damping = |own: &Unknown| DAMPING * (1.0 + (own.depth / body.support).powi(4));
    let bounds = |own: &Unknown| (own.weight * (SHARES.0 - own.start), own.weight * (SHARES.1 - own.start));
    let unknown = &equations.unknown;
    let problem = LeastSquares {
        a: &equations.rows,
        b: &equations.rest,
        damping: &unknown.iter().map(damping).collect::<Vec<_>>(),
        bounds: &unknown.iter().map(bounds).collect::<Vec<_>>(),
    };
    let solution = problem.solve();
    for (k, change) in equations.changes(&zone, &kinds, &solution) {
        shares[k as usize] += change;
    }
    let imbalance = equations.imbalance(&solution);
    Some(Balanced { shares: (0..).zip(shares).filter(|(_, share)| *share != 1.0).collect(), imbalance })
}
