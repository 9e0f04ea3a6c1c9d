//! The engine of `meshless`: particles are hecs entities with component columns, systems run in stages.
//!
//! The data flow is scene -> world -> schedule -> systems -> recording. Imports between the modules go down one list, which a test holds them to
//! (`LAYERS` in `tests/architecture.rs`).
//!
//! Conventions that hold everywhere: SI units, three-dimensional vectors (a two-dimensional scene is plane strain in
//! x-y with z = 0), pair vectors point from i to j, `x_ij = x_j - x_i`, and the pair weight is
//! `w_ij = |W'(r)| / r > 0`, so that `grad_i W = w_ij x_ij`.

extern crate self as meshless_engine;

pub use bytemuck;
pub use glam;
pub use schemars;
pub use serde;

pub mod assembly;
pub mod boundaries;
pub mod contact;
pub mod correction;
pub mod fields;
mod files;
pub mod formulations;
pub mod integrate;
pub mod invariants;
pub mod kernels;
pub mod linalg;
pub mod materials;
pub mod neighbors;
pub mod notation;
pub mod pair;
pub mod parallel;
pub mod plugin;
pub mod record;
pub mod removal;
pub mod rigid;
pub mod scene;
pub mod schedule;
pub mod shapes;
pub mod simulation;
mod skins;
pub mod solids;
pub mod space;
pub mod symmetry;
pub mod world;
