//! When a particle begins to fail.

use glam::DMat3;
use meshless_engine::linalg::Sym3;
use meshless_engine::materials::{ParameterError, SolidLaw};
use meshless_engine::plugin::SetupError;
use meshless_engine::world::{Column, ColumnSet, PlasticStrain, Temperature};
use schemars::JsonSchema;
use serde::Deserialize;

use crate::johnson_cook::JohnsonCookFailure;

/// When a particle begins to fail.
#[derive(Clone, Debug, PartialEq, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub enum Criterion {
    /// The largest principal logarithmic strain, ln of the largest stretch, is above the limit.
    MaximumPrincipalStrain {
        /// Limit, above zero.
        limit: f64,
    },
    /// The largest principal Cauchy stress is above the limit.
    MaximumPrincipalStress {
        /// Limit, above zero, Pa.
        limit: f64,
    },
    /// The sum of plastic strain increments over the failure strain of Johnson and Cook reaches 1. For
    /// materials with plastic flow.
    JohnsonCook(JohnsonCookFailure),
}

impl Criterion {
    /// Checks the parameters.
    pub(crate) fn check(&self) -> Result<(), ParameterError> {
        match self {
            Self::MaximumPrincipalStrain { limit } | Self::MaximumPrincipalStress { limit } => {
                ParameterError::require_positive("criterion.limit", *limit)
            }
            Self::JohnsonCook(strain) => strain.check(),
        }
    }

    /// Whether it depends on temperature.
    pub(crate) fn needs_temperature(&self) -> bool {
        matches!(self, Self::JohnsonCook(strain) if strain.d5 != 0.0)
    }
}

/// A criterion with the state variables of the law that it reads.
pub(crate) struct WatchedCriterion {
    criterion: Criterion,
    /// Whether the criterion sums plastic strain.
    pub plastic: bool,
    /// Whether it depends on temperature.
    pub temperature: bool,
}

/// State of one particle that a criterion evaluates.
pub(crate) struct CriterionInput<'a> {
    pub deformation: &'a DMat3,
    /// Cauchy stress, Pa.
    pub stress: &'a Sym3,
    /// Increment of the plastic strain in this step.
    pub plastic: f64,
    /// Temperature, K.
    pub temperature: f64,
    pub dt: f64,
}

impl WatchedCriterion {
    /// # Errors
    /// The law of the body has no plastic flow to be summed.
    pub fn new(criterion: Criterion, law: &dyn SolidLaw, body: &str) -> Result<Self, SetupError> {
        let mut columns = ColumnSet::default();
        law.state(&mut columns);
        let has = |name: &str| columns.get(name).is_some();
        let plastic = matches!(criterion, Criterion::JohnsonCook(_));
        if plastic && !has(PlasticStrain::NAME) {
            return Err(SetupError::parameter(
                "criterion",
                format!(
                    "the Johnson-Cook failure strain is a plastic strain: the material of body `{body}` must be plastic"
                ),
                "give the body a material with plastic flow, such as `J2` or `JohnsonCook`, or a criterion of strain or stress",
            ));
        }
        let temperature = plastic && has(Temperature::NAME);
        Ok(Self { criterion, plastic, temperature })
    }

    /// The index of failure after this step, `index` being that before, and whether the criterion is met now.
    pub fn index(&self, index: f64, seen: &CriterionInput<'_>) -> (f64, bool) {
        let now = match &self.criterion {
            Criterion::MaximumPrincipalStrain { limit } => {
                0.5 * largest_eigenvalue(&Sym3::gram(seen.deformation.transpose())).ln() / limit
            }
            Criterion::MaximumPrincipalStress { limit } => largest_eigenvalue(seen.stress) / limit,
            Criterion::JohnsonCook(strain) if seen.plastic > 0.0 => {
                let rate = seen.plastic / seen.dt;
                index + seen.plastic / strain.at(triaxiality(seen.stress), rate, seen.temperature)
            }
            Criterion::JohnsonCook(_) => index,
        };
        (index.max(now), now >= 1.0)
    }
}

/// Mean over von Mises stress.
fn triaxiality(stress: &Sym3) -> f64 {
    let equivalent = (1.5f64).sqrt() * stress.deviator().norm();
    if equivalent > 0.0 { stress.trace() / 3.0 / equivalent } else { 0.0 }
}

/// The largest eigenvalue from the invariants, good to some 1e-8 of the largest entry.
fn largest_eigenvalue(a: &Sym3) -> f64 {
    let mean = a.trace() / 3.0;
    let deviator = a.deviator();
    let p = (deviator.double_dot(&deviator) / 6.0).sqrt();
    if p <= 1e-14 * mean.abs() {
        return mean;
    }
    let angle = (0.5 * deviator.determinant() / (p * p * p)).clamp(-1.0, 1.0).acos() / 3.0;
    mean + 2.0 * p * angle.cos()
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::{DQuat, DVec3};

    #[test]
    fn the_largest_eigenvalue_is_that_of_the_diagonal() {
        let turn = DMat3::from_quat(DQuat::from_euler(glam::EulerRot::XYZ, 0.3, -1.1, 2.0));
        for values in [
            [1.0, 2.0, 3.0],
            [-3.0, -2.0, -7.0],
            [2.0, 2.0, 1.0],
            [2.0, 1.0, 1.0],
            [5.0, 5.0, 5.0],
            [0.0, 0.0, 0.0],
        ] {
            let values = DVec3::from(values);
            let matrix = Sym3::symmetric_part(turn * DMat3::from_diagonal(values) * turn.transpose());
            assert!((largest_eigenvalue(&matrix) - values.max_element()).abs() < 1e-7, "{values}");
        }
    }

    #[test]
    fn the_triaxiality_of_a_pull_is_a_third() {
        let pull = |s: f64| triaxiality(&Sym3::from_diagonal(DVec3::new(s, 0.0, 0.0)));
        assert!((pull(3e8) - 1.0 / 3.0).abs() < 1e-15 && (pull(-2.0) + 1.0 / 3.0).abs() < 1e-15);
        assert_eq!(triaxiality(&Sym3::ZERO), 0.0);
    }
}
