//! A selection of particles.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::Vec3;
use super::contact::is_meant;
use crate::shapes::Shape;

/// The particles that meet all given criteria, at their initial positions. Without any criterion: all.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Select {
    /// Those of the body with this name; `"grain*"` stands for all bodies whose names begin with `grain`.
    #[serde(default)]
    pub body: Option<String>,
    /// Those within this shape; a load or a probe of a `surface`, and a load on a `face`, ends at its border.
    #[serde(default)]
    pub within: Option<Shape>,
    /// The outermost layer of each body on this side.
    #[serde(default)]
    pub face: Option<Face>,
    /// Of the particles that meet the other criteria, the one nearest to this point \[m\].
    #[serde(default)]
    pub nearest: Option<Vec3>,
    /// For loads and probes of fields: this part of the surface of the body.
    #[serde(default)]
    pub surface: Option<SurfacePart>,
}

impl Select {
    /// Whether the selection can contain particles of the body with this name.
    pub fn means(&self, body: &str) -> bool {
        self.body.as_ref().is_none_or(|name| is_meant(name, body))
    }
}

/// A part of the surface of a body.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub enum SurfacePart {
    /// The whole surface.
    All,
    /// The parts that face away from the body.
    Outer,
    /// The parts that face the body itself or its image across a symmetry plane or a period: holes, bores,
    /// the sides of notches. The bottom of an open notch faces away; `Of` the shape that was cut out has it
    /// too.
    Inner,
    /// The part that lies on the surface of this shape, such as the cylinder with which a hole was cut.
    Of(Shape),
    /// The part whose normal is within 45 degrees of this direction.
    Facing(Vec3),
}

/// A side of a body along a coordinate axis.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
pub enum Face {
    /// The side of minimum x.
    MinX,
    /// The side of maximum x.
    MaxX,
    /// The side of minimum y.
    MinY,
    /// The side of maximum y.
    MaxY,
    /// The side of minimum z.
    MinZ,
    /// The side of maximum z.
    MaxZ,
}

impl Face {
    /// Axis and sign of the outward normal.
    pub const fn outward(self) -> (usize, f64) {
        match self {
            Self::MinX => (0, -1.0),
            Self::MaxX => (0, 1.0),
            Self::MinY => (1, -1.0),
            Self::MaxY => (1, 1.0),
            Self::MinZ => (2, -1.0),
            Self::MaxZ => (2, 1.0),
        }
    }
}
