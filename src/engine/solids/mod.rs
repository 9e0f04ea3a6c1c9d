//! Parts shared by all formulations of solids, without neighbour lists.
//!
//! The data flow of a solid in a step, in the words of the files here:
//!
//! ```text
//! set-up        the formulation puts its packed rows into the resources as a `SolidPhase`           (phase)
//! Constitutive  the formulation fits F to the neighbours of a block of particles, then
//!                 `Constitutive::stress`  F -> law -> P, damping of sub-steps                      (constitutive, refit, damping)
//!                 the formulation computes the record for neighbours: A = P M^-1                     (corrected_stress)
//!                 `Constitutive::fold`    terms of plugins add to A and k                            (folded)
//!                 `SolidSum::close`       energies of the block
//!                 differences of second derivatives of positions, and control along pairs, add to A  (hessian, pair_control)
//!               `SolidBodies::book` and `limit`: energies, inverted particles, stable step           (bodies, stretches, stable_step)
//! Boundary      contact adds couples on material points beside particles through `SolidPhase`        (local_motion)
//! Rates         the formulation's own pass over pairs writes the force; pair terms add to it         (crate::pair)
//! ```

mod access;
mod bodies;
mod constitutive;
mod corrected_stress;
mod damping;
mod fields;
mod fit;
mod folded;
mod heat_capacity;
mod hessian;
mod local_motion;
mod losses;
mod pair_control;
mod pairs;
mod phase;
mod present;
mod refit;
mod repeated;
mod row_loops;
mod stable_step;
mod stretches;
mod support;
mod thin_body;

pub use bodies::{BodyPass, SolidBodies, SolidBody, SolidPart};
pub use constitutive::{Constitutive, SolidBlock, SolidColumns, SolidRows, SolidSum};
pub use corrected_stress::{CorrectedStress, CorrectedStressRows};
pub(crate) use damping::{DampedSubSteps, LeastTime};
pub(crate) use fields::{fields, hourglass_residual};
pub(crate) use fit::fit;
pub use folded::{FoldedEnergy, FoldedMemory, FoldedRows, FoldedTerm, FoldedTermOfBodies};
pub use heat_capacity::HeatCapacity;
pub use hessian::{HessianDifference, HessianForm, HessianResidual, HessianStiffness};
pub use local_motion::{HasPlace, LocalFit, LocalMotion, RateSum};
pub use losses::{AppliedLosses, Loss};
pub use pair_control::PairControl;
pub use pairs::SolidPairs;
pub use phase::{CORRECTED_STRESS, PACKED_SOLID, SolidPhase};
pub use present::{PresentPair, PresentPairs, PresentVolumes};
pub use refit::{Refits, change_of_fit};
pub use row_loops::{count_rows, fill_rows};
pub use stable_step::{BodyStep, StepEstimate};
pub use support::require_support;
