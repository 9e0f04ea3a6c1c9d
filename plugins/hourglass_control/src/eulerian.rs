//! The control of bodies whose weights are those of the present places: pair terms, which leave out what has failed.

use meshless_engine::plugin::{SetupError, SimBuilder};
use meshless_engine::solids::{FoldedTerm, FoldedTermOfBodies};
use meshless_engine::world::{BodyId, BodySet, DeformationGradient, HourglassModulus};

use crate::cracks::{OffCracks, can_fail};
use crate::resistance::{AfterYield, Resistance};
use crate::stiffness::Stiffness;
use crate::viscous::Viscous;
use crate::{VISCOSITY, WORK};

/// Adds the stiffness form with the coefficient xi, and the viscous form with the coefficient zeta, to a body. The deformation gradient is a state of
/// its particles, so that it needs no other fit beside cracks.
pub fn add(
    (xi, after_yield): (f64, AfterYield),
    zeta: f64,
    id: BodyId,
    sim: &mut SimBuilder<'_>,
) -> Result<(), SetupError> {
    let (bodies, fails) = (BodySet::new([id]), can_fail(sim, id)?);
    if xi > 0.0 {
        sim.add_column_to::<HourglassModulus>(&bodies);
        let term: Box<dyn FoldedTerm> = Box::new(Resistance(after_yield));
        FoldedTermOfBodies { account: None, released: None, term }.add(bodies.clone(), sim);
        let term = Stiffness { xi, density: sim.body(id).material.density };
        if fails {
            sim.add_pair_term(bodies.clone(), WORK, OffCracks(term));
        } else {
            sim.add_pair_term(bodies.clone(), WORK, term);
        }
    }
    if zeta > 0.0 {
        let term = Viscous::<DeformationGradient>::of(zeta, id, sim)?;
        if fails {
            sim.add_pair_term(bodies, VISCOSITY, OffCracks(term));
        } else {
            sim.add_pair_term(bodies, VISCOSITY, term);
        }
    }
    Ok(())
}
