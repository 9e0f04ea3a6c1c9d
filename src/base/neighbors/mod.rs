//! Neighbour lists.
//!
//! Particle j is in row i when `|x_ij| < (H_i + H_j) / 2 + skin`, with `x_ij = x_j - x_i` to the nearest
//! periodic image and H the support radius. Lists are full (a pair is in both rows), rows are in ascending
//! order and a particle is never its own neighbour. A list depends on positions, supports and skin alone, not
//! on the number of threads or the previous content of its buffers.
//!
//! There are two uses. [`NeighborList::reference`] is built once (total Lagrangian). [`VerletList`], within
//! one set of particles or between two (fluid and solid), is rebuilt when a particle has moved more than half
//! the skin.

mod axis;
mod beside;
mod buckets;
mod cells;
mod cloud;
mod error;
mod grid;
mod list;
mod parting;
mod periodic;
mod rows;
mod search;
#[cfg(test)]
mod tests;
mod verlet;

pub use beside::CellBlock;
pub use buckets::Buckets;
pub use cells::sort_into_cells;
pub use cloud::{Cloud, SupportRadii};
pub use cloud::{PointBounds, bounds};
pub use error::NeighborError;
pub use list::NeighborList;
pub use parting::{RelativeBounds, RelativeDisplacements};
pub use periodic::Periodic;
pub use periodic::SHIFT;
pub use search::{Boxes, FirstOfCloud, NeighborSearch};
pub use verlet::VerletList;
