//! The instrument of a probe.

use super::energies::EnergyColumns;
use super::measure::Measure;
use super::particles::ParticleGauge;
use super::point::PointGauge;
use super::torque::TorqueGauge;
use crate::fields::ChosenField;
use crate::plugin::SetupError;
use crate::scene::Problem;
use crate::schedule::Resources;
use crate::world::{BodyId, MissingColumn, World};

/// The instrument of a probe.
pub enum Gauge {
    /// Mean or sum over particles.
    Particles(ParticleGauge),
    /// Interpolation at a point.
    Point(PointGauge),
    /// Torque of the forces on particles.
    Torque(TorqueGauge),
    /// Any other measurement.
    Measure(Box<dyn Measure>),
    /// Accounts of the energy ledger.
    Energies(EnergyColumns),
}

impl Gauge {
    /// Name and unit of what it measures; none for energies, whose accounts open in the run.
    pub fn columns(&self) -> Vec<(String, &'static str)> {
        if let Self::Torque(_) = self {
            return ["x", "y", "z"].map(|axis| (axis.to_owned(), "N m")).to_vec();
        }
        if let Self::Measure(gauge) = self {
            return gauge.columns();
        }
        let Some(field) = self.field() else { return Vec::new() };
        field.column_names().into_iter().map(|name| (name, field.unit())).collect()
    }

    /// Names of the particle columns that it reads.
    pub fn needs(&self) -> Vec<&'static str> {
        match self {
            Self::Torque(_) => TorqueGauge::NEEDS.to_vec(),
            Self::Particles(gauge) => gauge.needs(),
            Self::Measure(gauge) => gauge.needs(),
            _ => self.field().map(ChosenField::needs).unwrap_or_default(),
        }
    }

    /// Whether a number is that of nothing to measure.
    pub fn is_of_nothing(&self, number: f64) -> bool {
        let known = if let Self::Measure(gauge) = self { gauge.of_nothing() } else { None };
        number.is_nan() || known == Some(number)
    }

    /// The wall or body in which it lay and which has moved away from it.
    pub fn left_by(&self) -> Option<BodyId> {
        if let Self::Measure(gauge) = self { gauge.left_by() } else { None }
    }

    /// Measures; nothing for energies.
    ///
    /// # Errors
    /// A column is missing.
    pub fn read(&self, world: &World, resources: &Resources) -> Result<Vec<f64>, MissingColumn> {
        match self {
            Self::Particles(gauge) => gauge.read(world, resources),
            Self::Point(gauge) => gauge.read(world, resources),
            Self::Torque(gauge) => gauge.read(world),
            Self::Measure(gauge) => gauge.read(world, resources),
            Self::Energies(_) => Ok(Vec::new()),
        }
    }

    fn field(&self) -> Option<&ChosenField> {
        match self {
            Self::Particles(gauge) => Some(&gauge.field),
            Self::Point(gauge) => Some(&gauge.field),
            Self::Torque(_) | Self::Measure(_) | Self::Energies(_) => None,
        }
    }
}

/// The problems of a selection, at the place of the probe.
pub(super) fn at_probe(k: usize, error: SetupError) -> Vec<Problem> {
    match error {
        SetupError::Parameter { field, message, help } => {
            vec![Problem::at_path(format!("probes[{k}].{field}"), message).help(help)]
        }
        SetupError::Problems(problems) => problems,
    }
}
