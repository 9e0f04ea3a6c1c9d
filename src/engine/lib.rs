//! The engine of `meshless`: particles are hecs entities with component columns, systems run in stages.
//!
//! The data flow is scene -> world -> schedule -> systems -> recording. A module imports only from modules
//! below it in one list, which a test checks (`LAYERS` in `tests/architecture/imports.rs`).
//!
//! Conventions that hold everywhere: SI units, three-dimensional vectors (a two-dimensional scene is plane
//! strain in x-y with z = 0), pair vectors point from i to j, `x_ij = x_j - x_i`, and the pair weight is
//! `w_ij = |W'(r)| / r > 0`, so that `grad_i W = w_ij x_ij`.

extern crate self as meshless_engine;

pub use bytemuck;
pub use glam;
#[doc(inline)]
pub use meshless_base::{
    correction, kernels, linalg, neighbors, notation, parallel, ranks, scene, shapes, space,
};
pub use schemars;
pub use serde;

pub mod assembly;
pub mod boundaries;
pub mod contact;
pub mod fields;
pub mod formulations;
pub mod integrate;
pub mod invariants;
pub mod materials;
pub mod pair;
pub mod plugin;
pub mod record;
pub mod removal;
pub mod rigid;
pub mod schedule;
pub mod simulation;
mod skins;
pub mod solids;
pub mod symmetry;
pub mod world;
