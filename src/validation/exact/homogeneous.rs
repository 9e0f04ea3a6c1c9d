//! A homogeneously deformed body: the value of one of its particles, if all agree.

use anyhow::{Context, Result, ensure};
use meshless_engine::glam::{DMat3, DVec3};
use meshless_engine::simulation::Simulation;
use meshless_engine::world::{BodyId, Column, DeformationGradient, PiolaStress, ReferencePosition};

/// The value of a column of the first body, which must be that of all its particles to rounding.
pub fn value<C: Column<Value = f64>>(simulation: &Simulation) -> Result<f64> {
    let (view, rows) = simulation.world().body_view(BodyId(0));
    let column = view.read::<C>()?;
    let first = *column[rows.start].value();
    let agree = column[rows].iter().all(|row| (row.value() - first).abs() <= 1e-9 * first.abs().max(1e-9));
    ensure!(agree, "the particles differ in {}", C::NAME);
    Ok(first)
}

/// The particle in the middle of the first body: one that has neighbours all around, however far it is
/// sheared.
fn middle(simulation: &Simulation) -> Result<usize> {
    let (view, rows) = simulation.world().body_view(BodyId(0));
    let reference = view.read::<ReferencePosition>()?;
    let center = rows.clone().map(|row| reference[row].0).sum::<DVec3>() / rows.len() as f64;
    let distance = |row: &usize| reference[*row].0.distance(center);
    rows.min_by(|a, b| distance(a).total_cmp(&distance(b))).context("the body has no particle")
}

/// Kirchhoff stress of a particle of the first body, Pa.
pub fn kirchhoff(simulation: &Simulation) -> Result<DMat3> {
    let (view, row) = (simulation.world().body_view(BodyId(0)).0, middle(simulation)?);
    let (stress, gradient) = (view.read::<PiolaStress>()?, view.read::<DeformationGradient>()?);
    Ok(stress[row].0 * gradient[row].0.transpose())
}

/// Cauchy stress of a particle of the first body, Pa.
pub fn cauchy(simulation: &Simulation) -> Result<DMat3> {
    let (view, row) = (simulation.world().body_view(BodyId(0)).0, middle(simulation)?);
    let volume = view.read::<DeformationGradient>()?[row].0.determinant();
    Ok(kirchhoff(simulation)? * (1.0 / volume))
}

/// Measured and reference value with the maximum difference, in units of `scale`.
#[derive(Clone, Copy, Debug, Default)]
pub struct Worst {
    /// Measured value.
    pub measured: f64,
    /// Reference value.
    pub reference: f64,
    error: f64,
}

impl Worst {
    /// Adds a value; NaN counts as the largest difference.
    pub fn add(&mut self, measured: f64, reference: f64, scale: f64) {
        let error = (measured - reference).abs() / scale;
        if error.is_nan() || error > self.error {
            *self = Self { measured, reference, error };
        }
    }

    /// The maximum difference in units of the scale.
    pub fn error(&self) -> f64 {
        self.error
    }
}
