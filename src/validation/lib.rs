//! Validation cases: scenes with known answers, run through the real engine and compared.
//!
//! A case is a scene in `tests/validation/<case>/`, whose resolution and few parameters are set as by
//! `--set`, and one file here, which defines the measured values and their references. `meshless validate`
//! runs the cases and prints the table; the tests run each at its cheapest meaningful resolution.

mod case;
mod check;
mod contact;
mod coupled;
mod exact;
mod fluids;
mod measure;
mod solids;
pub mod sweep;
mod template;

pub use case::{CASES, Case};
pub use check::{Check, ConvergenceRate, Tolerance, at_no_spacing};
pub use template::Template;
