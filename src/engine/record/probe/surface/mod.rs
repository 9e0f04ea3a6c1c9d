//! Stress at surfaces of solids.
//!
//! A particle of the outermost layer has neighbours on one side only. Its deformation gradient is exact where
//! displacements are linear; where strains vary, the fit is that of a place deeper in the body, by
//!
//! ```text
//! s_i = n (tr(Q_i M_i^-1) - n . Q_i M_i^-1 n) / (d - 1) ,   Q_i = sum_j V_j w_ij (X_ij . n) X_ij (x) X_ij
//! ```
//!
//! with the inward normal n: of the displacement `u = X_n X_t t` it finds the slope `Q_tt / M_tt`, which is
//! that of s. A quarter of a spacing with the usual kernels, and next to nothing in the second layer. The
//! strain along the normal is the one that balances the forces of the lattice, and not that of the body.
//! The stress at the surface is therefore extrapolated from the places X_i + s_i, and its part on the normal,
//! sigma n, is replaced by the traction on the surface at a constant strain along it: stresses along the
//! surface change by lambda / (lambda + 2 mu) of what changes along the normal.
//!
//! The traction is that of the forces from outside on the particles that carry the surface, and the pressure
//! of fluids there. That holds where
//! such forces are those of a traction, nothing holds the surface, and the material there is elastic.

mod internal_force;
mod measured;
mod points;
mod shifts;
#[cfg(test)]
mod tests;
mod traction;

pub use internal_force::ForceOfBody;
pub(in crate::record) use internal_force::add_system;
pub(super) use measured::MeasuredPoints;
pub(super) use points::SurfacePoints;
