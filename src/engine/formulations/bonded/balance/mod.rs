//! Beside a side held along its normal, particles carry shares of their stress, for which a uniform stress is
//! in equilibrium.
//!
//! The force of a uniform stress P on particle i is P b_i,
//!
//! ```text
//! b_i = V_i sum_j V_j w_ij (c_i M_i^-1 + c_j M_j^-1) X_ij
//! ```
//!
//! with the share c of its stress and energy that a particle carries, which is the weight of its place in the
//! integral of the energy. Inside of a lattice b is zero. Beside a held side it is not, as kernels and moment
//! matrices are cut there: with c = 1 a uniformly drawn bar has 13 % too much stress in the layer on the side
//! and 3.5 % too little in the next one at any spacing, and in metal with little hardening this becomes
//! plastic strain.
//!
//! The shares are those nearest to 1 for which n . b_i of the particles beside a held side with the normal n
//! has its required value: zero where the body is a prism there, elsewhere the value with the body's mirror
//! image behind the side. All of b is then on the particles that the condition holds, and by its first moment
//! the sum of V c is the volume of the body; where the zones of two sides meet, that sum is a separate
//! equation. Shares do not change with time, so that forces stay the derivative of an energy. The remaining b
//! is the imbalance, of which the program warns for metal.
//!
//! Sides that are held along all axes have such shares where the body is endless along them: the stress
//! beside them is uniform, and it is in balance in shear too, because b is along the normal and its product
//! with any stress vanishes with it. Others keep c = 1: at their edges the stress is not uniform.

mod alike;
mod body;
mod equations;
mod labels;
mod lattice;
mod lattices;
mod least_squares;
mod prism;
mod shares;
mod warning;
mod zone;

pub(in crate::formulations) use body::HeldBody;
pub(in crate::formulations) use shares::balanced_shares;
pub(in crate::formulations) use warning::{warning, warning_of_update};
