//! All fields of a simulation, and the lookup of a field by its name.

use super::field::Field;
use super::{deformation, motion, stress};
use crate::plugin::{BodyKind, SimBuilder};
use crate::world::{BodySet, ColumnSet};

/// Columns and kinds that decide which fields the particles of a body have.
pub(super) struct BodyColumns {
    pub name: String,
    kind: BodyKind,
    columns: ColumnSet,
}

/// The field of the table that a body has.
#[derive(Clone, Copy)]
pub(super) struct BodyField(pub usize);

/// All fields of a simulation.
pub struct FieldTable {
    pub(super) fields: Vec<Field>,
    pub(super) bodies: Vec<BodyColumns>,
}

/// Name, unit and number of components.
type Shape<'a> = (&'a str, &'static str, &'static [&'static str]);

impl FieldTable {
    /// Collects the fields of plugins, then derived ones, then the columns: the first that fits a body is
    /// used.
    pub fn collect(sim: &mut SimBuilder<'_>) -> Self {
        let mut fields: Vec<Field> = sim.take_extensions();
        fields.extend(motion::fields());
        fields.extend(deformation::fields());
        fields.extend(stress::fields());
        let bodies: Vec<BodyColumns> = sim
            .bodies()
            .iter()
            .map(|body| BodyColumns {
                name: body.name.clone(),
                kind: body.kind,
                columns: sim.columns(body.phase).clone(),
            })
            .collect();
        let mut all = ColumnSet::default();
        bodies.iter().for_each(|body| all.extend(&body.columns));
        fields.extend(all.iter().map(|column| Field::column(*column)));
        Self { fields, bodies }
    }

    /// Names of the fields that at least one of the bodies has.
    pub fn names(&self, among: &BodySet) -> Vec<&str> {
        let has = |field: &Field| {
            among.iter().any(|id| field.fits(self.bodies[id.0].kind, &self.bodies[id.0].columns))
        };
        let mut names: Vec<&str> =
            self.fields.iter().filter(|field| has(field)).map(|field| field.name()).collect();
        names.sort_unstable();
        names.dedup();
        names
    }

    pub(super) fn field(&self, field: BodyField) -> &Field {
        &self.fields[field.0]
    }

    pub(super) fn find(&self, name: &str, body: usize) -> Option<usize> {
        let BodyColumns { kind, columns, .. } = &self.bodies[body];
        self.fields.iter().position(|field| field.name() == name && field.fits(*kind, columns))
    }

    pub(super) fn shape(&self, k: usize) -> Shape<'_> {
        let field = &self.fields[k];
        (field.name(), field.unit(), field.components())
    }
}

/// All fields that particles with these columns have.
pub(crate) fn named(columns: &ColumnSet) -> Vec<Field> {
    let derived = motion::fields().into_iter().chain(deformation::fields()).chain(stress::fields());
    let all = derived.chain(columns.iter().map(|column| Field::column(*column)));
    all.collect()
}
