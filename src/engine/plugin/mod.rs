//! Extension of the engine: the registry that resolves names of scenes, and the builder that plugins use.

mod builder;
mod contact_pairs;
mod distances;
mod error;
mod handed;
mod offers;
mod plan;
mod prescription;
mod registry;
mod scope;
mod selection;
mod setup;
mod touching_pairs;
mod traits;

pub use builder::SimBuilder;
pub(crate) use contact_pairs::contact_pairs;
pub use distances::Distances;
pub(crate) use distances::FOLLOWED;
pub use error::SetupError;
pub use handed::ForBodies;
pub use offers::{BodyKind, Offer};
pub use plan::{BodyPlan, HeldSide, SideHold};
pub use prescription::{MotionOfPlace, Prescription};
pub(crate) use registry::FormulationEntry;
pub use registry::{Entry, EntryKind, Registry};
pub use selection::Selection;
pub use setup::Setup;
pub use touching_pairs::TouchingPairs;
pub use traits::{Formulation, Plugin, Support};
