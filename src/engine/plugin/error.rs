//! Errors of building a plugin, a condition or a formulation.

use thiserror::Error;

use crate::materials::ParameterError;
use crate::scene::{Item, Problem};
use crate::world::BodyId;

/// A fault found while the scene is made into a simulation.
#[derive(Clone, Debug, Error, PartialEq, Eq)]
pub enum SetupError {
    /// A parameter is out of its range, or requires something that does not exist.
    #[error("{message}")]
    Parameter {
        /// Path of the parameter within the item, such as `alpha` or `on.body`; empty for the item as a
        /// whole.
        field: String,
        /// The finding.
        message: String,
        /// The correction.
        help: String,
    },
    /// Faults that already know their place in the scene.
    #[error("{} problems in the scene", .0.len())]
    Problems(Vec<Problem>),
}

impl SetupError {
    /// A fault at a parameter of the item.
    pub fn parameter(field: impl Into<String>, message: impl Into<String>, help: impl Into<String>) -> Self {
        Self::Parameter { field: field.into(), message: message.into(), help: help.into() }
    }

    /// A fault of the engine or of a plugin, not of the scene.
    pub fn internal(error: &dyn std::error::Error) -> Self {
        Self::parameter("", error.to_string(), "this is a fault of the program, not of the scene")
    }

    /// The fault at a parameter of the formulation of one body: formulations are assembled for all of their
    /// bodies at once.
    pub fn of_formulation(self, id: BodyId) -> Self {
        let Self::Parameter { field, message, help } = self else { return self };
        let dot = if field.is_empty() { "" } else { "." };
        Self::Parameter { field: format!("bodies[{}].formulation{dot}{field}", id.0), message, help }
    }

    /// The problems with their place, `item` being what was built.
    pub(crate) fn into_problems(self, item: &Item) -> Vec<Problem> {
        match self {
            Self::Parameter { field, message, help } => vec![item.problem(&field, message, help)],
            Self::Problems(problems) => problems,
        }
    }
}

impl From<ParameterError> for SetupError {
    fn from(error: ParameterError) -> Self {
        Self::Parameter { field: error.field.to_owned(), message: error.message, help: error.help }
    }
}
