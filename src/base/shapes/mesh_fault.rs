//! Defects of a mesh.

use glam::DVec3;
use thiserror::Error;

use crate::notation::{count, place};

/// Why a file is not a mesh, or its mesh does not bound a solid. Positions are in the coordinates of the
/// scene \[m\].
#[derive(Debug, Error)]
#[non_exhaustive]
pub enum MeshFault {
    /// The file name ends neither in `.stl` nor in `.obj`.
    #[error("the name ends neither in `.stl` nor in `.obj`")]
    Extension,
    /// A text that is not STL, or a binary file of the wrong length.
    #[error(
        "not an STL file: expected the word `solid` or a binary file of {expected} bytes, found {size} bytes"
    )]
    NotStl {
        /// Length of the file in bytes.
        size: usize,
        /// Size of a binary file with its number of triangles, in bytes.
        expected: u64,
    },
    /// A line that cannot be read.
    #[error("line {line}: {message}")]
    Line {
        /// Line, counted from 1.
        line: usize,
        /// The finding and the correction.
        message: String,
    },
    /// A coordinate that is infinite or not a number.
    #[error("a coordinate of triangle {0} (counted from 0) is not a finite number")]
    NotFinite(usize),
    /// A file without a non-degenerate triangle.
    #[error("the file has no triangle")]
    NoTriangle,
    /// Edges with a triangle on one side only.
    #[error("the mesh is open: a triangle is on one side only at {}, the first at {} m", count(*edges as u64, "edge"), place(*at))]
    Open {
        /// Number of such edges.
        edges: usize,
        /// Middle of the first one \[m\].
        at: DVec3,
    },
    /// Edges with more than two triangles.
    #[error("more than two triangles meet at {} of the mesh, the first at {} m", count(*edges as u64, "edge"), place(*at))]
    Crowded {
        /// Number of such edges.
        edges: usize,
        /// Middle of the first one \[m\].
        at: DVec3,
    },
    /// Neighbouring triangles with inconsistent orientation.
    #[error("the triangles on the two sides face opposite ways at {}, the first at {} m", count(*edges as u64, "edge"), place(*at))]
    Orientation {
        /// Number of such edges.
        edges: usize,
        /// Middle of the first one \[m\].
        at: DVec3,
    },
    /// Triangles that intersect.
    #[error("the mesh intersects itself: {pairs} pairs of triangles cross, the first at {} m", place(*at))]
    Crossing {
        /// Number of intersecting pairs of triangles.
        pairs: usize,
        /// Centroid of the first intersected triangle \[m\].
        at: DVec3,
    },
    /// A closed mesh of zero volume.
    #[error("the mesh encloses no volume")]
    NoVolume,
}

impl MeshFault {
    /// The correction.
    pub(super) fn help(&self) -> &'static str {
        match self {
            Self::Extension => "export the part as STL (ASCII or binary) or as OBJ",
            Self::NotStl { .. } => "export the part again; a transfer as text destroys binary files",
            Self::Line { .. } | Self::NotFinite(_) | Self::NoTriangle => "export the part again",
            Self::Open { .. } => {
                "close the holes where the mesh was made: a solid has two triangles at each edge"
            }
            Self::Crowded { .. } => {
                "parts that share an edge or a face must be joined, or be bodies of their own"
            }
            Self::Orientation { .. } => "let the normals be made consistent where the mesh was made",
            Self::Crossing { .. } => "unite the parts where the mesh was made",
            Self::NoVolume => "check that the triangles bound a solid",
        }
    }
}
