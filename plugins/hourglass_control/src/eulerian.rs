//! The control of bodies whose weights belong to the current configuration: pair terms, which leave out
//! failed particles.

use meshless_engine::plugin::{SetupError, SimBuilder};
use meshless_engine::solids::{FoldedTerm, FoldedTermOfBodies, PairControl};
use meshless_engine::world::{BodyId, BodySet, DeformationGradient, HourglassModulus};

use crate::cracks::{OnIntactBonds, can_fail};
use crate::resistance::{AfterYield, Resistance};
use crate::stiffness::Stiffness;
use crate::viscous::Viscous;
use crate::{VISCOSITY, WORK};

/// The elastic part of the control.
#[derive(Clone, Copy)]
pub struct Elastic {
    /// Coefficient xi; none at all where it is zero.
    pub xi: f64,
    /// Coefficient of the error across a pair over xi.
    pub across: f64,
    /// The modulus after yield.
    pub after_yield: AfterYield,
    /// The exact gradient of an energy, or the form of the paper.
    pub has_energy: bool,
}

/// Adds an elastic part, and the viscous form with the coefficient zeta, to a body. The deformation gradient
/// is a state of its particles, so that it needs no other fit beside cracks.
pub fn add(elastic: Elastic, zeta: f64, id: BodyId, sim: &mut SimBuilder<'_>) -> Result<(), SetupError> {
    let Elastic { xi, across, after_yield, has_energy } = elastic;
    let (bodies, fails) = (BodySet::new([id]), can_fail(sim, id)?);
    if xi > 0.0 {
        sim.add_column_to::<HourglassModulus>(&bodies);
        let term: Box<dyn FoldedTerm> = Box::new(Resistance(after_yield));
        FoldedTermOfBodies { account: None, released: None, term }.add(bodies.clone(), sim);
        let term = Stiffness { xi, density: sim.body(id).material.density };
        if has_energy {
            PairControl { xi, across: across * xi }.add(bodies.clone(), sim);
        } else if fails {
            sim.add_pair_term(bodies.clone(), WORK, OnIntactBonds(term));
        } else {
            sim.add_pair_term(bodies.clone(), WORK, term);
        }
    }
    if zeta > 0.0 {
        let term = Viscous::<DeformationGradient>::of(zeta, id, sim)?;
        if fails {
            sim.add_pair_term(bodies, VISCOSITY, OnIntactBonds(term));
        } else {
            sim.add_pair_term(bodies, VISCOSITY, term);
        }
    }
    Ok(())
}
