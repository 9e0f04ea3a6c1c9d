//! A requested field, found in every body that has it.

use std::ops::Range;
use std::sync::Arc;

use super::field::FieldInput;
use super::table::FieldTable;
use crate::schedule::Resources;
use crate::world::{BodyId, MissingColumn, World};

/// The field of the table that a body has.
#[derive(Clone, Copy)]
pub(super) struct BodyField(pub usize);

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

    /// Names of the numbers of one particle: the name of the field if there is one, else those of the components.
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
