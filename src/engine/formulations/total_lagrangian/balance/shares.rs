//! The shares that balance a uniform stress.

use super::body::HeldBody;
use super::equations::Equations;
use super::lattice::Lattice;
use super::least_squares;
use super::zone::Zone;

/// Weight of the change of a share on the side against the part of b that is left, which is of the order of 1 where nothing is in balance. It grows with the fourth power of the distance from the side over the support radius, as
/// the shares of layers farther in need hardly change.
const DAMPING: f64 = 0.005;
/// How often it is doubled where shares are not within [`SHARES`].
const DOUBLINGS: usize = 5;
/// The least and the greatest share.
const SHARES: (f64, f64) = (0.0, 2.5);

/// The shares of all particles of a body that do not carry all of their stress, by their numbers.
pub(in crate::formulations) fn balanced_shares(body: &HeldBody<'_>) -> Vec<(u32, f64)> {
    let before = &body.plan.carried;
    if !body.stays {
        return before.clone();
    }
    let zone = Zone::of(body);
    if zone.equations.is_empty() {
        return before.clone();
    }
    let places = |k: u32| body.plan.sites[k as usize].position;
    let now = Lattice::new(body, &zone.seen, &places, body.repeats);
    let goes_on = Lattice::new(body, &zone.seen, &|k| zone.place_before[k as usize], &zone.repeats);
    let (Some(now), Some(goes_on)) = (now, goes_on) else { return before.clone() };
    let mut shares = vec![1.0; body.plan.sites.len()];
    before.iter().for_each(|(k, share)| shares[*k as usize] = *share);
    let start = shares.clone();
    let equations = Equations::of(body, &zone, (&now, &goes_on), &start);
    let mut damping: Vec<f64> =
        zone.unknown.iter().map(|(_, depth)| DAMPING * (1.0 + (depth / body.support).powi(4))).collect();
    for _ in 0..=DOUBLINGS {
        let change = least_squares::solve(&equations.rows, &equations.rest, &damping);
        for ((k, _), change) in zone.unknown.iter().zip(change) {
            shares[*k as usize] = start[*k as usize] + change;
        }
        if zone.unknown.iter().all(|(k, _)| (SHARES.0..=SHARES.1).contains(&shares[*k as usize])) {
            break;
        }
        damping.iter_mut().for_each(|damping| *damping *= 2.0);
    }
    zone.unknown
        .iter()
        .map(|(k, _)| *k as usize)
        .for_each(|k| shares[k] = shares[k].clamp(SHARES.0, SHARES.1));
    (0..).zip(shares).filter(|(_, share)| *share != 1.0).collect()
}
