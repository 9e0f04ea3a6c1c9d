//! Shapes and their filling with particles: the fields `shape`, `lattice` and `spacing` of a scene.

mod block;
mod boolean;
mod build;
mod by_distance;
mod cavity;
mod cells;
mod check;
mod concentric;
mod cylinder;
mod difference;
mod error;
mod facets;
mod fill;
mod fitted;
mod half_space;
mod images;
mod lattice;
mod mesh;
mod mesh_fault;
mod moments;
mod morton;
mod openings;
mod points;
mod polygon;
mod quadrature;
mod region;
mod relaxed;
mod ring;
mod rings;
mod shape;
mod shell;
mod site;
mod sphere;
mod stretched_sphere;
mod surface;
mod tiling;
mod transform;
mod voronoi;

pub use by_distance::ByDistance;
pub use error::{FillError, FillErrorKind};
pub use facets::{Facets, directed_area};
pub use fill::{Filling, fill};
pub use images::images_near;
pub use lattice::Lattice;
pub use mesh_fault::MeshFault;
pub use moments::Moments;
pub use morton::{MortonSort, morton_order};
pub use quadrature::counted_moments;
pub use region::{Aabb, Region, normal};
pub use rings::Rings;
pub use shape::Shape;
pub use site::Site;
pub use surface::{Surface, SurfacePoint};

#[cfg(test)]
mod tests;
