//! A spring that hardens with the penetration of a particle.

use schemars::JsonSchema;
use serde::Deserialize;

use super::law::{ContactLaw, ContactPair, NormalForce, Spring, Touch};
use crate::materials::ParameterError;
use crate::scene::{ContactSurface, Dimension};

/// Spring between surfaces: f = k d (1 + b (d/D)^2) with the depth d of the overlap, and D that at which the
/// centre of a particle is at the surface, so that pressures of the order of the modulus do not push it
/// through; between rigid bodies f = k d. The stiffness follows from the materials: in three dimensions k =
/// 2.5 E* l, with l the spacing, for every l^2 of the surface; in two k = 2.5 E* per metre of thickness for
/// every l of it. Where particles touch, k = 1.5 E* of each. 1/E* = (1 - nu1^2)/E1 + (1 - nu2^2)/E2.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct Penalty {
    /// Stiffness of a contact \[N/m; N/m per metre of thickness in two dimensions\]. Default: from the
    /// materials.
    pub stiffness: Option<f64>,
    /// Factor on the stiffness that follows from the materials \[-\].
    pub factor: f64,
    /// Share b of the stiffness by which the spring hardens; 0 is a linear spring.
    pub hardening: f64,
}

/// k over E* per metre of thickness where particles touch: two equal bodies give way like one and a third
/// spacings of them. With less an impact lasts longer (S22), with more a contact that is a few particles wide
/// becomes narrower (C1).
const OF_PARTICLES: f64 = 1.5;
/// The same where surfaces touch, which are not narrower for it: the interface gives way like .4 spacings of
/// either body. With less, thin bodies that are pressed are too soft (S4), with more the steps are short.
const OF_SURFACES: f64 = 2.5;

impl Default for Penalty {
    fn default() -> Self {
        Self { stiffness: None, factor: 1.0, hardening: 10.0 }
    }
}

impl ContactLaw for Penalty {
    const NAME: &'static str = "Penalty";
    const REFERENCE: &'static str = "";

    fn build(self, pair: &ContactPair) -> Result<Box<dyn NormalForce>, ParameterError> {
        ParameterError::require_positive("factor", self.factor)?;
        ParameterError::require_not_negative("hardening", self.hardening)?;
        let hardening = self.hardening;
        if let Some(stiffness) = self.stiffness {
            ParameterError::require_positive("stiffness", stiffness)?;
            return Ok(Box::new(OverlapHardening { constant: stiffness, per_length: 0.0, hardening }));
        }
        let stiffness = if pair.surface == ContactSurface::Skin { OF_SURFACES } else { OF_PARTICLES };
        let modulus = stiffness * self.factor * pair.modulus_or("stiffness")?;
        Ok(Box::new(match pair.dimension {
            Dimension::Two => OverlapHardening { constant: modulus, per_length: 0.0, hardening },
            Dimension::Three => OverlapHardening { constant: 0.0, per_length: modulus, hardening },
        }))
    }
}

/// k = constant + per_length l.
struct OverlapHardening {
    constant: f64,
    per_length: f64,
    hardening: f64,
}

impl OverlapHardening {
    fn stiffness(&self, touch: &Touch) -> f64 {
        self.constant + self.per_length * touch.length
    }
}

impl NormalForce for OverlapHardening {
    fn at(&self, touch: &Touch) -> Spring {
        let (k, d) = (self.stiffness(touch), touch.overlap);
        let harder = self.hardening * (d / touch.depth).powi(2);
        Spring {
            force: k * d * (1.0 + harder),
            stiffness: k * (1.0 + 3.0 * harder),
            energy: 0.5 * k * d * d * (1.0 + 0.5 * harder),
        }
    }

    fn stiffness_of_impact(&self, touch: &Touch, mass: f64, speed: f64) -> f64 {
        // With q = (d/D)^2 at the deepest point, k D^2/2 (q + b/2 q^2) is the energy m v^2/2 that the motion
        // had.
        let k = self.stiffness(touch);
        let energy = mass * (speed / touch.depth).powi(2) / k;
        let harder = (1.0 + 2.0 * self.hardening * energy).sqrt() - 1.0;
        k * (1.0 + 3.0 * harder)
    }
}
