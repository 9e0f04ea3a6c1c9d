//! A linear spring.

use schemars::JsonSchema;
use serde::Deserialize;

use super::law::{ContactLaw, ContactPair, NormalForce, Spring, Touch};
use crate::materials::ParameterError;
use crate::scene::Dimension;

/// Linear spring between surfaces: f = k d with the depth d of the overlap. The stiffness follows from the materials: in
/// three dimensions k = E* l, with l the distance of two particles that just touch; in two k = E* per metre of
/// thickness, whatever the spacing. 1/E* = (1 - nu1^2)/E1 + (1 - nu2^2)/E2.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct Penalty {
    /// Stiffness of a contact \[N/m; N/m per metre of thickness in two dimensions\]. Default: from the materials.
    pub stiffness: Option<f64>,
    /// Factor on the stiffness that follows from the materials \[-\].
    pub factor: f64,
}

impl Default for Penalty {
    fn default() -> Self {
        Self { stiffness: None, factor: 1.0 }
    }
}

impl ContactLaw for Penalty {
    const NAME: &'static str = "Penalty";
    const REFERENCE: &'static str = "";

    fn build(self, pair: &ContactPair) -> Result<Box<dyn NormalForce>, ParameterError> {
        ParameterError::require_positive("factor", self.factor)?;
        if let Some(stiffness) = self.stiffness {
            ParameterError::require_positive("stiffness", stiffness)?;
            return Ok(Box::new(Linear { constant: stiffness, per_length: 0.0 }));
        }
        let modulus = self.factor * pair.modulus_or("stiffness")?;
        Ok(Box::new(match pair.dimension {
            Dimension::Two => Linear { constant: modulus, per_length: 0.0 },
            Dimension::Three => Linear { constant: 0.0, per_length: modulus },
        }))
    }
}

/// k = constant + per_length l.
struct Linear {
    constant: f64,
    per_length: f64,
}

impl Linear {
    fn stiffness(&self, touch: &Touch) -> f64 {
        self.constant + self.per_length * touch.length
    }
}

impl NormalForce for Linear {
    fn at(&self, touch: &Touch) -> Spring {
        let (k, d) = (self.stiffness(touch), touch.overlap);
        Spring { force: k * d, stiffness: k, energy: 0.5 * k * d * d }
    }

    fn stiffness_of_impact(&self, touch: &Touch, _: f64, _: f64) -> f64 {
        self.stiffness(touch)
    }
}
