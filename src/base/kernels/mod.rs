//! Smoothing kernels W(r, h).
//!
//! A kernel is a profile f(q), q = r / h, scaled to unit integral: `W(r, h) = sigma_d / h^d f(r / h)`.
//! Profiles are written in the *smoothing length* h. W is exactly zero at and beyond the *support radius* H =
//! SUPPORT x h. Derivatives are with respect to r; the pair weight is `w = |W'(r)| / r >= 0`, so that `grad_i
//! W = w x_ij` with `x_ij = x_j - x_i`.
//!
//! A new kernel needs one file with its [`KernelProfile`] and one line in `registry.rs`.

mod cubic_spline;
mod kernel;
mod profile;
mod profiled;
mod quartic_spline;
mod quintic_spline;
mod registry;
mod spiky;
#[cfg(test)]
mod tests;
mod wendland_c2;
mod wendland_c4;
mod wendland_c6;

pub use cubic_spline::CubicSpline;
pub use kernel::Kernel;
pub use profile::KernelProfile;
pub use profiled::{ProfiledKernel, ScaledKernel};
pub use quartic_spline::QuarticSpline;
pub use quintic_spline::QuinticSpline;
pub use registry::{KernelName, KernelVisitor};
pub use spiky::Spiky;
pub use wendland_c2::WendlandC2;
pub use wendland_c4::WendlandC4;
pub use wendland_c6::WendlandC6;
