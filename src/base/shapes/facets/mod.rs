//! Surfaces of flat facets with outward normals, of about the requested length: segments in two dimensions,
//! triangles in three.

mod coarse;
mod contour;
mod cut;
mod facet;
mod grids;
mod outline;
mod refine;
mod round;
#[cfg(test)]
mod tests;

pub use facet::{Facets, directed_area};
