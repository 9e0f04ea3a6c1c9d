//! Ends of walls.
//!
//! Part of the kernel of a fluid particle beside a wall is filled by the wall, `g_i = sum_w V_w w_iw x_iw`
//! being the gradient of that part. Where the wall ends and empty space begins, a particle that moves past
//! the end loses it: by continuity its density would fall, by up to a half, though nothing expands. In a jet
//! from a slot voids opened behind the lips, and it lost a seventh of its energy there. A free surface moves
//! with the fluid, so that only motion normal to the face along which the fluid has come is an expansion.
//! With the part of g_i along that face, t_i, and the same, s_i, of the gradient of all that fills the
//! kernel, `u_i = sum_j V_j w_ij x_ij` over fluids and boundaries, the rate of compression of the fluid
//! leaves out
//!
//! `sum_w V_w w_iw (P v_iw).x_iw`, `P = clamp(t_i.s_i / t_i.t_i, 0, 1) T_i`
//!
//! which is zero where space is filled (u = 0), as at the corner of a box in a flow, and along a wall that
//! continues (t = 0). The force of its pressure on the wall, `p_i V_i V_w w_iw P x_iw`, is left out likewise,
//! so that both remain each other's adjoint: a particle at the end of a wall is pushed along the normal
//! alone.
//!
//! `T = e^2 (M^2 + e^2 I)^-1`, `M = sum_k c_k n_k (x) n_k` projects onto the faces in front of the fluid
//! particles k nearby, with normals n_k and e a tenth of the trace of M. Beside a concave corner nothing is
//! along all faces. Particles whose foot is on an edge of the shape have no face: behind a lip the normal is
//! that of the face before it.
//!
//! Walls with suction have no empty space beside them. Bodies are left out: the force is not central, and its
//! couple would need a reaction.

mod edges;
mod faces;
mod forces;
mod normals;
mod system;

pub use system::WallEnds;
