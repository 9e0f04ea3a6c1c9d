//! Measurements of probes that are neither a field of particles nor an energy.

use crate::schedule::Resources;
use crate::world::{BodyId, MissingColumn, World};

/// Numbers that are taken from the particles at an instant.
pub trait Measure: Send + Sync {
    /// Name and unit of each number.
    fn columns(&self) -> Vec<(String, &'static str)>;

    /// What all numbers are where there is nothing to measure, if that is not NaN.
    fn of_nothing(&self) -> Option<f64> {
        None
    }

    /// The wall or body in which it lay and which has moved away from it.
    fn left_by(&self) -> Option<BodyId> {
        None
    }

    /// Names of the particle columns that it reads.
    fn needs(&self) -> Vec<&'static str>;

    /// The numbers.
    ///
    /// # Errors
    /// A column is missing.
    fn read(&self, world: &World, resources: &Resources) -> Result<Vec<f64>, MissingColumn>;
}
