//! The linear equations for the shares.

use glam::DVec3;

use super::alike::Kinds;
use super::body::HeldBody;
use super::lattice::{BondLattice, BondShare};
use super::lattices::Lattices;
use super::least_squares::SparseRows;
use super::zone::Zone;

/// n . b_i as a function of the changes of the shares, over the area of a particle. Of alike particles there
/// is one unknown and one equation, which count as the root of their number.
pub(super) struct Equations {
    /// The coefficients of the unknown shares.
    pub rows: SparseRows,
    /// Right-hand side with the initial shares.
    pub rest: Vec<f64>,
    /// The unknowns.
    pub unknown: Vec<Unknown>,
    /// Unknown of every kind, if it has one.
    column: Vec<Option<u32>>,
    /// Of every equation, but the last.
    balances: Vec<StressBalance>,
}

/// The share of alike particles.
#[derive(Clone, Copy)]
pub(super) struct Unknown {
    /// Their share at the start.
    pub start: f64,
    /// Their distance from the nearest side, m.
    pub depth: f64,
    /// Root of their number.
    pub weight: f64,
}

/// An equation of alike particles.
struct StressBalance {
    weight: f64,
    /// n . b that is to be, over the area of a particle.
    target: f64,
    /// Whether a stress could be uniform there: no surface is near but the side.
    is_inside: bool,
}

impl Equations {
    /// The equations of a zone, about the shares that all particles of the body have at the start.
    pub fn of(body: &HeldBody<'_>, zone: &Zone, kinds: &Kinds, lattices: &Lattices, start: &[f64]) -> Self {
        let mut own = Self::without_rows(zone, kinds, start);
        let area = body.plan.spacing.powi(body.kernel.dimension() as i32 - 1);
        for &(at, normal) in zone.equations.iter().filter(|(at, _)| kinds.is_typical(*at)) {
            let (k, weight) = (zone.asked[at as usize], kinds.weight(at));
            let mirrored = lattices.mirrored_along(normal);
            let target = mirrored.map_or(0.0, |lattice| target(lattice, start, k).dot(normal) / area);
            let is_inside = mirrored.is_none_or(|lattice| !lattice.sees_surface(k, normal));
            let mut missing = target;
            let mut of_itself = 0.0;
            for share in lattices.now.shares(k) {
                let part = share.other_part.dot(normal) / area;
                of_itself += share.own_part.dot(normal) / area;
                missing -= start[share.other as usize] * part;
                own.add(kinds.of_particle(zone, share.other), weight * part);
            }
            missing -= start[k as usize] * of_itself;
            own.add(kinds.of_particle(zone, k), weight * of_itself);
            own.rows.end();
            own.rest.push(weight * missing);
            own.balances.push(StressBalance { weight, target, is_inside });
        }
        // The volume stays.
        let count: f64 = own.unknown.iter().map(|unknown| unknown.weight * unknown.weight).sum();
        let weights: Vec<f64> = own.unknown.iter().map(|unknown| unknown.weight / count.sqrt()).collect();
        (0..).zip(weights).for_each(|(column, weight)| own.rows.add(column, weight));
        own.rows.end();
        own.rest.push(0.0);
        own
    }

    fn without_rows(zone: &Zone, kinds: &Kinds, start: &[f64]) -> Self {
        let mut column = vec![None; kinds.counts.len()];
        let mut unknown = Vec::new();
        for &(at, depth) in zone.unknown.iter().filter(|(at, _)| kinds.is_typical(*at)) {
            column[kinds.of[at as usize] as usize] = Some(unknown.len() as u32);
            let start = start[zone.asked[at as usize] as usize];
            unknown.push(Unknown { start, depth, weight: kinds.weight(at) });
        }
        Self { rows: SparseRows::default(), rest: Vec::new(), unknown, column, balances: Vec::new() }
    }

    /// Adds a coefficient of the share of a kind to the row that is being assembled.
    fn add(&mut self, kind: Option<u32>, value: f64) {
        if let Some(column) = kind.and_then(|kind| self.column[kind as usize]) {
            self.rows.add(column, value / self.unknown[column as usize].weight);
        }
    }

    /// The change of the share of every particle whose share may change, by its number in the zone, from a
    /// solution.
    pub fn changes<'a>(
        &'a self,
        zone: &'a Zone,
        kinds: &'a Kinds,
        solution: &'a [f64],
    ) -> impl Iterator<Item = (u32, f64)> + 'a {
        zone.unknown.iter().filter_map(|(at, _)| {
            let column = self.column[kinds.of[*at as usize] as usize]? as usize;
            Some((zone.asked[*at as usize], solution[column] / self.unknown[column].weight))
        })
    }

    /// Imbalance of a uniform stress: the root mean square of the forces on the particles, over that on the
    /// area of one.
    pub fn imbalance(&self, solution: &[f64]) -> f64 {
        let is_any_inside = self.balances.iter().any(|balance| balance.is_inside);
        let changes = self.rows.mul(solution);
        let (mut sum, mut count) = (0.0, 0.0);
        for (balance, (rest, change)) in self.balances.iter().zip(self.rest.iter().zip(changes)) {
            let missing = (rest - change) / balance.weight;
            // Beside other surfaces, a uniform stress is balanced by loads on these.
            let is_all = balance.is_inside || !is_any_inside;
            let force = if is_all { balance.target - missing } else { missing };
            sum += (balance.weight * force).powi(2);
            count += balance.weight * balance.weight;
        }
        if count > 0.0 { (sum / count).sqrt() } else { 0.0 }
    }
}

/// b of a particle in a lattice.
fn target(lattice: &BondLattice, start: &[f64], k: u32) -> DVec3 {
    let part = |share: BondShare| {
        start[k as usize] * share.own_part + start[share.other as usize] * share.other_part
    };
    lattice.shares(k).map(part).sum()
}
