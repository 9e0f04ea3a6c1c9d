//! What a pair term is: geometry of one pair and columns of both particles in, rates out.

use glam::DVec3;

use super::bound::ErasedTerm;
use super::read::ReadSet;
use crate::plugin::SimBuilder;
use crate::world::BodySet;

/// Geometry of one pair, from particle i to its neighbour j. In formulations without a reference configuration the
/// reference vector is the current one.
#[derive(Clone, Copy, Debug, Default)]
pub struct Pair {
    /// Current pair vector x_ij = x_j - x_i, m.
    pub x_ij: DVec3,
    /// Its length, m.
    pub distance: f64,
    /// Reference pair vector X_ij, m.
    pub reference_x_ij: DVec3,
    /// Its length, m.
    pub reference_distance: f64,
    /// Pair weight w_ij = |W'(r)| / r of the formulation's kernel, so that grad_i W = w_ij x_ij.
    pub weight: f64,
    /// Kernel value W_ij, 1/m2 or 1/m3; not a number unless a term of the body reads it ([`PairTerm::READS_KERNEL`]).
    pub kernel: f64,
    /// Mean support radius of the two particles, m.
    pub support: f64,
    /// Volume of i in the formulation's sums, m3.
    pub volume_i: f64,
    /// Volume of j, m3.
    pub volume_j: f64,
    /// Row of j in the phase; where j is an image, that of its source.
    pub row_j: u32,
    /// Where j is a mirror image across symmetry planes: the signs of the axes. The columns of j that a term gets are
    /// mirrored already.
    pub mirror: Option<DVec3>,
}

impl Pair {
    /// Smoothing length h that artificial viscosity and its kin are scaled with: half the support radius, m.
    pub fn smoothing_length(&self) -> f64 {
        0.5 * self.support
    }
}

/// What a term adds to particle i.
#[derive(Clone, Copy, Debug, Default)]
pub struct Rates {
    /// Force on i, N. The force on j must be its exact opposite when the roles are swapped.
    pub force: DVec3,
    /// Rate of change of the density of i, kg/(m3 s), in fluids; of a term with [`PairTerm::CHANGES_DENSITY`].
    pub density: f64,
    /// Rate at which the term damps the velocity of i against fixed neighbours, 1/s: limits the time step.
    pub damping: f64,
    /// Stiffness per mass that the term gives i against fixed neighbours, 1/s2: limits the time step.
    pub stiffness: f64,
}

/// Contribution of neighbour j to particle i, written as a function of one pair.
pub trait PairTerm: Send + Sync + 'static {
    /// Columns it needs of i: a tuple of columns.
    type ReadI: ReadSet;
    /// Columns it needs of j.
    type ReadJ: ReadSet;

    /// Whether it reads [`Pair::kernel`]. A term that does not saves the kernel of every pair by saying so.
    const READS_KERNEL: bool = true;
    /// Whether the term gives density rates.
    const CHANGES_DENSITY: bool = false;

    /// Adds the contribution of j to the rates of i.
    fn pair(&self, pair: &Pair, i: &Self::ReadI, j: &Self::ReadJ, rates: &mut Rates);
}

/// A pair term with the bodies it acts on.
pub struct BodyPairTerm {
    pub(super) bodies: BodySet,
    pub(super) account: String,
    pub(super) term: Box<dyn ErasedTerm>,
}

impl SimBuilder<'_> {
    /// Adds a pair term to bodies. The energy that its forces take out of the motion is booked as dissipated, in the
    /// account of that name; it is negative where they put energy in.
    pub fn add_pair_term(&mut self, bodies: BodySet, account: &str, term: impl PairTerm) {
        self.extend(BodyPairTerm { bodies, account: account.to_owned(), term: Box::new(term) });
    }
}
