//! When the reference of a body is updated.

use std::ops::Range;

use glam::DVec3;

use super::phase::UpdatedRows;
use super::update::{USUAL_CHANGE, Update};
use crate::formulations::bonded::{BondedRows, Bonds, Ellipsoid, Ellipsoids, PackedParticle};
use crate::linalg::{Sym3, extreme_stretches};
use crate::parallel::{FourLanes, HotLoop, Lanes4, Maximum, Vector, run_hot, sum_over_blocks};
use crate::world::DeformationGradient;

/// Steps between two tests of the lengths of pairs: they change slowly against the stable step.
const INTERVAL: u64 = 4;
/// Distance up to which particles of a regular lattice are beside each other, over the spacing: along its
/// axes and its diagonals.
const BESIDE: f64 = 1.5;
/// Distance from which on a pair is as good as lost, over the support radius.
const LOST: f64 = 0.95;

/// When the reference of one body is updated.
pub(super) struct UpdateRule {
    pub update: Update,
    /// Spacing of the body, m.
    pub spacing: f64,
    /// Half of its support radius, m.
    pub h: f64,
    /// Whether its material never flows and never fails: neighbours then stay neighbours.
    pub is_elastic: bool,
}

impl UpdateRule {
    /// Whether the reference of the body with these rows is to be updated after the pass of the step of that
    /// number.
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

    /// Whether an update would separate particles that were beside each other at the start, although the
    /// material can do no such thing.
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
        let limit = LOST * 2.0 * self.h;
        // An ellipsoid is nowhere thinner than the root of the smallest stretch, which is found to 1e-7.
        let farthest = farthest_beside(rows.clone(), packed, BESIDE * self.spacing);
        let own = &deformation[rows.clone()];
        let is_near = |stretch: f64| farthest * farthest < limit * limit * (1.0 - 1e-5) * stretch;
        if is_near(stretch_bound(own)) || is_near(min_stretch(own)) {
            return false;
        }
        let UpdatedRows { sites, bonds, ghosts, .. } = packed;
        let first_row = rows.start;
        let place = |row: usize| sites[row].reference.xyz() + sites[row].displacement.xyz();
        let following: Vec<Ellipsoid> =
            deformation.iter().map(|f| Ellipsoid::new(Ellipsoid::following(&f.0))).collect();
        let ellipsoids = Ellipsoids(&following);
        let farthest: Maximum = sum_over_blocks(&sites[rows], &|first, own: &[PackedParticle]| {
            let distances = (0..own.len()).flat_map(|k| {
                let i = first_row + first + k;
                let beside = bonds.row(i).filter(move |(j, _)| {
                    let x_ij = ghosts.pair(original, i, *j);
                    sites[*j].is_present() && x_ij.length_squared() < (BESIDE * self.spacing).powi(2)
                });
                beside.map(move |(j, _)| ellipsoids.distance(ghosts, i, j, place(j) - place(i)))
            });
            Maximum::of(distances)
        });
        farthest.0 > limit
    }
}

/// A bound below the smallest stretch of some particles: no square of a stretch is farther from one than F^T
/// F is from I.
fn stretch_bound(deformation: &[DeformationGradient]) -> f64 {
    let change: Maximum = sum_over_blocks(deformation, &|_, rows: &[DeformationGradient]| {
        Maximum::of(rows.iter().map(|f| (Sym3::gram(f.0) - Sym3::IDENTITY).norm()))
    });
    (1.0 - change.0).max(0.0).sqrt()
}

/// The smallest stretch of some particles, at most one.
fn min_stretch(deformation: &[DeformationGradient]) -> f64 {
    let most: Maximum = sum_over_blocks(deformation, &|_, rows: &[DeformationGradient]| {
        Maximum::of(rows.iter().map(|f| 1.0 / extreme_stretches(f.0).smallest))
    });
    1.0 / most.0.max(1.0)
}

/// The largest distance of two particles that were closer than that at the start, m, and are beside each
/// other in the lists.
fn farthest_beside(rows: Range<usize>, packed: &UpdatedRows, beside: f64) -> f64 {
    let (sites, bonds, start) = (packed.original_sites(), packed.bonds(), rows.start);
    let largest: Maximum = sum_over_blocks(&sites[rows], &|first, own: &[PackedParticle]| {
        let first = start + first;
        Maximum(run_hot(LargestDistance {
            sites,
            bonds,
            rows: first..first + own.len(),
            square: beside * beside,
        }))
    });
    largest.0.sqrt()
}

/// Finds the square of the largest present distance of the bonds of some rows that were short at the start,
/// m2.
struct LargestDistance<'a> {
    /// Original places, and displacements since the start.
    sites: &'a [PackedParticle],
    bonds: &'a Bonds,
    rows: Range<usize>,
    /// Square of the length up to which a bond was short, m2.
    square: f64,
}

impl HotLoop for LargestDistance<'_> {
    type Output = f64;

    #[inline(always)]
    fn run<A: FourLanes>(self, a: A) -> f64 {
        let Self { sites, bonds, rows, square } = self;
        let limit = Lanes4::splat(square);
        let mut largest = Lanes4::ZERO;
        for i in rows {
            let own = &sites[i];
            let (x_i, u_i) =
                (Vector::splat(a, own.reference.xyz()), Vector::splat(a, own.displacement.xyz()));
            let own_volume = Lanes4::splat(own.reference.0[3]);
            let row = &bonds.neighbors[bonds.offsets[i] as usize..bonds.offsets[i + 1] as usize];
            // The others have this one in their rows, which ascend.
            let row = &row[row.partition_point(|&j| (j as usize) < i)..];
            for n in (0..row.len()).step_by(4) {
                // Where there are no more, the last one again.
                let last = row.len() - 1;
                let of = [
                    &sites[row[n] as usize],
                    &sites[row[(n + 1).min(last)] as usize],
                    &sites[row[(n + 2).min(last)] as usize],
                    &sites[row[(n + 3).min(last)] as usize],
                ];
                let [x, y, z, volume] =
                    a.transpose([of[0].reference, of[1].reference, of[2].reference, of[3].reference]);
                let then = Vector::new(a, [x, y, z]) - x_i;
                let [x, y, z, _] = a.transpose([
                    of[0].displacement,
                    of[1].displacement,
                    of[2].displacement,
                    of[3].displacement,
                ]);
                let now = then + (Vector::new(a, [x, y, z]) - u_i);
                let short = a.where_below(then.length_squared().lanes(), limit, now.length_squared().lanes());
                let present = a.where_below(Lanes4::ZERO, a.max(volume, own_volume), short);
                largest = a.max(present, largest);
            }
        }
        largest.0[0].max(largest.0[1]).max(largest.0[2]).max(largest.0[3])
    }
}

/// Whether a pair has changed its length by more than `most` since the last update, m. What has been removed
/// stays where it was, whatever the body does, and has no pairs.
fn has_changed(rows: Range<usize>, packed: &UpdatedRows, most: f64) -> bool {
    let UpdatedRows { sites, bonds, ghosts, .. } = packed;
    let ellipsoids = Ellipsoids(&packed.ellipsoids);
    let first_row = rows.start;
    // A length changes by no more than the pair vector does: few pairs need a look at their ellipsoids.
    let shortest =
        packed.ellipsoids[rows.clone()].iter().map(Ellipsoid::axis_bound).fold(f64::INFINITY, f64::min);
    let least = (most * shortest).powi(2);
    let largest: Maximum = sum_over_blocks(&sites[rows], &|first, own: &[PackedParticle]| {
        let present = own.iter().enumerate().filter(|(_, site)| site.is_present());
        let changes = present.flat_map(|(k, site)| {
            let i = first_row + first + k;
            let others = bonds.row(i).filter(|&(j, _)| sites[j].is_present());
            others.filter_map(move |(j, _)| {
                let change = sites[j].displacement.xyz() - site.displacement.xyz();
                if change.length_squared() < least {
                    return None;
                }
                let length = |r_ij| ellipsoids.distance(ghosts, i, j, r_ij);
                let reference = sites[j].reference.xyz() - site.reference.xyz();
                Some((length(reference + change) - length(reference)).abs())
            })
        });
        Maximum::of(changes)
    });
    largest.0 > most
}
