//! Probes of wear: what has been taken off a body, and how rough it is.

mod removed_volume;
mod resolve;
mod roughness;
#[cfg(test)]
mod tests;

pub(super) use resolve::resolve;
