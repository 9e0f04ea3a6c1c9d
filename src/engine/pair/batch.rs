//! The pairs of some particles, row after row, four at a time: what a formulation fills and pair terms read.

use bytemuck::{Pod, Zeroable};
use glam::DVec3;

use super::term::Pair;
use super::weight_at::WeightAt;
use crate::parallel::{FourLanes, Lanes4, Number, Vector};

/// Fours from which on a batch is full: it then still fits the first-level cache.
const FULL: usize = 40;
/// Maximum number of rows of a batch.
pub(super) const MAX_ROWS: usize = 16;

/// Four vectors, and their lengths or the squares of these.
#[derive(Clone, Copy, Debug, Default, Pod, Zeroable)]
#[repr(C, align(32))]
pub struct FourVectors {
    /// Components, m.
    pub vector: [Lanes4; 3],
    /// Lengths, m, or their squares, m2, where pairs have reference vectors ([`Extras::reference`]); above
    /// zero.
    pub length: Lanes4,
}

impl FourVectors {
    /// Vectors with the squares of their lengths, above zero.
    #[inline(always)]
    pub(crate) fn squared<A: FourLanes>(a: A, vector: Vector<A>) -> Self {
        let square = vector.length_squared().lanes();
        Self { vector: components(vector), length: a.max(square, Lanes4::splat(f64::MIN_POSITIVE)) }
    }
}

/// The components of four vectors.
#[inline(always)]
pub(crate) fn components<A: FourLanes>(vector: Vector<A>) -> [Lanes4; 3] {
    [vector.x.lanes(), vector.y.lanes(), vector.z.lanes()]
}

/// Four neighbours. Lanes without a neighbour, and neighbours beyond the support, have weight, kernel and
/// volume zero and a length above zero.
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
    /// Volumes V_j, m3.
    pub volume_j: Lanes4,
    /// A number that the formulation keeps from one of its loops over the row to the next; terms do not see
    /// it.
    pub kept: Lanes4,
}

/// Data of the pairs of a body beside x_ij and the data of all pairs.
#[derive(Clone, Copy, Debug, Default)]
pub struct Extras {
    /// Reference vectors. The squares of the lengths are then all that is known of these: a term takes the
    /// roots that it needs.
    pub reference: bool,
    /// Where weights were taken, if there are reference vectors; without them it is at |x_ij|.
    pub weight_at: WeightAt,
    /// Neighbours that are mirror images.
    pub mirrors: bool,
    /// Supports that differ from pair to pair.
    pub supports: bool,
}

/// The neighbours of some particles whose rows follow each other. Kept from batch to batch, so that a step
/// does not allocate.
#[derive(Debug, Default)]
pub struct PairBatch {
    count: usize,
    /// Start of each row, in fours, and the end of the last.
    starts: [usize; MAX_ROWS + 1],
    /// Volume V_i of each row, m3.
    volumes: [f64; MAX_ROWS],
    extras: Extras,
    /// Support radius of all pairs, m, where it is the same.
    support: f64,
    pairs: Vec<FourPairs>,
    rows: Vec<[u32; 4]>,
    /// X_ij, where it is not x_ij.
    reference: Vec<FourVectors>,
    /// Signs of the axes of mirror images.
    mirrors: Vec<[DVec3; 4]>,
    /// Mean support radii, m.
    supports: Vec<Lanes4>,
}

/// Room for the neighbours of a row.
pub struct RowSlots<'a> {
    /// Four neighbours each.
    pub pairs: &'a mut [FourPairs],
    /// Rows in the phase.
    pub rows: &'a mut [[u32; 4]],
    /// X_ij, if the pairs have it.
    pub reference: &'a mut [FourVectors],
    /// Signs of the axes, if there are mirror images.
    pub mirrors: &'a mut [[DVec3; 4]],
    /// Mean support radii, m, if they differ.
    pub supports: &'a mut [Lanes4],
}

/// One neighbour, as [`RowSlots::put`] takes it.
#[derive(Clone, Copy, Debug, Default)]
pub struct Neighbor {
    /// Real row in the phase.
    pub row: u32,
    /// Signs of the axes: those of the map to a ghost, else one.
    pub signs: DVec3,
    /// x_ij, m.
    pub current: DVec3,
    /// X_ij, m.
    pub reference: DVec3,
    /// v_ij, m/s.
    pub velocity: DVec3,
    /// Pair weight w_ij.
    pub weight: f64,
    /// Kernel value W_ij.
    pub kernel: f64,
    /// Volume V_j, m3.
    pub volume: f64,
    /// Mean support radius, m.
    pub support: f64,
}

impl RowSlots<'_> {
    /// Puts a neighbour in place `k`: for formulations that do not fill the lanes themselves.
    pub fn put(&mut self, k: usize, neighbor: Neighbor) {
        let Neighbor { row, signs, current, reference, velocity, weight, kernel, volume, support } = neighbor;
        let (n, lane) = (k / 4, k % 4);
        let has_reference = !self.reference.is_empty();
        let put = |four: &mut FourVectors, vector: DVec3| {
            (0..3).for_each(|axis| four.vector[axis].0[lane] = vector[axis]);
            let square = vector.length_squared().max(f64::MIN_POSITIVE);
            four.length.0[lane] = if has_reference { square } else { square.sqrt() };
        };
        let pair = &mut self.pairs[n];
        put(&mut pair.current, current);
        (0..3).for_each(|axis| pair.velocity[axis].0[lane] = velocity[axis]);
        (pair.weight.0[lane], pair.kernel.0[lane], pair.volume_j.0[lane]) = (weight, kernel, volume);
        self.rows[n][lane] = row;
        if let Some(four) = self.reference.get_mut(n) {
            put(four, reference);
        }
        if let Some(mirrors) = self.mirrors.get_mut(n) {
            mirrors[lane] = signs;
        }
        if let Some(supports) = self.supports.get_mut(n) {
            supports.0[lane] = support;
        }
    }

    /// Empties the places from `k` on.
    pub fn close(&mut self, k: usize) {
        (k..4 * self.pairs.len()).for_each(|k| self.put(k, Neighbor::default()));
    }
}

impl PairBatch {
    /// Takes all rows out. `support` is the support radius of all pairs, m; it has no meaning where they
    /// differ.
    #[inline(always)]
    pub fn begin(&mut self, extras: Extras, support: f64) {
        self.count = 0;
        (self.extras, self.support) = (extras, support);
    }

    /// Whether the terms should see this before more rows are added.
    #[inline(always)]
    pub fn is_full(&self) -> bool {
        self.count == MAX_ROWS || self.starts[self.count] >= FULL
    }

    /// Number of rows.
    #[inline(always)]
    pub fn rows(&self) -> usize {
        self.count
    }

    /// Adds the row of the next particle, of volume V_i, m3, with capacity for that many neighbours, to be
    /// filled by the caller.
    #[inline(always)]
    pub fn add_row(&mut self, volume_i: f64, neighbors: usize) -> RowSlots<'_> {
        let start = self.starts[self.count];
        let end = start + neighbors.div_ceil(4);
        if self.pairs.len() < end {
            self.grow(end);
        }
        self.volumes[self.count] = volume_i;
        self.count += 1;
        self.starts[self.count] = end;
        let Extras { reference, mirrors, supports, .. } = self.extras;
        RowSlots {
            pairs: &mut self.pairs[start..end],
            rows: &mut self.rows[start..end],
            reference: if reference { &mut self.reference[start..end] } else { &mut [] },
            mirrors: if mirrors { &mut self.mirrors[start..end] } else { &mut [] },
            supports: if supports { &mut self.supports[start..end] } else { &mut [] },
        }
    }

    #[cold]
    fn grow(&mut self, fours: usize) {
        let fours = 2 * fours.max(FULL);
        self.pairs.resize(fours, FourPairs::default());
        self.rows.resize(fours, [0; 4]);
        self.reference.resize(fours, FourVectors::default());
        self.mirrors.resize(fours, [DVec3::ONE; 4]);
        self.supports.resize(fours, Lanes4::ZERO);
    }

    /// Data of the pairs beside x_ij.
    #[inline(always)]
    pub(super) fn extras(&self) -> Extras {
        self.extras
    }

    /// Row `r`.
    #[inline(always)]
    pub(super) fn row(&self, r: usize) -> Row<'_> {
        let part = self.starts[r]..self.starts[r + 1];
        let Extras { reference, mirrors, supports, weight_at } = self.extras;
        let extra = |wanted: bool| if wanted { part.clone() } else { 0..0 };
        Row {
            volume_i: self.volumes[r],
            support: self.support,
            weight_at,
            reference: &self.reference[extra(reference)],
            mirrors: &self.mirrors[extra(mirrors)],
            supports: &self.supports[extra(supports)],
            pairs: &self.pairs[part.clone()],
            rows: &self.rows[part],
        }
    }
}

/// The neighbours of one particle.
pub(super) struct Row<'a> {
    pairs: &'a [FourPairs],
    rows: &'a [[u32; 4]],
    reference: &'a [FourVectors],
    mirrors: &'a [[DVec3; 4]],
    supports: &'a [Lanes4],
    support: f64,
    weight_at: WeightAt,
    volume_i: f64,
}

impl Row<'_> {
    /// Number of fours.
    #[inline(always)]
    pub fn fours(&self) -> usize {
        self.pairs.len()
    }

    /// Rows of the neighbours of a four in the phase, and the signs of the axes of mirror images; `ALIKE`
    /// where there are none.
    #[inline(always)]
    pub fn rows<const ALIKE: bool>(&self, k: usize) -> ([u32; 4], Option<&[DVec3; 4]>) {
        (self.rows[k], if ALIKE { None } else { self.mirrors.get(k) })
    }

    /// The pairs of a four; `PLAIN` without reference vectors, `ALIKE` with one support radius.
    #[inline(always)]
    pub fn pair<A: FourLanes, const PLAIN: bool, const ALIKE: bool>(&self, a: A, k: usize) -> Pair<A> {
        let FourPairs { current, velocity, weight, kernel, volume_j, .. } = &self.pairs[k];
        let reference = if PLAIN { current } else { self.reference.get(k).unwrap_or(current) };
        let support = if ALIKE { None } else { self.supports.get(k).copied() };
        let support = support.unwrap_or(Lanes4::splat(self.support));
        Pair {
            x_ij: Vector::new(a, current.vector),
            reference_x_ij: Vector::new(a, reference.vector),
            weight: Number::new(a, *weight),
            kernel: Number::new(a, *kernel),
            v_ij: Vector::new(a, *velocity),
            support: Number::new(a, support),
            volume_i: Number::splat(a, self.volume_i),
            volume_j: Number::new(a, *volume_j),
            length: Number::new(a, current.length),
            reference_length: Number::new(a, reference.length),
            is_reference: PLAIN,
            weight_at: if PLAIN { WeightAt::Current } else { self.weight_at },
        }
    }
}
