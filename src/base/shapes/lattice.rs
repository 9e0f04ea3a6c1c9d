//! The arrangement of particles inside a shape.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// How particles are laid out inside a shape. With every layout a particle takes spacing^2 (two dimensions)
/// or spacing^3 (three) of the shape on average, and the volumes add up to that of the shape.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub enum Lattice {
    /// `Regular`; in a scene with a fluid `Concentric` for discs, rings, cylinders and tubes, and
    /// `BodyFitted()` for all others with faces that do not lie between two layers of the regular lattice:
    /// oblique and curved ones, whose steps would brake the fluid, and those that cut through cells.
    #[default]
    Automatic,
    /// Cell centres of a square (two dimensions) or cubic (three) lattice that tiles the bounding box of the
    /// shape. `Square` and `Cubic` are other names for it.
    #[serde(alias = "Square", alias = "Cubic")]
    Regular,
    /// Densest packing: rows of triangles along x in two dimensions, hexagonal close packing (hcp, layers
    /// ABAB along z) in three. Nearest neighbours are 1.075 (two dimensions) or 1.122 (three) spacings apart.
    Hexagonal,
    /// Rings about the axis of a disc, ring, cylinder or tube, shells about the centre of a solid or hollow
    /// sphere; each ring or shell is divided into parts of equal volume. A `Difference` of two such shapes
    /// about one centre or axis is one of them.
    Concentric,
    /// Regular inside, and layers that follow the boundary of any shape: the outermost particles are half a
    /// spacing from it, along holes and inclined sides as well. Stresses there are smooth, where those of
    /// other lattices have steps. Every particle has the volume of its own cell.
    BodyFitted {
        /// Steps of Lloyd's method: the more, the more even the particles near the boundary.
        #[serde(default = "default_fitting")]
        iterations: u32,
    },
    /// Irregular: random points that keep a minimum distance, moved to the centroids of their Voronoi cells
    /// (Lloyd's method). Every particle has the volume of its own cell.
    Relaxed {
        /// Number from which the random points are drawn: the same seed gives the same particles.
        #[serde(default)]
        seed: u64,
        /// Steps of Lloyd's method: the more, the more even the particles.
        #[serde(default = "default_iterations")]
        iterations: u32,
    },
}

impl Lattice {
    /// `BodyFitted` with its default.
    pub(super) const fn body_fitted() -> Self {
        Self::BodyFitted { iterations: default_fitting() }
    }
}

const fn default_fitting() -> u32 {
    20
}

const fn default_iterations() -> u32 {
    6
}
