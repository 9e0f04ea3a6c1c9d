//! Skins: the surface of a body, meshed once and carried by its particles.
//!
//! The surface is that of the shape, in facets: segments of half a spacing in two dimensions, triangles of
//! about a spacing in three. A vertex at X in the reference configuration is at
//!
//! ```text
//! x = sum_j s_j [x_j + F_j (X - X_j)],      s_j ~ (1 - |X - X_j|/R)^3,  sum s_j = 1
//! ```
//!
//! the Shepard mean of the linear fields of nearby particles, with R = 2.1 spacings: linearly exact, without
//! matrices. The weights are computed once. A force f on a vertex returns by the exact transpose: s_j f on
//! the particles, and s_j f (x) (X - X_j) as couples that the pass of the internal force distributes.
//! Momentum, angular momentum and energy of any load that acts through a skin are therefore exact by
//! construction.
//!
//! In bodies whose kernels live in the present configuration the shares follow the deformation.
//!
//! A skin uses positions and deformation gradients of its particles, and nothing else of their formulation.

mod carriers;
mod columns;
mod facet_selection;
mod following;
mod heat;
mod patch;
mod rule;
mod scale;
mod selected_facet;
mod skin;
#[cfg(test)]
pub(crate) mod tests;
mod vertex;

pub(crate) use columns::{SkinColumns, SkinView};
pub(crate) use facet_selection::selected_facets;
pub(crate) use patch::{Last, Patch, Wanted};
pub(crate) use rule::QuadratureRule;
pub(crate) use selected_facet::SelectedFacet;
pub(crate) use skin::Skin;
pub(crate) use vertex::Vertex;
