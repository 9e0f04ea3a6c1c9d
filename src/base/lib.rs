//! The base modules of the engine of `meshless`: linear algebra, parallel loops, kernels, neighbour search,
//! shapes, and the scene language.
//!
//! Nothing here depends on particle columns, systems or formulations. The package `meshless_engine`
//! re-exports all of it, and extensions depend on that package alone. The two are compiled in parallel.

pub mod correction;
mod files;
pub mod kernels;
pub mod linalg;
pub mod neighbors;
pub mod notation;
pub mod parallel;
pub mod ranks;
pub mod scene;
pub mod shapes;
pub mod space;
