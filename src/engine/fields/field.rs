//! A named field of particles.

use std::ops::Range;

use super::rows::FieldColumns;
use crate::linalg::Sym3;
use crate::plugin::{BodyKind, SimBuilder};
use crate::schedule::Resources;
use crate::world::{BodyId, ColumnInfo, ColumnSet, MissingColumn, Value, World};

/// The particles whose field is wanted.
pub struct FieldInput<'a> {
    /// Columns and bodies.
    pub world: &'a World,
    /// Shared data of systems.
    pub resources: &'a Resources,
    /// The body.
    pub body: BodyId,
    /// Rows of the body's phase, all of the body.
    pub rows: Range<usize>,
}

/// A function of the Cauchy stress, Pa, that appends its components.
pub(super) type OfStress = dyn Fn(&Sym3, &mut Vec<f64>) + Send + Sync;

type Evaluate = dyn Fn(&FieldInput<'_>, &mut Vec<f64>) -> Result<(), MissingColumn> + Send + Sync;

/// A named field: a number, vector or tensor for each particle that has the columns it needs.
pub struct Field {
    name: String,
    unit: &'static str,
    about: &'static str,
    components: &'static [&'static str],
    needs: Vec<&'static str>,
    kind: Option<BodyKind>,
    evaluate: Box<Evaluate>,
    of_stress: Option<Box<OfStress>>,
}

impl Field {
    /// A field that is a function of columns of the same particle. Name and unit are those of recordings; the
    /// value is a number, a vector or a matrix.
    ///
    /// ```
    /// use meshless_engine::record::Field;
    /// use meshless_engine::world::{Mass, Velocity};
    ///
    /// Field::new::<(Mass, Velocity), f64>("kinetic_energy", "J", |(m, v)| 0.5 * m.0 * v.0.length_squared());
    /// ```
    pub fn new<Q: FieldColumns, V: Value>(
        name: impl Into<String>,
        unit: &'static str,
        f: impl for<'r> Fn(Q::Row<'r>) -> V + Send + Sync + 'static,
    ) -> Self {
        let evaluate = move |input: &FieldInput<'_>, out: &mut Vec<f64>| {
            let (phase, _) = input.world.body_view(input.body);
            Q::evaluate(&phase, input.rows.clone(), &f, out)
        };
        Self::with_input(name, unit, V::COMPONENTS, Q::names(), evaluate)
    }

    /// A field that depends on more than the particle's own columns: `evaluate` appends the components row by
    /// row. `components` are their names, `[""]` for a number; `needs` names the columns without which there
    /// is no field.
    pub fn with_input(
        name: impl Into<String>,
        unit: &'static str,
        components: &'static [&'static str],
        needs: Vec<&'static str>,
        evaluate: impl Fn(&FieldInput<'_>, &mut Vec<f64>) -> Result<(), MissingColumn> + Send + Sync + 'static,
    ) -> Self {
        let evaluate = Box::new(evaluate);
        Self { name: name.into(), unit, about: "", components, needs, kind: None, evaluate, of_stress: None }
    }

    /// The field that is this function of the Cauchy stress.
    pub(super) fn with_stress<V: Value>(mut self, f: impl Fn(&Sym3) -> V + Send + Sync + 'static) -> Self {
        self.of_stress = Some(Box::new(move |stress, out| {
            let value = f(stress);
            out.extend((0..V::COMPONENTS.len()).map(|k| value.component(k)));
        }));
        self
    }

    /// What it is for a Cauchy stress, if it is a function of that alone.
    pub(super) fn of_stress(&self) -> Option<&OfStress> {
        self.of_stress.as_deref()
    }

    /// The field that a column is.
    pub(super) fn column(column: ColumnInfo) -> Self {
        let evaluate = move |input: &FieldInput<'_>, out: &mut Vec<f64>| {
            let (phase, _) = input.world.body_view(input.body);
            let (start, width) = (out.len(), column.components.len());
            out.resize(start + input.rows.len() * width, 0.0);
            let mut values = Vec::with_capacity(input.rows.len());
            for k in 0..width {
                values.clear();
                phase.component(&column, input.rows.clone(), k, &mut values);
                for (row, value) in out[start..].chunks_exact_mut(width).zip(&values) {
                    row[k] = *value;
                }
            }
            Ok(())
        };
        let needs = vec![column.name];
        Self::with_input(column.name, column.unit, column.components, needs, evaluate).about(column.about)
    }

    /// The same field with a line of description for lists.
    #[must_use]
    pub fn about(mut self, text: &'static str) -> Self {
        self.about = text;
        self
    }

    /// The same field for bodies of one kind only.
    #[must_use]
    pub fn only_for(mut self, kind: BodyKind) -> Self {
        self.kind = Some(kind);
        self
    }

    /// Name.
    pub fn name(&self) -> &str {
        &self.name
    }

    /// Unit, SI; `1` for a pure number.
    pub fn unit(&self) -> &'static str {
        self.unit
    }

    /// The first sentence of its description; empty without one.
    pub fn description(&self) -> &'static str {
        let text = self.about.trim();
        let end = [". ", "; "].iter().filter_map(|end| text.find(end)).min().unwrap_or(text.len());
        text[..end].trim_end_matches('.')
    }

    /// Names of the components; `[""]` for a number.
    pub fn components(&self) -> &'static [&'static str] {
        self.components
    }

    /// Names of the columns that it reads.
    pub(super) fn needs(&self) -> &[&'static str] {
        &self.needs
    }

    /// Whether bodies of that kind, with those columns, have the field.
    pub(super) fn fits(&self, kind: BodyKind, columns: &ColumnSet) -> bool {
        self.kind.is_none_or(|only| only == kind) && self.needs.iter().all(|name| columns.get(name).is_some())
    }

    /// Appends the components of the field to `out`, row by row.
    ///
    /// # Errors
    /// The particles do not have a column that it needs.
    pub fn evaluate(&self, input: &FieldInput<'_>, out: &mut Vec<f64>) -> Result<(), MissingColumn> {
        (self.evaluate)(input, out)
    }
}

impl SimBuilder<'_> {
    /// Adds a field for recordings, ParaView files and probes. Of several fields of one name a body has the
    /// first whose columns it has.
    pub fn add_field(&mut self, field: Field) {
        self.extend(field);
    }
}
