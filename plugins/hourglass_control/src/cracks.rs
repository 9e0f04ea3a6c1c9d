//! Pair forms of the control in bodies that can fail.
//!
//! A bond with a failed particle at either end carries no hourglass force: its residual is the opening of a
//! crack. The deformation gradient with which other bonds are compared leaves such bonds out too. The
//! variational form needs no such treatment, because bond terms do not act across cracks.

use glam::DMat3;
use meshless_engine::pair::{Pair, PairTerm, Rates};
use meshless_engine::parallel::{Arithmetic, Matrix, Number};
use meshless_engine::plugin::{SetupError, SimBuilder};
use meshless_engine::solids::{FoldedEnergy, FoldedRows, FoldedTerm, FoldedTermOfBodies};
use meshless_engine::world::{
    BodyId, BodySet, Column, Damage, DeformationGradient, HourglassGradient, HourglassModulus,
};

use crate::ganzenmueller_2015::Ganzenmueller2015;
use crate::stiffness::Stiffness;
use crate::viscous::Viscous;

/// Whether the material of a body can fail.
pub fn can_fail(sim: &SimBuilder<'_>, id: BodyId) -> Result<bool, SetupError> {
    let body = sim.body(id);
    body.solid_law().map(|_| body.can_fail())
}

/// Adds a pair form to a body that can fail.
pub fn add_off_cracks(sim: &mut SimBuilder<'_>, id: BodyId, account: &str, term: impl PairTerm) {
    let bodies = BodySet::new([id]);
    sim.add_column_to::<HourglassGradient>(&bodies);
    let measure = FoldedTermOfBodies { account: None, released: None, term: Box::new(MeasureFit) };
    measure.add(bodies.clone(), sim);
    sim.add_pair_term(bodies, account, term);
}

/// Writes the fit to the intact neighbours to its column.
struct MeasureFit;

impl FoldedTerm for MeasureFit {
    fn add(&self, rows: &mut FoldedRows<'_>) -> FoldedEnergy {
        for (column, gradient) in rows.memory.gradient.iter_mut().zip(rows.displacement_gradient) {
            *column = DMat3::IDENTITY + *gradient;
        }
        FoldedEnergy::default()
    }

    fn stiffness_factor(&self) -> f64 {
        0.0
    }

    fn only_looks(&self) -> bool {
        true
    }
}

/// A pair form that does not act on bonds with a failed particle.
pub struct OnIntactBonds<T>(pub T);

/// The pair, in which a neighbour across a crack is none: it has no volume.
#[inline(always)]
fn off_cracks<A: Arithmetic>(pair: &Pair<A>, damage_i: Number<A>, damage_j: Number<A>) -> Pair<A> {
    let mut whole = *pair;
    whole.volume_j = damage_i.if_below(1.0, damage_j.if_below(1.0, pair.volume_j));
    whole
}

impl PairTerm for OnIntactBonds<Ganzenmueller2015<HourglassGradient>> {
    type ReadI = (HourglassGradient, HourglassModulus, Damage);
    type ReadJ = (HourglassGradient, HourglassModulus, Damage);

    const READS_VELOCITY: bool = false;
    const NEEDS_REFERENCE: bool = true;

    #[inline(always)]
    fn pair<A: Arithmetic>(
        &self,
        pair: &Pair<A>,
        (f_i, e_i, damage_i): (Matrix<A>, Number<A>, Number<A>),
        (f_j, e_j, damage_j): (Matrix<A>, Number<A>, Number<A>),
        rates: &mut Rates<A>,
    ) {
        self.0.pair(&off_cracks(pair, damage_i, damage_j), (f_i, e_i), (f_j, e_j), rates);
    }
}

impl<F: Column<Value = DMat3>> PairTerm for OnIntactBonds<Viscous<F>> {
    type ReadI = (F, Damage);
    type ReadJ = (F, Damage);

    const READS_KERNEL: bool = false;
    const NEEDS_REFERENCE: bool = true;

    #[inline(always)]
    fn pair<A: Arithmetic>(
        &self,
        pair: &Pair<A>,
        (f_i, damage_i): (Matrix<A>, Number<A>),
        (f_j, damage_j): (Matrix<A>, Number<A>),
        rates: &mut Rates<A>,
    ) {
        self.0.pair(&off_cracks(pair, damage_i, damage_j), (f_i,), (f_j,), rates);
    }
}

impl PairTerm for OnIntactBonds<Stiffness> {
    type ReadI = (DeformationGradient, HourglassModulus, Damage);
    type ReadJ = (DeformationGradient, HourglassModulus, Damage);

    const READS_VELOCITY: bool = false;
    const NEEDS_REFERENCE: bool = true;

    #[inline(always)]
    fn pair<A: Arithmetic>(
        &self,
        pair: &Pair<A>,
        (f_i, e_i, damage_i): (Matrix<A>, Number<A>, Number<A>),
        (f_j, e_j, damage_j): (Matrix<A>, Number<A>, Number<A>),
        rates: &mut Rates<A>,
    ) {
        self.0.pair(&off_cracks(pair, damage_i, damage_j), (f_i, e_i), (f_j, e_j), rates);
    }
}
