//! The trait of a contact law: a normal force as a function of the overlap.

use schemars::JsonSchema;
use serde::de::DeserializeOwned;

use crate::materials::ParameterError;
use crate::scene::{ContactSurface, Dimension};

/// Two bodies in contact, as far as a law depends on them.
#[derive(Clone, Copy, Debug)]
pub struct ContactPair {
    /// Plane strain or three dimensions: in plane strain forces are per metre of thickness.
    pub dimension: Dimension,
    /// Whether the contact is one of surfaces or of particles.
    pub surface: ContactSurface,
    /// E*, Pa: `1/E* = (1 - nu_1^2)/E_1 + (1 - nu_2^2)/E_2`; infinite where neither body has a modulus.
    pub modulus: f64,
}

impl ContactPair {
    /// E*, Pa. An error that requires the parameter of that name where neither body has a modulus.
    pub fn modulus_or(&self, field: &'static str) -> Result<f64, ParameterError> {
        if self.modulus.is_finite() {
            return Ok(self.modulus);
        }
        let message = format!("neither body has a modulus that `{field}` could follow from");
        Err(ParameterError::new(
            field,
            message,
            format!("give `{field}`, or one of the bodies an elastic material"),
        ))
    }
}

/// Where two surfaces overlap.
#[derive(Clone, Copy, Debug)]
pub struct Touch {
    /// Depth of the overlap d, m; positive. Between deforming particles it is measured in the reference
    /// configuration.
    pub overlap: f64,
    /// Radius of a sphere on a plane with the same gap, `1/R = 1/R_1 + 1/R_2`, m.
    pub radius: f64,
    /// Length that the contact represents, m: the distance of the centres of two particles at first contact.
    pub length: f64,
    /// Overlap at which the centre of a particle is at the surface, or those of two at one place, m; infinite
    /// between rigid bodies.
    pub depth: f64,
}

/// The elastic part of a normal force.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Spring {
    /// Force, N.
    pub force: f64,
    /// Tangent stiffness d force / d overlap, N/m.
    pub stiffness: f64,
    /// Energy stored, J.
    pub energy: f64,
}

impl Spring {
    /// The spring as a function of a coordinate of which `scale` is d(overlap)/d(coordinate).
    #[inline]
    pub(in crate::contact) fn along(self, scale: f64) -> Self {
        let Self { force, stiffness, energy } = self;
        Self { force: scale * force, stiffness: scale * scale * stiffness, energy }
    }

    /// The spring times a factor, such as an area.
    #[inline]
    pub(in crate::contact) fn scaled(self, factor: f64) -> Self {
        let Self { force, stiffness, energy } = self;
        Self { force: factor * force, stiffness: factor * stiffness, energy: factor * energy }
    }
}

/// An elastic normal force. Damping and friction are added to any law from its tangent stiffness.
pub trait NormalForce: Send + Sync {
    /// The force at an overlap. It must be zero at zero overlap and increase with it.
    fn at(&self, touch: &Touch) -> Spring;

    /// The tangent stiffness at the deepest point of an impact, N/m: of a mass, kg, at a speed, m/s. The
    /// overlap of `touch` is not used.
    fn stiffness_of_impact(&self, touch: &Touch, mass: f64, speed: f64) -> f64;

    /// Factor g of the law, such that the dashpot `2 zeta g sqrt(stiffness mass)` has the restitution of a
    /// linear spring with damping ratio zeta.
    fn damping_factor(&self) -> f64 {
        1.0
    }
}

/// A contact law as a scene names it: its fields are its parameters.
pub trait ContactLaw: DeserializeOwned + JsonSchema + 'static {
    /// Name in scenes.
    const NAME: &'static str;
    /// Source of the law.
    const REFERENCE: &'static str;

    /// Checks the parameters and creates the force between two bodies. An error if a parameter is out of its
    /// range.
    fn build(self, pair: &ContactPair) -> Result<Box<dyn NormalForce>, ParameterError>;
}
