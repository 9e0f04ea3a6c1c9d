//! Extension of the engine: the registry that resolves names of scenes, and the builder that plugins use.

mod builder;
mod error;
mod facet_part;
mod facet_selection;
mod handed;
mod offers;
mod plan;
mod prescription;
mod registry;
mod scope;
mod selection;
mod setup;
mod traits;

pub use builder::SimBuilder;
pub use error::SetupError;
pub(crate) use facet_part::FacetPart;
pub(crate) use facet_selection::facet_parts;
pub use handed::ForBodies;
pub use offers::{BodyKind, Offer};
pub use plan::{BodyPlan, HeldSide};
pub use prescription::{MotionOfPlace, Prescription};
pub(crate) use registry::FormulationEntry;
pub use registry::{Entry, EntryKind, Registry};
pub use selection::Selection;
pub use setup::Setup;
pub use traits::{Formulation, Plugin, Support};
