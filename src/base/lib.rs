//! What the engine of `meshless` stands on: linear algebra, parallel loops, kernels, neighbour search,
//! shapes, and the language of scenes.
//!
//! Nothing here knows particles with columns, systems or formulations. The package `meshless_engine` passes
//! all of it on; who extends the program depends on that one alone. The two are compiled one beside the
//! other.

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
