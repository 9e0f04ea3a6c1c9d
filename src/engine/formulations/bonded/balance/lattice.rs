//! Bonds of some particles of a body.

use glam::DVec3;

use super::body::HeldBody;
use crate::formulations::bonded::bonds::{BodyBonds, Bonds};
use crate::formulations::bonded::support::choose_support;
use crate::linalg::Sym3;
use crate::neighbors::NeighborSearch;
use crate::symmetry::{Ghosts, Repeat};

/// Of a particle near a surface, the part of the lengths to its neighbours that is left when they are added
/// as vectors, from which on it is beside that. On a flat surface it is a half; among irregular particles a
/// tenth to a fifth.
const BESIDE: f64 = 0.3;

/// A particle by its number in the body, and its place, m.
pub(super) type Placed = (u32, DVec3);

/// Some particles of a body at given places, with their bonds.
pub(super) struct BondLattice {
    position: Vec<DVec3>,
    volume: Vec<f64>,
    bonds: Bonds,
    ghosts: Ghosts,
    /// Numbers of the particles in the body.
    numbers: Vec<u32>,
    /// Row of every particle of the body, if it is one of them.
    rows: Vec<Option<u32>>,
}

/// A bond of particle i and what it adds to b_i, m2 (m in two dimensions).
pub(super) struct BondShare {
    /// Number of the other particle in the body; a ghost has that of its source.
    pub other: u32,
    /// V_i V_j w_ij M_i^-1 X_ij.
    pub own_part: DVec3,
    /// V_i V_j w_ij M_j^-1 X_ij.
    pub other_part: DVec3,
}

impl BondLattice {
    /// That of some particles. None if the bonds cannot be computed.
    pub fn new(body: &HeldBody<'_>, particles: &[Placed], repeats: &[Repeat]) -> Option<Self> {
        let (numbers, position): (Vec<u32>, Vec<DVec3>) = particles.iter().copied().unzip();
        let volume: Vec<f64> = numbers.iter().map(|&k| body.plan.sites[k as usize].volume).collect();
        let mut ghosts = Ghosts::new(numbers.len());
        let rows = 0..numbers.len();
        let ghost_rows = ghosts.add(rows.clone(), &position, body.support, repeats);
        let images = ghost_rows.clone().map(|row| ghosts.place(&position, row));
        let support = supports(body, position.iter().copied().chain(images).collect())?;
        let own = BodyBonds {
            rows,
            position: &position,
            volume: &volume,
            support: &support,
            kernel: body.kernel,
            ghosts: &ghosts,
            ghost_rows,
            hidden: &[],
        };
        let mut bonds = Bonds::default();
        bonds.append(&own, &mut NeighborSearch::default()).ok()?;
        let mut rows = vec![None; body.plan.sites.len()];
        (0..).zip(&numbers).for_each(|(row, k)| rows[*k as usize] = Some(row));
        Some(Self { position, volume, bonds, ghosts, numbers, rows })
    }

    /// Whether a particle or one of its neighbours is near a surface that is not normal to this direction:
    /// its neighbours are then on one side of it.
    pub fn sees_surface(&self, number: u32, normal: DVec3) -> bool {
        let is_beside = |i: usize| {
            let (mut first_moment, mut lengths) = (DVec3::ZERO, 0.0);
            for (j, weight) in self.bonds.row(i) {
                let x_ij = self.ghosts.pair(&self.position, i, j);
                let weight = f64::from(weight) * self.volume[self.ghosts.source(j)];
                first_moment += weight * x_ij;
                lengths += weight * x_ij.length();
            }
            first_moment.reject_from_normalized(normal).length() > BESIDE * lengths
        };
        let beside_one = |i: u32| {
            let mut neighbors = self.bonds.row(i as usize).map(|(j, _)| self.ghosts.source(j));
            is_beside(i as usize) || neighbors.any(is_beside)
        };
        self.rows[number as usize].is_some_and(beside_one)
    }

    /// Contributions of the bonds of a particle to its b.
    pub fn shares(&self, number: u32) -> impl Iterator<Item = BondShare> + '_ {
        self.rows[number as usize].into_iter().flat_map(move |i| {
            let i = i as usize;
            self.bonds.row(i).map(move |(j, weight)| {
                let x_ij = self.ghosts.pair(&self.position, i, j);
                let source = self.ghosts.source(j);
                let weight = self.volume[i] * self.volume[source] * f64::from(weight);
                let signs = self.ghosts.mirror(j).unwrap_or(DVec3::ONE);
                let mul = |m: &Sym3, x: DVec3| m.to_matrix() * x;
                BondShare {
                    other: self.numbers[source],
                    own_part: weight * mul(&self.bonds.inverse_moment[i], x_ij),
                    other_part: weight * signs * mul(&self.bonds.inverse_moment[source], signs * x_ij),
                }
            })
        })
    }
}

/// The support radius of each of some particles, m; none where there are too few of them.
fn supports(body: &HeldBody<'_>, places: Vec<DVec3>) -> Option<Vec<f64>> {
    let mut support = vec![body.support; places.len()];
    if let Some(neighbors) = body.neighbors.map(|n| n as usize) {
        if places.len() < neighbors + 2 {
            return None;
        }
        choose_support(&places, body.support, neighbors, &mut support).ok()?;
    }
    Some(support)
}
