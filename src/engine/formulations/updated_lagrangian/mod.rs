//! Updated-Lagrangian smoothed particle hydrodynamics of solids (Vidal, Bonet, Huerta 2007).
//!
//! Neighbours, weights and corrections belong to a reference that follows the body: at an update the present
//! configuration becomes the reference (relaxed, see `smoothed_reference`). With x_r the positions of the
//! reference and F_r the deformation gradient there,
//!
//! ```text
//! f_i = (sum_j V_j w_ij x_ij (x) r_ij) M_i^-1 ,   r_ij = x_r,j - x_r,i ,   V = V_0 det F_r
//! F_i = f_i F_r,i -> P_i ,   A_i = (V_0 / V)_i P_i F_r,i^T M_i^-1
//! force_i = V_i sum_j V_j w_ij (A_i + A_j) r_ij
//! ```
//!
//! The force is the exact adjoint of the gradient f. The passes are those of the total-Lagrangian formulation
//! over another reference (`gradient`, `force`), and so are neighbour lists and pair terms: between updates
//! the body is a total-Lagrangian one. Hourglass control measures from the original pair vectors (`control`),
//! so that an update does not erase the residual that it resists.

mod candidates;
mod columns;
mod control;
mod due;
mod force;
mod force_change;
mod gradient;
mod lists;
mod lost_neighbors;
mod pack;
mod parameters;
mod phase;
mod reference;
mod reference_fit;
mod row_loops;
mod seen;
mod set_up;
mod smoothed_reference;
mod system;
mod update;
mod weigh_control;

pub use columns::{UpdatedGradient, UpdatedReference, UpdatedVolume};
pub use parameters::UpdatedLagrangian;
pub use update::Update;
