//! Errors of the contact system.

use crate::schedule::StepError;

/// Label of the system that computes the forces of contact.
pub const CONTACT: &str = "contact";

/// An error of that system.
pub(in crate::contact) fn failed(message: impl ToString) -> StepError {
    StepError::System { system: CONTACT.to_owned(), message: message.to_string() }
}
