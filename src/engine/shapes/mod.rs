//! Shapes and how particles fill them: what a scene writes under `shape`, `lattice` and `spacing`.

mod lattice;
mod shape;

pub use lattice::Lattice;
pub use shape::Shape;

#[cfg(test)]
mod tests;
