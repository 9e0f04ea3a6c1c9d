//! The positions that become the reference: close to the particles, but free of zero-energy motions.
//!
//! If the particle positions themselves were the reference, zero-energy motions would enter its pair vectors,
//! and the next increments of the deformation gradient would contain part of them. The operator changes with
//! every update: F takes up such a motion as it grows, and does not release it as it decays. F would drift
//! away from the deformation of the material, faster with more frequent updates, and a vibrating body would
//! permanently keep a part of its energy as strain that no motion releases.
//!
//! The reference is therefore relaxed from the positions towards pair vectors that follow from F and the
//! original ones alone,
//!
//! `x_r,i <- x_r,i + theta sum_j V_j w_ij [r_ij - (F_i + F_j) X_ij / 2] / sum_j V_j w_ij`,
//!
//! a few times. The sum is computed once, with the positions of the particles; later iterations sum only the
//! displacements of the relaxation, x_r,j - x_j. The bracket vanishes for affine motions and is of third
//! order for smooth ones; for zero-energy motions it is the part that the gradient does not see. It is
//! measured from the original configuration and not from the last update, so that the remainder of one update
//! is removed by the next. The particles are not at the relaxed positions and f is not I there; F_r = f^-1 F,
//! so that an update does not change F.

use std::ops::Range;

use glam::{DMat3, DVec3};

use super::columns::UpdatedReference;
use super::phase::UpdatedRows;
use crate::formulations::bonded::{Bonds, SumOverBonds};
use crate::parallel::{FourLanes, Lanes4, PlaneOrSpace, for_each_block, run_hot_in};
use crate::world::{Damage, DeformationGradient};

/// theta: it takes nine tenths of a saw-tooth along one axis of a square lattice at once, and all of a
/// checkerboard.
const SHARE: f64 = 0.75;
/// How many times: two rubber rings that collide with updates every three steps rebound 1.5 % too slowly
/// after one time, as without updates after three.
const TIMES: usize = 3;
/// Largest distance of a reference place from its particle, over the smoothing length.
const FARTHEST: f64 = 0.25;

/// Input of the smoothing of the reference positions of a body.
#[derive(Clone, Copy)]
pub(super) struct ReferenceSmoothing<'a> {
    pub packed: &'a UpdatedRows,
    /// Original positions, m.
    pub original: &'a [DVec3],
    pub deformation: &'a [DeformationGradient],
    pub damage: Option<&'a [Damage]>,
    /// Smoothing length, m.
    pub h: f64,
    /// Plane strain.
    pub plane: bool,
}

/// Memory of the relaxation, of real rows and ghosts.
#[derive(Default)]
pub(super) struct ReferenceRelaxation {
    held: Vec<Expected>,
    own_sums: Vec<DisplacementSum>,
    /// Displacement of a reference position from its particle, m, with the volume of intact particles.
    moved: Vec<Lanes4>,
    next: Vec<Lanes4>,
}

/// Record of a particle for its neighbours: the gradient of the expected pair vectors.
#[derive(Clone, Copy, Default)]
#[repr(C, align(64))]
struct Expected {
    /// Columns of -F / 2, with the components of X in the last lanes.
    columns: [Lanes4; 3],
    /// x - F X / 2, with the volume V of what holds, zero of all else.
    place: Lanes4,
}

impl Expected {
    /// That of a place, m, whose original one was X, m.
    fn new(place: DVec3, original: DVec3, deformation: &DMat3, volume: f64) -> Self {
        let half = *deformation * -0.5;
        let column = |column: DVec3, x: f64| Lanes4::new(column, x);
        Self {
            columns: [
                column(half.x_axis, original.x),
                column(half.y_axis, original.y),
                column(half.z_axis, original.z),
            ],
            place: Lanes4::new(place + half * original, volume),
        }
    }
}

/// Sums for the displacement of a reference position.
#[derive(Clone, Copy, Default)]
struct DisplacementSum {
    /// `sum_j V_j w_ij [x_ij - (F_i + F_j) X_ij / 2]`, with `sum_j V_j w_ij` in the last lane.
    sum: Lanes4,
    /// theta over `sum_j V_j w_ij`; zero where nothing moves.
    factor: f64,
}

impl ReferenceRelaxation {
    /// Moves the reference positions of the rows of a body from those of its particles to the relaxed ones.
    /// Failed particles stay, and move no others.
    pub fn smooth(
        &mut self,
        by: &ReferenceSmoothing<'_>,
        rows: Range<usize>,
        places: &mut [UpdatedReference],
    ) {
        self.expect(by, &rows, places);
        let Self { held, own_sums, moved, next } = self;
        let (bonds, ghosts, start) = (&by.packed.bonds, &by.packed.ghosts, rows.start);
        for_each_block(
            &mut own_sums[rows.clone()],
            &mut Vec::new(),
            &|first, own_sums: &mut [DisplacementSum]| {
                run_hot_in(by.plane, DisplacementSums { bonds, held, first: start + first, own_sums });
            },
        );
        let farthest = FARTHEST * by.h;
        for time in 0..TIMES {
            for_each_block(&mut next[rows.clone()], &mut Vec::new(), &|first, next: &mut [Lanes4]| {
                let first = start + first;
                run_hot_in(
                    by.plane,
                    Moves { bonds, own_sums, moved, first, farthest, next, is_first: time == 0 },
                );
            });
            ghosts.fill(next, |ghost, own| Lanes4::new(ghost.map.vector(own.xyz()), own.0[3]));
            std::mem::swap(moved, next);
        }
        let moved = &*moved;
        for_each_block(&mut places[rows], &mut Vec::new(), &|first, places: &mut [UpdatedReference]| {
            places.iter_mut().zip(&moved[start + first..]).for_each(|(place, moved)| place.0 += moved.xyz());
        });
    }

    /// Fills what neighbours see of the rows of a body and its ghosts, from places near the middle of the
    /// body.
    fn expect(&mut self, by: &ReferenceSmoothing<'_>, rows: &Range<usize>, places: &[UpdatedReference]) {
        let ReferenceSmoothing { packed, original, deformation, damage, .. } = *by;
        let UpdatedRows { ghosts, volume, sites, .. } = packed;
        let middle = rows.start + rows.len() / 2;
        let (x_0, original_0, start) = (places[middle].0, original[middle], rows.start);
        let held_volume = |row: usize| {
            let holds = damage.is_none_or(|damage| damage[row].0 < 1.0);
            if holds { volume[row] } else { 0.0 }
        };
        let Self { held, own_sums, moved, next } = self;
        held.resize(sites.len(), Expected::default());
        own_sums.resize(volume.len(), DisplacementSum::default());
        moved.resize(sites.len(), Lanes4::ZERO);
        next.resize(sites.len(), Lanes4::ZERO);
        let own = (&mut held[rows.clone()], &mut next[rows.clone()]);
        type Rows<'a> = (&'a mut [Expected], &'a mut [Lanes4]);
        for_each_block(own, &mut Vec::new(), &|first, (held, next): Rows<'_>| {
            for (k, (held, next)) in held.iter_mut().zip(next).enumerate() {
                let row = start + first + k;
                let (x, then, v) = (places[row].0 - x_0, original[row] - original_0, held_volume(row));
                *held = Expected::new(x, then, &deformation[row].0, v);
                *next = Lanes4::new(DVec3::ZERO, v);
            }
        });
        moved[rows.clone()].copy_from_slice(&next[rows.clone()]);
        ghosts.fill(held, |ghost, _| {
            let (row, map) = (ghost.source, ghost.map);
            if !rows.contains(&row) {
                return Expected::default();
            }
            let (x, then) = (map.place(places[row].0) - x_0, map.place(original[row]) - original_0);
            Expected::new(x, then, &map.tensor(deformation[row].0), held_volume(row))
        });
    }
}

/// Sums what moves the places of a block.
struct DisplacementSums<'a> {
    bonds: &'a Bonds,
    held: &'a [Expected],
    /// First row of the block in the phase.
    first: usize,
    own_sums: &'a mut [DisplacementSum],
}

impl PlaneOrSpace for DisplacementSums<'_> {
    #[inline(always)]
    fn run<A: FourLanes, const D: usize>(self, a: A) {
        let Self { bonds, held, first, own_sums } = self;
        for (k, own_sum) in own_sums.iter_mut().enumerate() {
            let i = first + k;
            let own = &held[i];
            *own_sum = DisplacementSum::default();
            if own.place.0[3] == 0.0 {
                continue;
            }
            let sums = ExpectedSum::<D>::over(a, bonds, held, i);
            let total = sums.total;
            if total > 0.0 {
                let sum = own.displacement_sum(a, &sums);
                *own_sum = DisplacementSum { sum: Lanes4::new(sum, total), factor: SHARE / total };
            }
        }
    }
}

/// Sums over the neighbours of a particle, weighted with V_j w_ij.
struct ExpectedSum<const D: usize> {
    columns: [Lanes4; D],
    place: Lanes4,
    /// `sum_j V_j w_ij`.
    total: f64,
}

impl<const D: usize> SumOverBonds for ExpectedSum<D> {
    type Record = Expected;
    const ZERO: Self = Self { columns: [Lanes4::ZERO; D], place: Lanes4::ZERO, total: 0.0 };

    #[inline(always)]
    fn add<A: FourLanes>(&mut self, a: A, other: &Expected, weight: f32) {
        let weight = f64::from(weight) * other.place.0[3];
        for axis in 0..D {
            self.columns[axis] = a.scale_add(weight, other.columns[axis], self.columns[axis]);
        }
        self.place = a.scale_add(weight, other.place, self.place);
        self.total += weight;
    }

    #[inline(always)]
    fn combined<A: FourLanes>(mut self, a: A, other: &Self) -> Self {
        for axis in 0..D {
            self.columns[axis] = a.add(self.columns[axis], other.columns[axis]);
        }
        self.place = a.add(self.place, other.place);
        self.total += other.total;
        self
    }
}

impl Expected {
    /// The sum over the bonds of a particle, from sums over its neighbours.
    #[inline(always)]
    fn displacement_sum<A: FourLanes, const D: usize>(
        &self,
        a: A,
        ExpectedSum { columns, place, total }: &ExpectedSum<D>,
    ) -> DVec3 {
        // -F_i / 2 acts on X_j - X_i, of which `place` has X_i already.
        let mut sum = a.scale_add(-total, self.place, *place);
        for axis in 0..D {
            let then = self.columns[axis].0[3];
            sum = a.scale_add(-then, columns[axis], sum);
            sum = a.scale_add(columns[axis].0[3], self.columns[axis], sum);
        }
        sum.xyz()
    }
}

/// Moves the places of a block once.
struct Moves<'a> {
    bonds: &'a Bonds,
    own_sums: &'a [DisplacementSum],
    moved: &'a [Lanes4],
    /// First row of the block in the phase.
    first: usize,
    farthest: f64,
    next: &'a mut [Lanes4],
    /// Whether nothing has moved yet.
    is_first: bool,
}

impl PlaneOrSpace for Moves<'_> {
    #[inline(always)]
    fn run<A: FourLanes, const D: usize>(self, a: A) {
        let Self { bonds, own_sums, moved, first, farthest, next, is_first } = self;
        for (k, next) in next.iter_mut().enumerate() {
            let i = first + k;
            let (own, DisplacementSum { sum, factor }) = (moved[i], own_sums[i]);
            let mut change = sum;
            if !is_first && factor > 0.0 {
                change = a.scale_add(-sum.0[3], own, change);
                let row = bonds.offsets[i] as usize..bonds.offsets[i + 1] as usize;
                let (fours, neighbors) = bonds.neighbors[row.clone()].as_chunks::<4>();
                let (four_weights, weights) = bonds.weights[row].as_chunks::<4>();
                // Four sums, which need not wait for each other.
                let mut sums = [change, Lanes4::ZERO, Lanes4::ZERO, Lanes4::ZERO];
                for n in 0..fours.len() {
                    for k in 0..4 {
                        let other = moved[fours[n][k] as usize];
                        sums[k] = a.scale_add(f64::from(four_weights[n][k]) * other.0[3], other, sums[k]);
                    }
                }
                for n in 0..neighbors.len() {
                    let other = moved[neighbors[n] as usize];
                    sums[n] = a.scale_add(f64::from(weights[n]) * other.0[3], other, sums[n]);
                }
                change = a.add(a.add(sums[0], sums[1]), a.add(sums[2], sums[3]));
            }
            let to = a.scale_add(factor, change, own);
            let square = to.0[0] * to.0[0] + to.0[1] * to.0[1] + to.0[2] * to.0[2];
            let share = if square > farthest * farthest { farthest / square.sqrt() } else { 1.0 };
            let to = a.scale(share, to);
            *next = Lanes4([to.0[0], to.0[1], to.0[2], own.0[3]]);
        }
    }
}
