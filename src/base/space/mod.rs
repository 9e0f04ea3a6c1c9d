//! The words of space that everything else uses: its dimension, and points as scenes write them.

mod dimension;
mod vec3;

pub use dimension::Dimension;
pub use vec3::Vec3;
