//! Edges between walls.
//!
//! At the edge of a piston the fluid also presses on the particles of the adjacent wall, and along the motion
//! of the piston these are at rest: the piston had 0.93 of the pressure at 8 across, and a gate beside the
//! floor likewise. At such edges every particle of a wall therefore moves as the faces around it do, along
//! the normal of each. With the faces k before the fluid particles near particle w, their normals n_k,
//! velocities v_k and weights c_k,
//!
//! `v*_w = (sum_k c_k n_k (x) n_k + c_w I)^-1 (sum_k c_k n_k (n_k.v_k) + c_w v_w)`
//!
//! takes the place of v_w in the rate of compression. It is v_w where all faces around belong to its own
//! wall, and where faces do not separate it is their common motion, for any angle between them. The force is
//! the adjoint: from the force f_w of pressure on w, face k takes `c_k n_k (n_k.q_w)` with q_w = (...)^-1
//! f_w, and c_w q_w stays. Their sum is f_w, and the power of all is that of f_w with v*_w.
//!
//! Rigid and deformable bodies count as walls. A gap beside a rigid one has its pressure normal to the gap
//! alone: along it, the force on the particles at the edge of the face is the one that is found here from the
//! other side. Between two bodies that forces move there are no edges: the force would be handed over along
//! another line.
//!
//! Beside walls without suction the rate of compression keeps v_w. Fluid that goes along a wall is compressed
//! by the particles of the wall ahead of it and expands by those behind, alike. With v* for the latter, that
//! in the corner ahead of a piston would be compressed as the piston goes on, by more the smaller the spacing
//! (1.5 and 3.3 times the pressure ahead of one that pushes a bore, 8 and 16 deep). Beside walls with suction
//! the adjoint of the force on those ahead (`wall_compression`) restores the balance. Without suction, the
//! work of f_w on v*_w - v_w is not that of a compressed fluid: all of it is booked as that of boundaries.
//!
//! This holds for particles that are behind the face of another wall, with a weight of one half where such a
//! face ends in the middle of a particle's spacing. If the fluid ends at a right angle, the particles behind
//! the plane of a face together carry, along its normal, the force of a fluid without a corner; beside a
//! piston between two parallel walls the errors of other angles cancel.

mod forces;
mod fronts;
mod motion;

pub use forces::EdgeForces;
pub use fronts::WallShapes;
pub use motion::EdgeMotion;
