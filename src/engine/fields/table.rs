//! All fields of a simulation, and the lookup of a field by its name.

use std::sync::Arc;

use super::chosen::{BodyField, ChosenField};
use super::field::Field;
use super::{deformation, motion, stress};
use crate::plugin::{BodyKind, SimBuilder};
use crate::scene::{Problem, unknown};
use crate::world::{BodyId, BodySet, ColumnSet};

/// What decides which fields the particles of a body have.
struct BodyColumns {
    name: String,
    kind: BodyKind,
    columns: ColumnSet,
}

/// All fields of a simulation.
pub struct FieldTable {
    fields: Vec<Field>,
    bodies: Vec<BodyColumns>,
}

/// Name, unit and number of components.
type Shape<'a> = (&'a str, &'static str, &'static [&'static str]);

impl FieldTable {
    /// Takes what plugins have added, then what is derived, then the columns: the first that fits a body is meant.
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

    /// The field of that name: `velocity`, or a component of one, `velocity.x`. `among` are the bodies of which at
    /// least one, or with `all` every one, must have it. A problem has no place yet.
    ///
    /// # Errors
    /// No field has the name, or the bodies do not have the field.
    pub fn choose(
        self: &Arc<Self>,
        name: &str,
        among: &BodySet,
        all: bool,
    ) -> Result<ChosenField, Box<Problem>> {
        let (base, component) = match name.split_once('.') {
            Some((base, component)) => (base, Some(component)),
            None => (name, None),
        };
        let in_bodies: Vec<Option<usize>> = (0..self.bodies.len())
            .map(|k| if among.contains(BodyId(k)) { self.find(base, k) } else { None })
            .collect();
        let Some(first) = in_bodies.iter().flatten().next().map(|&k| self.shape(k)) else {
            let (mut message, helps) = unknown("field", base, &self.names(among));
            if self.fields.iter().any(|field| field.name() == base) {
                message = format!("the bodies chosen here do not have the field `{base}`");
            }
            return Err(Box::new(Problem::new(message).helps(helps)));
        };
        // Alternatives of one name that differ in unit or components are different things.
        let same = |k: &usize| self.shape(*k) == first;
        let bodies: Vec<Option<BodyField>> =
            in_bodies.into_iter().map(|k| k.filter(same).map(BodyField)).collect();
        if all && let Some(lacking) = among.iter().find(|id| bodies[id.0].is_none()) {
            let message =
                format!("the particles of body `{}` have no field `{base}`", self.bodies[lacking.0].name);
            let problem = Problem::new(message).help("select bodies that have it, or measure something else");
            return Err(Box::new(problem));
        }
        let (_, unit, components) = first;
        let pick = component.map(|component| component_index(base, component, components)).transpose()?;
        Ok(ChosenField { table: Arc::clone(self), name: name.to_owned(), unit, components, pick, bodies })
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

    fn find(&self, name: &str, body: usize) -> Option<usize> {
        let BodyColumns { kind, columns, .. } = &self.bodies[body];
        self.fields.iter().position(|field| field.name() == name && field.fits(*kind, columns))
    }

    fn shape(&self, k: usize) -> Shape<'_> {
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

fn component_index(base: &str, component: &str, all: &[&str]) -> Result<usize, Box<Problem>> {
    let found = all.iter().position(|known| *known == component && !known.is_empty());
    found.ok_or_else(|| {
        let problem = Problem::new(format!("the field `{base}` has no component `{component}`"));
        Box::new(if all.len() == 1 {
            problem.help(format!("it is a number: write `{base}`"))
        } else {
            problem.help(format!("its components are {}", all.join(", ")))
        })
    })
}
