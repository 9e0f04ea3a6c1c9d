//! Probes of wear: the volume removed from a body, and the roughness of its surface.

mod pieces;
mod removed_volume;
mod resolve;
mod roughness;
#[cfg(test)]
mod tests;

pub(super) use resolve::resolve;
