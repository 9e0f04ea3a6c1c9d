//! Sums over the neighbours of a fluid particle, four neighbours at a time: what plugins look at a flow with.

use std::ops::Range;

use super::flow_cloud::FlowCloud;
use crate::formulations::fluid::lanes::{FILLS, Places, as_rows, filled_up};
use crate::parallel::{FourLanes, HotLoop, Lanes4, Number, Vector, for_each_block, run_hot_on};

/// Four neighbours of a particle. Lanes without a neighbour, and neighbours beyond the support, have weight, kernel and volume
/// zero and a distance above zero.
#[derive(Clone, Copy)]
pub struct FourNear<A: FourLanes> {
    /// Rows of fluid particles in their phase; beyond the number of fluid particles, something that bounds the fluid.
    pub rows: [usize; 4],
    /// x_ij = x_j - x_i, m.
    pub x_ij: Vector<A>,
    /// Its length, m.
    pub distance: Number<A>,
    /// Pair weight w_ij = |W'(r)| / r, so that grad_i W = w_ij x_ij.
    pub weight: Number<A>,
    /// Kernel value W_ij.
    pub kernel: Number<A>,
    /// Volume V_j, m3; zero for a removed particle.
    pub volume: Number<A>,
}

impl<A: FourLanes> FourNear<A> {
    /// A number of each of the four.
    #[inline(always)]
    pub fn number(&self, of: impl Fn(usize) -> f64) -> Number<A> {
        let [j, k, l, m] = self.rows;
        Number::new(self.weight.arithmetic(), Lanes4([of(j), of(k), of(l), of(m)]))
    }

    /// A vector of each of the four.
    #[inline(always)]
    pub fn vector(&self, of: impl Fn(usize) -> glam::DVec3) -> Vector<A> {
        let [j, k, l, m] = self.rows;
        Vector::from_rows(self.weight.arithmetic(), [of(j), of(k), of(l), of(m)])
    }
}

/// The neighbours of a particle, four at a time.
pub struct Fours<'a, A> {
    cloud: &'a FlowCloud,
    i: usize,
    chunks: std::slice::Chunks<'a, u32>,
    arithmetic: A,
}

impl<A: FourLanes> Iterator for Fours<'_, A> {
    type Item = FourNear<A>;

    #[inline(always)]
    fn next(&mut self) -> Option<FourNear<A>> {
        let chunk = self.chunks.next()?;
        let (a, cloud) = (self.arithmetic, self.cloud);
        let rows = as_rows(filled_up(chunk));
        let Places { x, volume } =
            Places::gather(a, &cloud.records, &cloud.records[self.i], rows, &cloud.periods);
        let x_ij = Vector::new(a, x);
        let square = x_ij.length_squared().lanes();
        let mut fill = FILLS[chunk.len()];
        if cloud.blocks.is_some() {
            // The list of its block holds the particle itself.
            let own = |row: usize| if row == self.i { 4.0 } else { 0.0 };
            fill = a.plus(fill, Lanes4([own(rows[0]), own(rows[1]), own(rows[2]), own(rows[3])]));
        }
        let (square, volume) = cloud.kernel.within(a, square, fill, volume);
        let distance = a.sqrt(square);
        Some(FourNear {
            rows,
            x_ij,
            distance: Number::new(a, distance),
            weight: Number::new(a, cloud.kernel.weights(a, distance)),
            kernel: Number::new(a, cloud.kernel.values(a, distance)),
            volume: Number::new(a, volume),
        })
    }
}

/// A function of the neighbours of one particle.
pub trait RowPass: Sync {
    /// What it makes for each particle.
    type Output: Send;

    /// The value of particle `i`, its row in the phase of fluids. Mark it `#[inline(always)]`: it is then compiled for the
    /// instruction path of the loop around it.
    fn row<A: FourLanes>(&self, a: A, i: usize) -> Self::Output;
}

struct Block<'a, P: RowPass> {
    pass: &'a P,
    first: usize,
    out: &'a mut [P::Output],
}

impl<P: RowPass> HotLoop for Block<'_, P> {
    type Output = ();

    #[inline(always)]
    fn run<A: FourLanes>(self, a: A) {
        for (k, out) in self.out.iter_mut().enumerate() {
            *out = self.pass.row(a, self.first + k);
        }
    }
}

impl FlowCloud {
    /// The neighbours of particle `i` in the bodies whose rows are `among`, in the order of its list, four at a time; `0..self.fluid` are all
    /// fluids, the rows of a body those of its own, and [`FlowCloud::everything`] also what bounds the fluid.
    #[inline(always)]
    pub fn fours<A: FourLanes>(&self, a: A, i: usize, among: &Range<usize>) -> Fours<'_, A> {
        Fours { cloud: self, i, chunks: part(self.near_row(i), among).chunks(4), arithmetic: a }
    }

    /// The neighbours of particle `i`, to be taken group by group ([`FlowCloud::next_fours`]).
    #[inline(always)]
    pub(in crate::formulations::fluid) fn near_row(&self, i: usize) -> &[u32] {
        if i >= self.fluid {
            return self.near_boundary.row(i - self.fluid);
        }
        let shared = self.blocks.as_ref().and_then(|blocks| blocks.shared_row(i));
        shared.unwrap_or_else(|| self.near.row(i))
    }

    /// Takes the neighbours in group `n` out of what is left of the row of particle `i`, whose groups come in their order: a flow may have many bodies, of
    /// which few are near.
    #[inline(always)]
    pub(in crate::formulations::fluid) fn next_fours<'a, A: FourLanes>(
        &'a self,
        a: A,
        i: usize,
        n: usize,
        rest: &mut &'a [u32],
    ) -> Fours<'a, A> {
        let row = take_until(rest, self.groups[n].cloud.end);
        Fours { cloud: self, i, chunks: row.chunks(4), arithmetic: a }
    }

    /// All rows of the cloud.
    pub fn everything(&self) -> Range<usize> {
        0..self.records.len()
    }

    /// Runs a pass over the particles from row `first` on, in parallel.
    pub fn for_each_row<P: RowPass>(&self, first: usize, out: &mut [P::Output], pass: &P) {
        for_each_block(out, &mut Vec::new(), &|start, out: &mut [P::Output]| {
            run_hot_on(self.plane, Block { pass, first: first + start, out });
        });
    }
}

/// Takes the neighbours before row `end` of the cloud, where a group ends, out of what is left of a row that is ordered by groups.
#[inline(always)]
pub fn take_until<'a>(rest: &mut &'a [u32], end: usize) -> &'a [u32] {
    let end = end as u32;
    let count = match rest.last() {
        Some(&last) if last >= end => rest.partition_point(|&j| j < end),
        _ => rest.len(),
    };
    let (row, tail) = rest.split_at(count);
    *rest = tail;
    row
}

/// The part of a row that lies in a range of whole bodies: rows are ordered by bodies.
#[inline(always)]
pub fn part<'a>(row: &'a [u32], among: &Range<usize>) -> &'a [u32] {
    let (Some(&first), Some(&last)) = (row.first(), row.last()) else { return row };
    let (start, end) = (among.start as u32, among.end as u32);
    if start <= first && last < end {
        return row;
    }
    let row = &row[row.partition_point(|&j| j < start)..];
    &row[..row.partition_point(|&j| j < end)]
}
