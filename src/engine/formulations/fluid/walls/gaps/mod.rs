//! Gaps between bodies that are narrower than the spacing of the fluid.
//!
//! No particle of the fluid fits into such a gap, so that its pairs give no force there: a body on the floor
//! of a tank would be pressed onto it by all of the water above. A particle `i` of a body beside another body
//! or a wall therefore has the force that fluid would exert if it filled all space outside its own body,
//!
//! `f_i = V_i [2 p_i sum_j V_j w_ij x_ij - (1 - sum_j V_j w_ij x_ij (x) x_ij) grad p_i]`, the sums over its
//! own body and the fluid,
//!
//! which is the pressure force of a fluid that fills the rest of the support, for a pressure that is linear
//! in space. The force of a uniform pressure on a closed surface is zero for any arrangement of particles,
//! and that of a fluid at rest is its buoyancy. The particles of the other body receive the opposite.

mod fill;

mod gap;

mod moments;

mod seepage;

mod share;

mod system;

pub use system::GapPressure;
