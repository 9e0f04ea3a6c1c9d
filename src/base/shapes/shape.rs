//! The shapes of a scene as they are written there; `Shape::region` turns them into checked geometry.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::space::Vec3;

/// The shape of a body or of a selection. Lengths are in metres; in two dimensions z is left out (or 0).
///
/// A shape includes its boundary. The last arguments of a boolean combination or transform may themselves be
/// combinations or transforms.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub enum Shape {
    /// Box along the axes; a rectangle in two dimensions.
    Box {
        /// Corner with the smallest coordinates \[m\].
        min: Vec3,
        /// Corner with the largest coordinates \[m\].
        max: Vec3,
    },
    /// Sphere; a disc in two dimensions.
    Sphere {
        /// Centre \[m\].
        center: Vec3,
        /// Radius \[m\].
        radius: f64,
    },
    /// The region behind a plane; behind a line in two dimensions. It is unbounded: it can cut other shapes,
    /// select particles, and be a tool (a `Rigid` body whose motion is prescribed), but no particles fill it,
    /// and fluids do not interact with it.
    HalfSpace {
        /// A point of the plane \[m\].
        point: Vec3,
        /// Direction out of the half-space, at right angles to the plane, of any length \[-\].
        normal: Vec3,
    },
    /// Circular cylinder with flat ends (three dimensions; in two use `Sphere` or `Box`).
    Cylinder {
        /// Centre of one end \[m\].
        from: Vec3,
        /// Centre of the other end \[m\].
        to: Vec3,
        /// Radius \[m\].
        radius: f64,
    },
    /// Region between two concentric circles (two dimensions; in three use `Tube`).
    Ring {
        /// Centre \[m\].
        center: Vec3,
        /// Radius of the hole \[m\].
        inner: f64,
        /// Outer radius \[m\].
        outer: f64,
    },
    /// Hollow circular cylinder (three dimensions; in two use `Ring`).
    Tube {
        /// Centre of one end \[m\].
        from: Vec3,
        /// Centre of the other end \[m\].
        to: Vec3,
        /// Radius of the bore \[m\].
        inner: f64,
        /// Outer radius \[m\].
        outer: f64,
    },
    /// Hollow sphere (three dimensions; in two use `Ring`).
    Shell {
        /// Centre \[m\].
        center: Vec3,
        /// Radius of the cavity \[m\].
        inner: f64,
        /// Outer radius \[m\].
        outer: f64,
    },
    /// Polygon that does not cross itself (two dimensions; in three use `Extrusion`).
    Polygon {
        /// Corners (x, y) in order, either way round; the first is not repeated at the end \[m\].
        points: Vec<(f64, f64)>,
    },
    /// Prism: a polygon in x-y drawn out along z (three dimensions).
    Extrusion {
        /// Corners (x, y) of the polygon in order, either way round \[m\].
        polygon: Vec<(f64, f64)>,
        /// Lower end, z coordinate \[m\].
        from: f64,
        /// Upper end, z coordinate \[m\].
        to: f64,
    },
    /// The inside of a closed triangle mesh (three dimensions).
    Mesh {
        /// STL file (ASCII or binary) or OBJ file. Relative to the scene's folder.
        file: String,
        /// Length of one unit of the file; 0.001 for a file in millimetres \[m\].
        #[serde(default = "one")]
        scale: f64,
    },
    /// Union of the shapes. The lattice of the first one continues through all.
    Union(Vec<Shape>),
    /// The first shape without the second. The lattice is that of the first one.
    Difference(Box<Shape>, Box<Shape>),
    /// Intersection of the shapes. The lattice is that of the first one.
    Intersection(Vec<Shape>),
    /// The shape moved, its lattice with it.
    Translate {
        /// The shape to move.
        shape: Box<Shape>,
        /// Displacement \[m\].
        by: Vec3,
    },
    /// The shape turned, its lattice with it.
    Rotate {
        /// The shape to rotate.
        shape: Box<Shape>,
        /// Direction of the axis, of any length; z in two dimensions \[-\].
        #[serde(default = "z_axis")]
        axis: Vec3,
        /// Angle, counter-clockwise seen against the axis \[degrees\].
        angle_degrees: f64,
        /// A point of the axis \[m\].
        #[serde(default)]
        about: Vec3,
    },
    /// The shape stretched along the axes. The spacing stays as it is. A rigid body or tool may be a sphere
    /// with unequal factors, an ellipsoid; other shapes need equal ones there.
    Scale {
        /// The shape to stretch.
        shape: Box<Shape>,
        /// Factors along x, y, z; z is not used in two dimensions \[-\].
        by: Vec3,
        /// The point that stays where it is \[m\].
        #[serde(default)]
        about: Vec3,
    },
    /// Particles from a file, in place of a lattice. Their surface is not known: loads, contact and supports
    /// by `face` act on the outermost ones.
    Points {
        /// CSV file with the header `x,y,volume` or `x,y,z,volume`, in m and m^3 (two dimensions: m^2);
        /// further columns are ignored. Relative to the scene's folder.
        file: String,
    },
}

const fn one() -> f64 {
    1.0
}

const fn z_axis() -> Vec3 {
    Vec3::new(0.0, 0.0, 1.0)
}
