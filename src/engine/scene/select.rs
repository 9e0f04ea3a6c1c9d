//! A selection of particles.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::Vec3;
use crate::shapes::Shape;

/// The particles that meet all criteria that are given, in their places at the start. Without any criterion: all.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Select {
    /// Those of the body with this name.
    #[serde(default)]
    pub body: Option<String>,
    /// Those within this shape.
    #[serde(default)]
    pub within: Option<Shape>,
    /// The outermost layer of each body on this side.
    #[serde(default)]
    pub face: Option<Face>,
    /// The one particle, of those that meet the other criteria, that is nearest to this point \[m\].
    #[serde(default)]
    pub nearest: Option<Vec3>,
}

/// A side of a body along a coordinate axis.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
pub enum Face {
    /// The side of smallest x.
    MinX,
    /// The side of largest x.
    MaxX,
    /// The side of smallest y.
    MinY,
    /// The side of largest y.
    MaxY,
    /// The side of smallest z.
    MinZ,
    /// The side of largest z.
    MaxZ,
}
