//! Surfaces in flat facets: segments in two dimensions, triangles in three, with outward normals, about as long as asked for.

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
