//! Errors in a shape, a spacing or a particle file.

use glam::DVec3;
use thiserror::Error;

use super::mesh_fault::MeshFault;
use crate::notation::{digits, number};

/// Error of filling a shape with particles or using it as a selection.
#[derive(Debug, Error)]
#[error("{path}: {kind}{}", .kind.help().map_or(String::new(), |help| format!("; {help}")))]
pub struct FillError {
    /// Path of the wrong field, relative to the body: `spacing`, `shape.max`, `shape[0].radius` (an argument
    /// without a name), `shape[0][2]` (an element of a list).
    pub path: String,
    /// The kind of error.
    pub kind: FillErrorKind,
}

impl FillError {
    pub(super) fn new(path: impl Into<String>, kind: FillErrorKind) -> Self {
        Self { path: path.into(), kind }
    }

    /// The error, preceded by the name of the field for a requirement on one number.
    pub fn message(&self) -> String {
        match self.kind {
            FillErrorKind::NotPositive(_) => {
                let field = self.path.rsplit('.').next().unwrap_or_default();
                format!("`{field}` {}", self.kind)
            }
            _ => self.kind.to_string(),
        }
    }
}

/// Errors of a field of a shape, or of the particles that would fill it.
#[derive(Debug, Error)]
#[non_exhaustive]
pub enum FillErrorKind {
    /// Infinite or not a number.
    #[error("expected a finite number, found {0}")]
    NotFinite(f64),
    /// Zero or negative where a positive number is required.
    #[error("must be greater than 0, found {}", number(*.0))]
    NotPositive(f64),
    /// Two ends in the wrong order, or equal.
    #[error("the lower end of the {axis} range must be below the upper end, found {min} and {max}")]
    EmptyRange {
        /// Name of the axis.
        axis: char,
        /// Lower end \[m\].
        min: f64,
        /// Upper end \[m\].
        max: f64,
    },
    /// A hole at least as wide as the body.
    #[error("the inner radius {inner} m must be less than the outer radius {outer} m")]
    Radii {
        /// Radius of the hole \[m\].
        inner: f64,
        /// Outer radius \[m\].
        outer: f64,
    },
    /// Two ends of an axis coincide.
    #[error("`from` and `to` are the same point")]
    NoLength,
    /// A z coordinate in two dimensions.
    #[error("z must be left out or 0 in two dimensions, found {0}")]
    NotFlat(f64),
    /// A three-dimensional shape in a two-dimensional scene, or the reverse.
    #[error("`{shape}` is a shape of {needs} dimensions only")]
    WrongDimension {
        /// Name of the shape.
        shape: &'static str,
        /// The required dimensions, `two` or `three`.
        needs: &'static str,
        /// The replacement.
        instead: &'static str,
    },
    /// A polygon with too few corners.
    #[error("a polygon needs at least 3 points, found {0}")]
    FewPoints(usize),
    /// A polygon with an edge of zero length.
    #[error("points {0} and {1} of the polygon (counted from 0) are the same")]
    EqualPoints(usize, usize),
    /// A polygon that crosses or touches itself.
    #[error(
        "the polygon crosses or touches itself: the edges that start at points {0} and {1} (counted from 0) meet"
    )]
    Crossing(usize, usize),
    /// A combination without parts.
    #[error("needs at least one shape")]
    NoShapes,
    /// A normal of zero length.
    #[error("the normal must not be a zero vector")]
    NoNormal,
    /// An unbounded shape for a body of particles.
    #[error("the shape is unbounded and cannot be filled with particles")]
    Unbounded,
    /// A shape whose nearest surface points have no closed form.
    #[error("a tool needs a surface with known nearest points: {0}")]
    NoSurface(&'static str),
    /// A rotation axis of zero length.
    #[error("the axis must not be a zero vector")]
    NoAxis,
    /// A rotation out of the plane.
    #[error("in two dimensions the axis must be along z")]
    AxisNotZ,
    /// A particle file where a region is needed.
    #[error("a particle file encloses no region")]
    NoInside,
    /// A lattice that does not fit the shape.
    #[error("a concentric lattice does not fit this shape")]
    NotConcentric,
    /// A relaxation with too many iterations.
    #[error("expected at most {limit} iterations, found {found}")]
    Iterations {
        /// The value in the scene.
        found: u32,
        /// The allowed maximum.
        limit: u32,
    },
    /// The shape is empty.
    #[error("the shape is empty: no particle of spacing {0} m lies in it")]
    NoParticle(f64),
    /// A section thinner than two particles.
    #[error("the body must be at least 2 spacings thick along {direction}, found {}", number(.thickness / .spacing))]
    Thin {
        /// Name of the direction: `x`, `y`, `z`, `the axis` or `the radius`.
        direction: &'static str,
        /// Thickness of the body in this direction \[m\].
        thickness: f64,
        /// Spacing of the particles \[m\].
        spacing: f64,
    },
    /// More particles than the limit of the caller.
    #[error("the body needs {}, more than the {} that fit into memory", particles(*.estimate), digits(*.limit as u64))]
    TooMany {
        /// Estimated number of particles.
        estimate: f64,
        /// Allowed number of particles.
        limit: usize,
    },
    /// A particle file or mesh that cannot be opened.
    #[error("cannot read `{file}`: {source}")]
    File {
        /// Path of the file.
        file: String,
        /// Error of the system.
        source: std::io::Error,
    },
    /// A mesh that does not bound a solid.
    #[error("`{file}`: {fault}")]
    Mesh {
        /// Path of the file.
        file: String,
        /// The fault.
        fault: MeshFault,
    },
    /// A mesh too small or too large for the spacing, most likely because of its unit.
    #[error(
        "the mesh measures {:.3e} x {:.3e} x {:.3e} m, which is {:.3e} spacings of {spacing} m in the longest direction",
        .extent.x, .extent.y, .extent.z, .extent.max_element() / .spacing
    )]
    MeshSize {
        /// Sides of the bounding box of the mesh \[m\].
        extent: DVec3,
        /// Spacing of the particles \[m\].
        spacing: f64,
    },
    /// Particles of a file that are inconsistent with each other or with the spacing.
    #[error("`{file}`: {message}")]
    Particles {
        /// Path of the file.
        file: String,
        /// The requirement and what was found.
        message: String,
    },
    /// A particle file with invalid content.
    #[error("`{file}`, line {line}: {message}")]
    Csv {
        /// Path of the file.
        file: String,
        /// Line, counted from 1.
        line: u64,
        /// The finding and the correction.
        message: String,
    },
}

impl FillErrorKind {
    /// The correction, where the message does not say it.
    pub fn help(&self) -> Option<String> {
        Some(match self {
            Self::WrongDimension { instead, .. } => format!("use {instead}"),
            Self::EqualPoints(..) => {
                "leave one of them out; the first point is not repeated at the end".into()
            }
            Self::EmptyRange { axis: 'z', min: 0.0, max: 0.0 } => "a point with two components has z = 0".into(),
            Self::NoInside => {
                "it can fill a body, but not be combined with shapes, select particles, or be a rigid body or tool".into()
            }
            Self::Unbounded => "cut it with others: `Intersection([Box(...), HalfSpace(...)])`".into(),
            Self::NoSurface(_) => {
                "a single shape has them, moved, turned or equally scaled; so has a stretched sphere, a mesh, a `Union` of \
                 shapes that are apart, and a `Difference` whose hole is all inside; draw the outline of others as a `Polygon` (in space as an `Extrusion` or a `Mesh`), or use several tools"
                    .into()
            }
            Self::NotConcentric => {
                "it fits `Sphere`, `Ring`, `Cylinder`, `Tube` and `Shell`, and a `Difference` of two of them about one centre or \
                 axis; use `BodyFitted` or `Regular` here"
                    .into()
            }
            Self::Thin { thickness, .. } => {
                format!("use a spacing of at most {} m", rounded_down(thickness / 2.0))
            }
            Self::Mesh { fault, .. } => fault.help().into(),
            Self::MeshSize { .. } => {
                "mesh files do not record their unit: `scale: 0.001` reads millimetres; or change the spacing".into()
            }
            Self::TooMany { .. } => "use a larger spacing".into(),
            _ => return None,
        })
    }
}

/// An estimated number of particles.
fn particles(estimate: f64) -> String {
    match estimate {
        _ if estimate < 1e9 => format!("about {} particles", digits(estimate as u64)),
        _ if estimate.is_finite() => format!("about {} particles", number(estimate)),
        _ => "too many particles to count".into(),
    }
}

/// The value rounded down to three digits.
fn rounded_down(value: f64) -> f64 {
    let shown = |value: f64| format!("{value:.2e}").parse().unwrap_or(value);
    // Round-off of the thickness must not change 0.05 to 0.0499.
    let nearest: f64 = shown(value);
    if nearest <= value * (1.0 + 1e-9) { nearest } else { shown(value * 0.995) }
}
