//! Cracks: bonds between an intact particle and a failed one that is still present. Terms on bonds do not act
//! along them.
//!
//! A [`FoldedTerm`](crate::solids::FoldedTerm) of a particle at the edge of a crack gets the fit over the
//! intact neighbours (the `edges` of the formulation), so that its energy and force are those of a body
//! without the failed particles. The second pass knows one corrected stress per particle, which acts on all
//! its neighbours: the contribution of the terms to bonds across a crack is subtracted, on both sides of the
//! bond.
//!
//! A particle that fails in a step changes sides at the start of the next one, because within a step the
//! blocks of particles run independently.

use std::ops::Range;

use glam::{DMat3, DVec3};

use super::bonds::Bonds;
use super::rows::PackedParticle;
use crate::parallel::{share_picked, sum_over_blocks};
use crate::symmetry::Ghosts;
use crate::world::{Damage, Removed};

/// State of a particle as its neighbours treat it.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(in crate::formulations) enum FailureState {
    /// It is intact.
    #[default]
    Intact,
    /// It has failed in the last step.
    NewlyFailed,
    /// It has failed before.
    Failed,
}

/// An intact particle with failed neighbours.
#[derive(Clone, Copy, Debug)]
pub(in crate::formulations) struct CrackEdge {
    /// Row in the phase.
    pub row: u32,
    /// Whether a neighbour has failed in the last step.
    pub is_new: bool,
    /// Contribution of folded terms to the corrected stress A_i.
    pub stress: DMat3,
    /// Their contribution to the bond stiffness k_i.
    pub stiffness: f64,
}

/// The edges in a block of rows, to be written.
pub(in crate::formulations) struct EdgeRows<'a> {
    pub edges: &'a mut [CrackEdge],
    /// First row of the block in the phase.
    pub first: usize,
}

impl<'a> EdgeRows<'a> {
    /// Those of `edges` in `n` rows from `first` on.
    pub fn of(edges: &'a mut [CrackEdge], first: usize, n: usize) -> Self {
        let all = EdgeRows { edges, first: 0 };
        let (_, rest) = all.split(first);
        rest.split(n).0
    }

    /// Those before row `at` of the block, and those from it on.
    pub fn split(self, at: usize) -> (Self, Self) {
        let Self { edges, first } = self;
        let until = edges.partition_point(|edge| (edge.row as usize) < first + at);
        let (edges, rest) = edges.split_at_mut(until);
        (Self { edges, first }, Self { edges: rest, first: first + at })
    }
}

/// All cracks of the phase.
#[derive(Debug, Default)]
pub(in crate::formulations) struct Cracks {
    /// Of every row; empty before anything fails.
    pub states: Vec<FailureState>,
    /// Ascending by row.
    pub edges: Vec<CrackEdge>,
    /// Rows at either side of a crack, ascending.
    rows: Vec<u32>,
    /// Number of failed rows that the states know of.
    failed: usize,
    has_newly_failed: bool,
}

impl Cracks {
    /// Adds the particles that have failed since the last step. `known` holds the rows that had failed
    /// before, ascending; the others are added to it.
    pub fn update(
        &mut self,
        known: &mut Vec<u32>,
        damage: &[Damage],
        removed: &[Removed],
        bonds: &Bonds,
        ghosts: &Ghosts,
    ) {
        if self.failed != known.len() {
            self.rebuild(known, damage.len(), bonds, ghosts);
        }
        let is_failed = |row: usize| damage[row].0 >= 1.0 && removed[row] == Removed::NO;
        let own = (damage, removed);
        let count = sum_over_blocks(own, &|_, (damage, removed): (&[Damage], &[Removed])| {
            damage.iter().zip(removed).filter(|row| row.0.0 >= 1.0 && *row.1 == Removed::NO).count() as f64
        });
        if count as usize == known.len() {
            return;
        }
        self.states.resize(damage.len(), FailureState::Intact);
        for row in (0..damage.len()).filter(|&row| is_failed(row)) {
            if self.states[row] == FailureState::Intact {
                self.states[row] = FailureState::NewlyFailed;
                self.has_newly_failed = true;
                known.push(row as u32);
            }
        }
        known.sort_unstable();
        self.failed = known.len();
        self.list(known, bonds, ghosts);
    }

    /// Rebuilds the states of the given failed rows of a phase of `len`.
    pub fn rebuild(&mut self, failed: &[u32], len: usize, bonds: &Bonds, ghosts: &Ghosts) {
        self.states.clear();
        self.states.resize(len, FailureState::Intact);
        failed.iter().for_each(|&row| self.states[row as usize] = FailureState::Failed);
        self.has_newly_failed = false;
        self.failed = failed.len();
        self.list(failed, bonds, ghosts);
    }

    fn list(&mut self, failed: &[u32], bonds: &Bonds, ghosts: &Ghosts) {
        let Self { states, edges, rows, .. } = self;
        let neighbors = |row: u32| bonds.row(row as usize).map(|(j, _)| ghosts.source(j));
        rows.clear();
        rows.extend(failed.iter().flat_map(|&row| neighbors(row)).map(|j| j as u32));
        rows.retain(|&row| states[row as usize] == FailureState::Intact);
        rows.sort_unstable();
        rows.dedup();
        edges.clear();
        edges.extend(rows.iter().map(|&row| CrackEdge {
            row,
            is_new: neighbors(row).any(|j| states[j] == FailureState::NewlyFailed),
            stress: DMat3::ZERO,
            stiffness: 0.0,
        }));
        let holds = |j: usize| states[j] == FailureState::Intact;
        rows.extend(failed.iter().filter(|&&row| neighbors(row).any(holds)));
        rows.sort_unstable();
    }

    /// Exchanges the results of the pass at the edges of a body among ranks, each of which computes its own.
    pub fn share_edges(&mut self, body: &Range<usize>) {
        let EdgeRows { edges, .. } = EdgeRows::of(&mut self.edges, body.start, body.len());
        if edges.is_empty() {
            return;
        }
        let rows: Vec<u32> = edges.iter().map(|edge| edge.row).collect();
        let mut stresses: Vec<DMat3> = edges.iter().map(|edge| edge.stress).collect();
        let mut stiffness: Vec<f64> = edges.iter().map(|edge| edge.stiffness).collect();
        share_picked(&mut stresses, &rows, body);
        share_picked(&mut stiffness, &rows, body);
        for ((edge, stress), stiffness) in edges.iter_mut().zip(stresses).zip(stiffness) {
            (edge.stress, edge.stiffness) = (stress, stiffness);
        }
    }

    /// Ages the states after a pass: newly failed particles become failed ones.
    pub fn age_marks(&mut self) {
        if std::mem::take(&mut self.has_newly_failed) {
            self.edges.iter_mut().for_each(|edge| edge.is_new = false);
            self.states
                .iter_mut()
                .filter(|state| **state == FailureState::NewlyFailed)
                .for_each(|state| *state = FailureState::Failed);
        }
    }

    /// Those of `n` rows from `first` on that are at a crack.
    pub fn rows_of_block(&self, first: usize, n: usize) -> &[u32] {
        let until = |row: usize| self.rows.partition_point(|&entry| (entry as usize) < row);
        if self.rows.is_empty() { &[] } else { &self.rows[until(first)..until(first + n)] }
    }

    /// The force, N, of the second pass on a row at a crack that comes from folded terms in the corrected
    /// stresses on either side of its bonds.
    pub fn force_across(
        &self,
        row: usize,
        bonds: &Bonds,
        ghosts: &Ghosts,
        sites: &[PackedParticle],
    ) -> DVec3 {
        let edge_of = |row: usize| {
            let place = self.edges.binary_search_by_key(&row, |edge| edge.row as usize);
            place.ok().map(|k| &self.edges[k])
        };
        let own = edge_of(row);
        let site = &sites[row];
        let mut force = DVec3::ZERO;
        for (j, weight) in bonds.row(row) {
            let source = ghosts.source(j);
            let has_failed = self.states[source] != FailureState::Intact;
            let edge = if has_failed { own } else { edge_of(source).filter(|_| own.is_none()) };
            let Some(edge) = edge else { continue };
            // The terms of an image are those of its source in the mirror: S A S.
            let signs = if has_failed { None } else { ghosts.mirror(j) }.unwrap_or(DVec3::ONE);
            let arm = sites[j].reference.xyz() - site.reference.xyz();
            let change = sites[j].displacement.xyz() - site.displacement.xyz();
            let force_of_bond = signs * (edge.stress * (signs * arm)) + change * edge.stiffness;
            force += force_of_bond * (f64::from(weight) * sites[j].reference.0[3]);
        }
        force * site.reference.0[3]
    }
}
