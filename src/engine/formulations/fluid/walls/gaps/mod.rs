//! Gaps between bodies that are narrower than the spacing of the fluid.
//!
//! No particle of the fluid fits into such a gap, so that its pairs give no force there: a body on the floor
//! of a tank would be pressed onto it by all of the water above. A particle `i` of a body beside another body
//! or a wall therefore feels what is neither its own body nor fluid as if it were fluid,
//!
//! `f_i = V_i [2 p_i sum_j V_j w_ij x_ij - (1 - sum_j V_j w_ij x_ij (x) x_ij) grad p_i]`, the sums over its
//! own body and the fluid,
//!
//! which is the pressure force of a fluid that fills the rest of the support, for a pressure that is linear
//! in space. A closed surface feels no force of an even pressure, whatever the arrangement of particles, and
//! its buoyancy in a fluid at rest. The particles of the other body get the opposite.

mod fill;

mod moments;

mod share;

mod system;

pub use system::GapPressure;
