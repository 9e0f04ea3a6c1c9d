//! Solids whose kernels live in the current configuration (Mohseni-Mofidi and Bierwisch 2020), with the
//! corrections of docs/eulerian.md.
//!
//! Neighbours, weights and corrections are evaluated at the current positions; a particle keeps its state
//! only. A step is
//!
//! ```text
//! rates     L_i = (sum_j V_0,j w_ij v_ij (x) x_ij) M_i^-1 ,  M_i = sum_j V_0,j w_ij x_ij (x) x_ij      with the positions at mid-step
//!           F_i <- (I - dt/2 L_i)^-1 (I + dt/2 L_i) F_i
//! stress    F_i -> P_i (any law) ,  A_i = P_i F_i^T M_i^-1                                          with the positions at the end of the step
//! force     f_i = V_0,i sum_j V_0,j w_ij (A_i + A_j) x_ij
//! ```
//!
//! The weights use reference volumes: with current volumes L would depend on F, which is known only at the
//! ends of a step, and the step would not be time-reversible.
//!
//! The force is the exact adjoint of the velocity gradient at the same positions: its power is the stress
//! power, and it has no resultant and no torque. The lists have a skin; a step takes from them the neighbours
//! within the support, in the order of rows, so that results do not depend on the age of the lists.

mod artificial_stress;
mod control;
mod control_pairs;
mod control_rows;
mod dilatation;
mod divergence;
mod elsewhere;
mod force;
mod gathered;
mod lists;
mod near;
mod pairs;
mod parameters;
mod particle;
mod phase;
mod rates;
mod rows;
mod separation;
mod start;
mod stress;
mod supports;
mod within;

pub use artificial_stress::{ArtificialStress, TensileStress};
pub use control::HourglassEnergy;
pub use dilatation::DilatationRate;
pub use divergence::Divergence;
pub use parameters::Eulerian;
pub(crate) use supports::SUPPORT_CHANGE;
pub use supports::SupportMetric;
