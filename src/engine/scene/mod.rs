//! The scene: the description of an experiment as a RON text, read into typed values with errors that point at the text.

mod vec3;

pub use vec3::Vec3;
