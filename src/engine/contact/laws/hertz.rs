//! The law of Hertz.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::law::{ContactLaw, ContactPair, NormalForce, Spring, Touch};
use crate::materials::ParameterError;
use crate::scene::Dimension;

/// Contact of elastic spheres: f = 4/3 E* sqrt(R) d^(3/2), with 1/R = 1/R1 + 1/R2. In two dimensions there is
/// no such law of the overlap alone; the force of the sphere is spread over its radius, f = 4/3 E* sqrt(d/R)
/// d per metre of thickness.
#[derive(Clone, Debug, Default, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct Hertz {
    /// Modulus E* \[Pa\]. Default: from the materials.
    pub modulus: Option<f64>,
    /// The force in two dimensions.
    pub plane: PlaneForce,
}

/// The force of Hertz in two dimensions.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Deserialize, Serialize, JsonSchema)]
pub enum PlaneForce {
    /// The force of a sphere over its radius, per metre of thickness.
    #[default]
    OverRadius,
    /// The force of one sphere, taken for that of a metre of thickness, as in Ganzenmueller 2015. It depends
    /// on the spacing, and is so soft at usual ones that bodies pass through each other.
    Sphere,
}

impl ContactLaw for Hertz {
    const NAME: &'static str = "Hertz";
    const REFERENCE: &'static str = "contact: K. L. Johnson, Contact Mechanics (1985)";

    fn build(self, pair: &ContactPair) -> Result<Box<dyn NormalForce>, ParameterError> {
        let modulus = self.modulus.map_or_else(|| pair.modulus_or("modulus"), Ok)?;
        ParameterError::require_positive("modulus", modulus)?;
        let over_radius = pair.dimension == Dimension::Two && self.plane == PlaneForce::OverRadius;
        Ok(Box::new(Sphere { modulus, over_radius }))
    }
}

/// f = c d^(3/2).
struct Sphere {
    modulus: f64,
    over_radius: bool,
}

impl Sphere {
    fn coefficient(&self, radius: f64) -> f64 {
        let sphere = 4.0 / 3.0 * self.modulus * radius.sqrt();
        if self.over_radius { sphere / radius } else { sphere }
    }
}

impl NormalForce for Sphere {
    fn at(&self, touch: &Touch) -> Spring {
        let (c, d) = (self.coefficient(touch.radius), touch.overlap);
        let root = c * d.sqrt();
        Spring { force: root * d, stiffness: 1.5 * root, energy: 0.4 * root * d * d }
    }

    fn stiffness_of_impact(&self, touch: &Touch, mass: f64, speed: f64) -> f64 {
        // The energy 2/5 c d^(5/2) at the deepest point is what the motion had.
        let c = self.coefficient(touch.radius);
        let deepest = (1.25 * mass * speed * speed / c).powf(0.4);
        1.5 * c * deepest.sqrt()
    }

    /// With the dashpot proportional to d^(1/4), the motion in the variables d^(5/4) and the integral of
    /// d^(1/4) dt is that of a linear spring and dashpot (Antypov and Elliott, Europhys. Lett. 94 (2011)
    /// 50004).
    fn damping_factor(&self) -> f64 {
        (5.0_f64 / 6.0).sqrt()
    }
}
