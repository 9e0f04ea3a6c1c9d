//! A body: a shape filled with particles of one material.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::{Item, Vec3};
use crate::shapes::{Lattice, Shape};

/// A shape filled with particles of one material, which move by one formulation.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, rename = "Body")]
pub struct BodyDescription {
    /// Name by which conditions, contacts, probes and files refer to the body.
    pub name: String,
    /// Name of one of the scene's materials. The name is ignored for a `Wall`, which has none.
    pub material: String,
    /// The shape that the body initially occupies.
    pub shape: Shape,
    /// Distance between neighbouring particles \[m\].
    pub spacing: f64,
    /// How the material moves: `TotalLagrangian`, `UpdatedLagrangian`, `Eulerian`, `Fluid`, `Rigid`, `Wall`.
    pub formulation: Item,
    /// Initial velocity of all particles \[m/s\].
    #[serde(default)]
    pub velocity: Option<Vec3>,
    /// Plugins for this body alone.
    #[serde(default)]
    pub plugins: Vec<Item>,
    /// The arrangement of the particles.
    #[serde(default)]
    pub lattice: Lattice,
}
