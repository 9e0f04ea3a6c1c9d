//! Two bodies that touch.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::Item;

/// Two bodies that touch, and how.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Contact {
    /// The names of the two bodies; twice the same name is contact of a body with itself.
    pub between: (String, String),
    /// How the force follows from the overlap of the surfaces: `Penalty`, `Hertz`.
    pub law: Item,
    /// Coulomb's coefficient of friction \[-\].
    #[serde(default)]
    pub friction: f64,
    /// Ratio of the normal velocities after and before an impact of rigid bodies \[-\]; at 1 the contact has no
    /// dashpot. Between deformable bodies the dashpot is that of the two particles that touch, beside what waves in the bodies
    /// take along.
    #[serde(default = "elastic")]
    pub restitution: f64,
    /// With what deformable bodies touch.
    #[serde(default)]
    pub surface: ContactSurface,
}

/// With what deformable bodies touch.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
pub enum ContactSurface {
    /// The surface of the shape, carried along by the particles. Bodies of which it is not known in facets, bodies that may fail, those that
    /// symmetry planes cut and those of periodic domains, contact of a body with itself and with a `Wall` fall back to `Particles`.
    #[default]
    Skin,
    /// Each particle, as the ellipsoid that its deformation makes of a sphere of half a spacing.
    Particles,
}

const fn elastic() -> f64 {
    1.0
}
