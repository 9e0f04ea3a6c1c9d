//! Sums over the neighbours of every particle, as plugins and fields define them.

use std::ops::Range;

use glam::DVec3;

use crate::formulations::fluid::lanes::FluidKernel;
use crate::parallel::{Arithmetic, Number, Vector};

/// Pairs as a [`RowPass`] sees them: a lane is a neighbour of one particle, or, with sums in single
/// precision, a particle that has one neighbour in common with others. Where there is no neighbour, beyond
/// the support and for the particle itself the volume is zero and the distance above zero.
#[derive(Clone, Copy)]
pub struct NearPairs<A: Arithmetic> {
    /// Number of the body of the neighbour in [`FlowCloud::groups`](super::flow_cloud::FlowCloud).
    pub group: usize,
    /// Whether the neighbour flows; it bounds the flow otherwise.
    pub is_fluid: bool,
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

impl<A: Arithmetic> NearPairs<A> {
    /// Change of volume over the volume by displacements of particle and neighbour, m: `V_j (dx_j - dx_i) .
    /// grad_i W` halfway along them, of second order.
    #[inline(always)]
    pub fn dilation(&self, kernel: &FluidKernel, dx_i: Vector<A>, dx_j: Vector<A>) -> Number<A> {
        let a = self.weight.arithmetic();
        let apart = dx_j - dx_i;
        let middle = apart.mul_add(Number::splat(a, 0.5), self.x_ij);
        let weight = kernel.weights(a, middle.length_squared().sqrt().lanes());
        self.volume * Number::new(a, weight) * apart.dot(middle)
    }
}

/// Sums over the neighbours of every particle, in `SUMS` vectors, that read `READS` vectors of each. In the
/// plane the z of both is zero.
pub trait RowPass<const READS: usize, const SUMS: usize>: Sync {
    /// Result for each particle.
    type Output: Send;

    /// The rows of the cloud among which neighbours are summed: those of whole bodies.
    fn among(&self) -> Range<usize>;

    /// Vectors read of the particle in that row of the cloud. It may be rounded to single precision:
    /// subtract what all particles have in common.
    fn reads(&self, row: usize) -> [DVec3; READS];

    /// Adds neighbours to the sums; `own` was read of the particle, `other` of the neighbour. Mark it
    /// `#[inline(always)]`: it is then compiled for the instruction path of the loop around it.
    fn add<A: Arithmetic>(
        &self,
        near: &NearPairs<A>,
        own: &[Vector<A>; READS],
        other: &[Vector<A>; READS],
        sums: &mut [Vector<A>; SUMS],
    );

    /// Result from the sums of the particle in that row.
    fn output(&self, row: usize, sums: &[DVec3; SUMS]) -> Self::Output;

    /// Whether the sums of that particle are not wanted; they are zero then.
    #[inline(always)]
    fn skips(&self, _row: usize) -> bool {
        false
    }
}
