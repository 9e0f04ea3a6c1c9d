//! The fields that scenes may name.

use super::spawn::standard_columns;
use crate::fields::named;
use crate::plugin::Registry;
use crate::world::ColumnSet;

/// Name and unit of the fields that probes and recordings may ask for, as far as the bodies have them; plugins may add more.
pub fn fields(registry: &Registry) -> Vec<(String, &'static str)> {
    let mut columns = ColumnSet::default();
    standard_columns(&mut columns);
    registry.formulations().for_each(|entry| (entry.columns)(&mut columns));
    let mut fields = named(&columns);
    fields.sort();
    fields.dedup();
    fields
}
