//! A requested field, found in every body that has it.

use std::ops::Range;
use std::sync::Arc;

use super::field::FieldInput;
use super::table::{BodyField, FieldTable};
use crate::linalg::Sym3;
use crate::scene::{Problem, unknown};
use crate::schedule::Resources;
use crate::world::{BodyId, BodySet, MissingColumn, World};

/// A field, or one component of it, found in every body that has it.
#[derive(Clone)]
pub struct ChosenField {
    pub(super) table: Arc<FieldTable>,
    pub(super) name: String,
    pub(super) unit: &'static str,
    pub(super) components: &'static [&'static str],
    pub(super) pick: Option<usize>,
    pub(super) bodies: Vec<Option<BodyField>>,
}

impl ChosenField {
    /// Name as it was asked for, with the component if one was named.
    pub fn name(&self) -> &str {
        &self.name
    }

    /// Unit, SI.
    pub fn unit(&self) -> &'static str {
        self.unit
    }

    /// Numbers of one particle: 1, 3 or 9.
    pub fn width(&self) -> usize {
        if self.pick.is_some() { 1 } else { self.components.len() }
    }

    /// Names of the numbers of one particle: the name of the field if there is one, else those of the
    /// components.
    pub fn column_names(&self) -> Vec<String> {
        if self.width() == 1 {
            vec![self.name.clone()]
        } else {
            self.components.iter().map(|name| (*name).to_owned()).collect()
        }
    }

    /// Whether the particles of the body have the field.
    pub fn is_in(&self, body: BodyId) -> bool {
        self.bodies.get(body.0).is_some_and(Option::is_some)
    }

    /// Names of the columns that it reads.
    pub fn needs(&self) -> Vec<&'static str> {
        let fields = self.bodies.iter().flatten().map(|field| self.table.field(*field));
        fields.flat_map(|field| field.needs()).copied().collect()
    }

    /// The numbers of the rows of a body, row by row; nothing if the body does not have the field.
    ///
    /// # Errors
    /// A column is missing.
    pub fn read(
        &self,
        world: &World,
        resources: &Resources,
        body: BodyId,
        rows: Range<usize>,
    ) -> Result<Vec<f64>, MissingColumn> {
        let mut values = Vec::new();
        if let Some(field) = self.bodies.get(body.0).copied().flatten() {
            self.table.field(field).evaluate(&FieldInput { world, resources, body, rows }, &mut values)?;
        }
        if let Some(pick) = self.pick {
            let width = self.components.len();
            values = values.chunks_exact(width).map(|row| row[pick]).collect();
        }
        Ok(values)
    }

    /// The numbers of a particle of the body with that Cauchy stress, Pa, if the field is a function of it.
    pub(crate) fn of_stress(&self, body: BodyId) -> Option<impl Fn(&Sym3) -> Vec<f64>> {
        let field = self.bodies.get(body.0).copied().flatten()?;
        let of_stress = self.table.field(field).of_stress()?;
        Some(move |stress: &Sym3| {
            let mut values = Vec::new();
            of_stress(stress, &mut values);
            self.pick.map_or_else(|| values.clone(), |pick| vec![values[pick]])
        })
    }

    /// One number for each row of a body: the field itself, or the magnitude of a vector.
    ///
    /// # Errors
    /// A column is missing.
    pub fn read_numbers(
        &self,
        world: &World,
        resources: &Resources,
        body: BodyId,
        rows: Range<usize>,
    ) -> Result<Vec<f64>, MissingColumn> {
        let values = self.read(world, resources, body, rows)?;
        let width = self.width();
        if width == 1 {
            return Ok(values);
        }
        let magnitude = |row: &[f64]| row.iter().map(|x| x * x).sum::<f64>().sqrt();
        Ok(values.chunks_exact(width).map(magnitude).collect())
    }
}

impl FieldTable {
    /// The field of that name: `velocity`, or a component of one, `velocity.x`. `among` are the bodies of
    /// which at least one, or with `all` every one, must have it. A problem has no place yet.
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
