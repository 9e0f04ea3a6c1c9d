//! The pairs of one particle, four at a time: what a formulation fills and pair terms read.

use bytemuck::{Pod, Zeroable};
use glam::DVec3;

use super::term::Pair;
use crate::parallel::{Arithmetic, Lanes4, Number, Vector};

/// Four vectors and their lengths.
#[derive(Clone, Copy, Debug, Default, Pod, Zeroable)]
#[repr(C, align(32))]
pub struct FourVectors {
    /// Components, m.
    pub vector: [Lanes4; 3],
    /// Lengths, m; above zero.
    pub length: Lanes4,
}

/// Four neighbours. Lanes without a neighbour, and neighbours beyond the support, have weight, kernel and volume zero and a
/// length above zero.
#[derive(Clone, Copy, Debug, Default, Pod, Zeroable)]
#[repr(C, align(32))]
pub struct FourPairs {
    /// x_ij.
    pub current: FourVectors,
    /// v_ij, m/s.
    pub velocity: [Lanes4; 3],
    /// Pair weights w_ij.
    pub weight: Lanes4,
    /// Kernel values W_ij.
    pub kernel: Lanes4,
    /// Mean support radii, m.
    pub support: Lanes4,
    /// Volumes V_j, m3.
    pub volume_j: Lanes4,
}

/// The neighbours of one particle. Kept from row to row, so that a step does not allocate.
#[derive(Debug, Default)]
pub struct PairRow {
    fours: usize,
    pairs: Vec<FourPairs>,
    rows: Vec<[u32; 4]>,
    /// X_ij; empty where it is x_ij.
    reference: Vec<FourVectors>,
    /// Signs of the axes of mirror images; empty where there are none.
    mirrors: Vec<[DVec3; 4]>,
    /// Volume V_i, m3.
    pub volume_i: f64,
}

/// Room for the neighbours of a row.
pub struct Room<'a> {
    /// Four neighbours each.
    pub pairs: &'a mut [FourPairs],
    /// Rows in the phase.
    pub rows: &'a mut [[u32; 4]],
    /// X_ij, if that was asked for.
    pub reference: &'a mut [FourVectors],
    /// Signs of the axes, if that was asked for.
    pub mirrors: &'a mut [[DVec3; 4]],
}

impl PairRow {
    /// Takes all neighbours out.
    #[inline(always)]
    pub fn clear(&mut self) {
        self.fours = 0;
    }

    /// Makes room for that many neighbours, to be filled by the caller.
    #[inline]
    pub fn room(&mut self, neighbors: usize, with_reference: bool, with_mirrors: bool) -> Room<'_> {
        let fours = neighbors.div_ceil(4);
        self.fours = fours;
        if self.pairs.len() < fours {
            self.pairs.resize(2 * fours, FourPairs::default());
            self.rows.resize(2 * fours, [0; 4]);
        }
        self.reference.resize(if with_reference { self.pairs.len() } else { 0 }, FourVectors::default());
        self.mirrors.resize(if with_mirrors { self.pairs.len() } else { 0 }, [DVec3::ONE; 4]);
        Room {
            pairs: &mut self.pairs[..fours],
            rows: &mut self.rows[..fours],
            reference: self.reference.get_mut(..fours).unwrap_or_default(),
            mirrors: self.mirrors.get_mut(..fours).unwrap_or_default(),
        }
    }

    /// Number of fours.
    #[inline(always)]
    pub(super) fn fours(&self) -> usize {
        self.fours
    }

    /// Whether there are neither reference vectors nor mirror images.
    #[inline(always)]
    pub(super) fn is_plain(&self) -> bool {
        self.reference.is_empty() && self.mirrors.is_empty()
    }

    /// Rows of the neighbours of a four in the phase, and the signs of the axes of mirror images.
    #[inline(always)]
    pub(super) fn rows<const PLAIN: bool>(&self, k: usize) -> ([u32; 4], Option<&[DVec3; 4]>) {
        (self.rows[k], if PLAIN { None } else { self.mirrors.get(k) })
    }

    /// The pairs of a four.
    #[inline(always)]
    pub(super) fn pair<A: Arithmetic, const PLAIN: bool>(&self, a: A, k: usize) -> Pair<A> {
        let FourPairs { current, velocity, weight, kernel, support, volume_j } = &self.pairs[k];
        let reference = if PLAIN { current } else { self.reference.get(k).unwrap_or(current) };
        Pair {
            x_ij: Vector::new(a, current.vector),
            distance: Number::new(a, current.length),
            reference_x_ij: Vector::new(a, reference.vector),
            reference_distance: Number::new(a, reference.length),
            weight: Number::new(a, *weight),
            kernel: Number::new(a, *kernel),
            v_ij: Vector::new(a, *velocity),
            support: Number::new(a, *support),
            volume_i: Number::splat(a, self.volume_i),
            volume_j: Number::new(a, *volume_j),
            is_reference: PLAIN,
        }
    }
}
