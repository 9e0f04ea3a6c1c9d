//! How things are added to the engine: the registry that scenes are resolved with, and the builder that plugins see.

mod build;
mod builder;
mod error;
mod memory;
mod names;
mod options;
mod overlap;
mod plan;
mod registry;
mod selection;
mod setup;
mod spawn;
#[cfg(test)]
mod tests;
mod traits;

pub use build::{build, build_with};
pub use builder::SimBuilder;
pub use error::SetupError;
pub use options::{BuildOptions, OutputOptions};
pub use plan::BodyPlan;
pub use registry::{Entry, Kind, Registry};
pub use selection::Selection;
pub use setup::Setup;
pub use traits::{Formulation, Plugin};
