//! The active contacts among the candidates of a step, with their histories and forces, and the sums of the
//! forces on particles.

mod minimum_length;

mod filter;

mod contacts;

mod nodes;

pub(super) use contacts::ActiveContacts;
pub(super) use filter::Filter;
pub(super) use minimum_length::MinimumLength;
pub(super) use nodes::{ContactEnd, ContactNodes, NodeLoad};
