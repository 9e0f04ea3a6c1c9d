//! Named fields of particles, for recordings, ParaView files and probes: every column by its name, and fields
//! derived from columns. A group of derived fields is one file; a plugin adds a field with
//! [`SimBuilder::add_field`].
//!
//! [`SimBuilder::add_field`]: crate::plugin::SimBuilder::add_field

mod chosen;
mod deformation;
mod field;
mod motion;
mod rows;
mod stress;
mod table;

pub use chosen::ChosenField;
pub use field::{Field, FieldInput};
pub use rows::FieldColumns;
pub(crate) use stress::{cauchy, is_of_stress};
pub use table::FieldTable;
pub(crate) use table::named;

#[cfg(test)]
mod tests;
