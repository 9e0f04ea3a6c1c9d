//! `meshless`: particle simulation of solids, fluids and their interaction by smoothed particle
//! hydrodynamics.
//!
//! A scene is described in RON, run by the `meshless` program, and its recording is looked at in the rerun
//! viewer. What the program cannot do is added in Rust: a plugin, a material, a condition or a formulation is
//! a type that is registered under a name, and scenes then use the name. A program with an addition of its
//! own is
//!
//! ```no_run
//! # mod my_plugin { pub fn register(_: &mut meshless::prelude::Registry) {} }
//! fn main() -> std::process::ExitCode {
//!     meshless::cli::run(meshless::standard_plugins().with(my_plugin::register))
//! }
//! ```
//!
//! This package is the facade: it re-exports the engine, adds the standard plugins and the command line.

pub use meshless_engine::*;

pub mod cli;
pub mod prelude;

use plugin::Registry;

/// All names that the `meshless` program knows: those of the engine, and the standard plugins.
pub fn standard_plugins() -> Registry {
    Registry::standard()
        .with(hourglass_control::register)
        .with(hessian_stabilization::register)
        .with(local_damping::register)
        .with(artificial_viscosity::register)
        .with(density_diffusion::register)
        .with(particle_shifting::register)
        .with(tensile_control::register)
        .with(xsph::register)
        .with(failure::register)
        .with(remove_fragments::register)
        .with(heat_conduction::register)
        .with(rerun_recorder::register)
}

/// The code of the recipes, compiled with the tests of the documentation.
#[cfg(doctest)]
mod recipes {
    #[doc = include_str!("../docs/add-a-boundary-condition.md")]
    mod boundary_condition {}
    #[doc = include_str!("../docs/add-a-contact-law.md")]
    mod contact_law {}
    #[doc = include_str!("../docs/add-a-kernel.md")]
    mod kernel {}
    #[doc = include_str!("../docs/add-a-material.md")]
    mod material {}
    #[doc = include_str!("../docs/add-a-plugin.md")]
    mod plugin {}
    #[doc = include_str!("../docs/add-a-system.md")]
    mod system {}
}
