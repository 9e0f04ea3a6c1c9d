//! Contact between two bodies.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::{BodyDescription, Item};

/// A contact between two bodies.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Contact {
    /// The names of the two bodies; the same name twice is contact of a body with itself. `"grain*"` stands
    /// for all bodies whose names begin with `grain`: `("grain*", "floor")` is each of them with the floor,
    /// `("grain*", "grain*")` each with each other. `("*", "*")` is each solid, rigid body and wall with each
    /// other, without fluids, on which bodies act by the flow, and without walls among themselves.
    pub between: (String, String),
    /// The contact law, force against overlap of the surfaces: `Penalty`, `Hertz`.
    #[serde(default = "penalty")]
    pub law: Item,
    /// Coulomb's coefficient of friction \[-\].
    #[serde(default)]
    pub friction: f64,
    /// Coefficient of restitution \[-\]: ratio of the normal velocities after and before an impact of rigid
    /// bodies; at 1 the contact has no dashpot. Between deformable bodies the dashpot is that of the two
    /// particles in contact, and waves in the bodies carry away energy too.
    #[serde(default = "elastic")]
    pub restitution: f64,
    /// Fraction of the frictional heat that goes into the first of the two bodies, 0 to 1; the rest goes into
    /// the second. It heats the particles in contact, or those that carry the contact surface, of bodies
    /// whose material has a specific heat. Without it friction does not heat the bodies.
    #[serde(default)]
    pub friction_heat: Option<f64>,
    /// Contact surface of deformable bodies.
    #[serde(default)]
    pub surface: ContactSurface,
}

/// Contact surface of deformable bodies.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
pub enum ContactSurface {
    /// The surface of the shape, as facets that move with the particles. `Particles` is used instead for
    /// bodies whose surface has no facets, for contact with a `Wall`, for an Eulerian body or one that a
    /// symmetry plane cuts with itself, and for a body that can fail once a particle of the surface has
    /// failed.
    #[default]
    Skin,
    /// Each particle, as an ellipsoid: a sphere with a radius of half a spacing, mapped by the deformation
    /// gradient.
    Particles,
}

fn penalty() -> Item {
    Item::bare("Penalty")
}

impl Contact {
    /// Whether `between` names this body itself, and not by the beginning of its name.
    pub fn states(&self, body: &str) -> bool {
        self.between.0 == body || self.between.1 == body
    }

    /// The pairs of bodies that `between` stands for, by their numbers, each once.
    pub(super) fn pairs(&self, bodies: &[BodyDescription]) -> Vec<[usize; 2]> {
        let meant =
            |name: &str| -> Vec<bool> { bodies.iter().map(|body| is_meant(name, &body.name)).collect() };
        let (is_first, is_second) = (meant(&self.between.0), meant(&self.between.1));
        let is_itself = self.between.0 == self.between.1 && !self.between.0.ends_with(ANY);
        let mut pairs = Vec::new();
        for a in (0..bodies.len()).filter(|&a| is_first[a]) {
            for b in (0..bodies.len()).filter(|&b| is_second[b]) {
                let came_before = b < a && is_first[b] && is_second[a];
                if (a != b || is_itself) && !came_before {
                    pairs.push([a, b]);
                }
            }
        }
        pairs
    }
}

/// Wildcard for the rest of a name; no name contains it.
pub(super) const ANY: char = '*';

/// Whether `name` in a scene refers to the body `body`: the same name, or its beginning followed by a star.
pub(super) fn is_meant(name: &str, body: &str) -> bool {
    name.strip_suffix(ANY).map_or(name == body, |start| body.starts_with(start))
}

const fn elastic() -> f64 {
    1.0
}
