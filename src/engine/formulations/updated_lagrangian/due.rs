//! When the reference of a body is updated.

use std::ops::Range;

use glam::{DMat3, DVec3};

use super::parameters::{USUAL_CHANGE, Update};
use super::phase::UpdatedRows;
use crate::formulations::total_lagrangian::{Ellipsoid, Ellipsoids, Site};
use crate::parallel::{Largest, sum_over_blocks};
use crate::world::DeformationGradient;

/// Steps between two looks at the lengths of pairs: they change slowly against the stable step.
const INTERVAL: u64 = 4;
/// Distance up to which particles of a regular lattice are beside each other, over the spacing: along its axes and its diagonals.
const BESIDE: f64 = 1.5;
/// Distance from which on a pair is as good as lost, over the support radius.
const LOST: f64 = 0.95;

/// When the reference of one body is updated.
pub(super) struct Rule {
    pub update: Update,
    /// Spacing of the body, m.
    pub spacing: f64,
    /// Half of its support radius, m.
    pub h: f64,
    /// Whether its material never flows and never fails: neighbours then stay neighbours.
    pub is_elastic: bool,
}

impl Rule {
    /// Whether the reference of the body with these rows is to be updated after the pass of the step of that number.
    pub fn is_due(&self, rows: Range<usize>, number: u64, packed: &UpdatedRows) -> bool {
        let has_changed =
            |change: f64| number.is_multiple_of(INTERVAL) && has_changed(rows, packed, change * self.h);
        match self.update {
            Update::Never => false,
            Update::Every(steps) => number > 0 && number.is_multiple_of(steps),
            Update::Adaptive { change } => has_changed(change),
            Update::Automatic => !self.is_elastic && has_changed(USUAL_CHANGE),
        }
    }

    /// Whether an update would separate particles that were beside each other at the start, although the material can do no such thing.
    pub fn would_separate(
        &self,
        rows: Range<usize>,
        original: &[DVec3],
        deformation: &[DeformationGradient],
        packed: &UpdatedRows,
    ) -> bool {
        if !self.is_elastic {
            return false;
        }
        let UpdatedRows { sites, bonds, ghosts, .. } = packed;
        let (limit, first_row) = (LOST * 2.0 * self.h, rows.start);
        let place = |row: usize| sites[row].reference.xyz() + sites[row].displacement.xyz();
        let farthest = |distance: &(dyn Fn(usize, usize, DVec3) -> f64 + Sync)| {
            let farthest: Largest = sum_over_blocks(&sites[rows.clone()], &|first, own: &[Site]| {
                let distances = (0..own.len()).flat_map(|k| {
                    let i = first_row + first + k;
                    let beside = bonds.row(i).filter(move |(j, _)| {
                        let x_ij = ghosts.pair(original, i, *j);
                        sites[*j].is_present() && x_ij.length_squared() < (BESIDE * self.spacing).powi(2)
                    });
                    beside.map(move |(j, _)| distance(i, j, place(j) - place(i)))
                });
                Largest::of(distances)
            });
            farthest.0
        };
        // An ellipsoid is nowhere thinner than the root of the smallest stretch, which is more than one over the norm of F^-1.
        let thin: Vec<f64> = deformation.iter().map(|f| norm(&f.0.inverse()).max(1.0)).collect();
        let bound = |i: usize, j: usize, r_ij: DVec3| {
            (0.5 * (thin[i] + thin[ghosts.source(j)]) * r_ij.length_squared()).sqrt()
        };
        if farthest(&bound) < limit {
            return false;
        }
        let following: Vec<Ellipsoid> =
            deformation.iter().map(|f| Ellipsoid::new(Ellipsoid::following(&f.0))).collect();
        let ellipsoids = Ellipsoids(&following);
        farthest(&|i, j, r_ij| ellipsoids.distance(ghosts, i, j, r_ij)) > limit
    }
}

/// The root of the sum of the squares of the components.
fn norm(a: &DMat3) -> f64 {
    (a.x_axis.length_squared() + a.y_axis.length_squared() + a.z_axis.length_squared()).sqrt()
}

/// Whether a pair has changed its length by more than `most` since the last update, m.
fn has_changed(rows: Range<usize>, packed: &UpdatedRows, most: f64) -> bool {
    let UpdatedRows { sites, bonds, ghosts, .. } = packed;
    let ellipsoids = Ellipsoids(&packed.ellipsoids);
    let first_row = rows.start;
    // A length changes by no more than the pair vector does: few pairs need a look at their ellipsoids.
    let shortest =
        packed.ellipsoids[rows.clone()].iter().map(|own| own.shortest).fold(f64::INFINITY, f64::min);
    let least = (most * shortest).powi(2);
    let largest: Largest = sum_over_blocks(&sites[rows], &|first, own: &[Site]| {
        let changes = own.iter().enumerate().flat_map(|(k, site)| {
            let i = first_row + first + k;
            bonds.row(i).filter_map(move |(j, _)| {
                let change = sites[j].displacement.xyz() - site.displacement.xyz();
                if change.length_squared() < least {
                    return None;
                }
                let length = |r_ij| ellipsoids.distance(ghosts, i, j, r_ij);
                let reference = sites[j].reference.xyz() - site.reference.xyz();
                Some((length(reference + change) - length(reference)).abs())
            })
        });
        Largest::of(changes)
    });
    largest.0 > most
}
