//! The spatial dimension, and points and vectors of scenes.

mod dimension;
mod vec3;

pub use dimension::Dimension;
pub use vec3::Vec3;
