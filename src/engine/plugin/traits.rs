//! The traits behind the names of a scene.

use schemars::JsonSchema;
use serde::de::DeserializeOwned;

use super::builder::SimBuilder;
use super::distances::Distances;
use super::error::SetupError;
use super::offers::{BodyKind, Offer};
use super::plan::BodyPlan;
use crate::kernels::KernelName;
use crate::scene::{Edge, Select};
use crate::world::{BodyId, ColumnSet};

/// Particles that a condition holds, or moves by prescription.
#[derive(Clone, Copy, Debug)]
pub struct Support<'a> {
    /// Particles.
    pub on: &'a Select,
    /// Axes along which their motion is prescribed.
    pub axes: [bool; 3],
    /// Where the held part of a body ends.
    pub edge: Edge,
}

/// A plugin or a condition, named in scenes; its fields are its parameters, with units in their
/// documentation.
///
/// Derive `Deserialize` with `deny_unknown_fields`, and `JsonSchema`.
pub trait Plugin: DeserializeOwned + JsonSchema + 'static {
    /// Name in scenes.
    const NAME: &'static str;
    /// Source of the method, printed in the run log.
    const REFERENCE: &'static str;

    /// Whether it wraps the laws of materials. Such plugins are built before the others, which read the laws,
    /// wherever they are in the scene.
    const CHANGES_MATERIALS: bool = false;

    /// The particles that it holds. Held particles beside free ones are moved to the edge of the held part
    /// before anything else uses them.
    fn support(&self) -> Option<Support<'_>> {
        None
    }

    /// Adds systems, terms, columns, diagnostics and limits of the time step.
    fn build(self, sim: &mut SimBuilder<'_>) -> Result<(), SetupError>;
}

/// A formulation: the columns of its particles and the systems that compute their rates.
pub trait Formulation: DeserializeOwned + JsonSchema + 'static {
    /// Name in scenes.
    const NAME: &'static str;
    /// Source of the method.
    const REFERENCE: &'static str;
    /// Kind of its bodies for the rest of a scene.
    const KIND: BodyKind;
    /// Terms that it accepts for its bodies from plugins, conditions and contacts. Any other request is an
    /// error of the scene.
    const OFFERS: &'static [Offer];

    /// Memory of a particle in columns, neighbours and packed rows while a run starts, B: more particles than
    /// fit are an error of the scene. The default is that of a total-Lagrangian body in three dimensions.
    const BYTES_PER_PARTICLE: usize = 1600;

    /// Mean support radius of the particles of a body, m; none where these have no neighbours of their own.
    fn support(&self, _body: &BodyPlan) -> Option<f64> {
        None
    }

    /// Kernel of the weights by which it fits deformation gradients; none if it does so by other means.
    fn kernel(&self) -> Option<KernelName> {
        None
    }

    /// The distances from which the weights of a body follow.
    fn distances(&self, _body: &BodyPlan) -> Distances {
        Distances::Reference
    }

    /// Adds the columns that its particles have beside position, velocity, force, mass and mobility.
    fn columns(columns: &mut ColumnSet);

    /// Adds the systems of all bodies of this formulation, given in scene order.
    fn assemble(bodies: Vec<(BodyId, Self)>, sim: &mut SimBuilder<'_>) -> Result<(), SetupError>;
}
