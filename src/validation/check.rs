//! A measured value of a case and its reference.

/// Tolerance of a measured value.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Tolerance {
    /// Maximum magnitude of the relative error.
    Relative(f64),
    /// Lower and upper bound of the relative error.
    Between(f64, f64),
    /// Maximum magnitude of the error, in the unit of the value.
    Absolute(f64),
    /// The value is below the reference.
    Below,
    /// The value is above the reference.
    Above,
}

/// A measured value, its reference, and the source of the reference.
#[derive(Clone, Debug)]
pub struct Check {
    /// The measured quantity.
    pub name: String,
    /// Measured value.
    pub measured: f64,
    /// Reference value; the bound of [`Tolerance::Below`] and [`Tolerance::Above`].
    pub reference: f64,
    /// Tolerance.
    pub tolerance: Tolerance,
    /// Unit of both; `1` for a pure number.
    pub unit: &'static str,
    /// Source of the reference.
    pub source: &'static str,
    /// Whether the error must decrease from one resolution to the next.
    pub converges: bool,
    /// Required rate of convergence, if the case states one.
    pub rate: Option<ConvergenceRate>,
}

/// Required convergence of an error with the spacing.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ConvergenceRate {
    /// Minimum factor by which the error decreases when the spacing is halved.
    pub per_halving: f64,
    /// Maximum relative error extrapolated to zero spacing, by the line through the two finest runs.
    pub extrapolated: f64,
}

impl ConvergenceRate {
    /// Whether the errors at ascending resolutions converge so fast.
    pub fn is_met(self, errors: &[(usize, f64)]) -> bool {
        errors.windows(2).all(|pair| {
            let halvings = (pair[1].0 as f64 / pair[0].0 as f64).log2();
            pair[1].1.abs() * self.per_halving.powf(halvings) <= pair[0].1.abs()
        }) && at_no_spacing(errors).is_some_and(|error| error.abs() <= self.extrapolated)
    }
}

/// The error extrapolated to zero spacing, by the line through the two finest runs.
pub fn at_no_spacing(errors: &[(usize, f64)]) -> Option<f64> {
    let [.., (coarse, first), (fine, second)] = errors else { return None };
    let (coarse, fine) = (*coarse as f64, *fine as f64);
    Some((fine * second - coarse * first) / (fine - coarse))
}

impl Check {
    /// A value with a reference and a tolerance.
    pub fn new(
        name: impl Into<String>,
        measured: f64,
        reference: f64,
        tolerance: Tolerance,
        unit: &'static str,
        source: &'static str,
    ) -> Self {
        Self { name: name.into(), measured, reference, tolerance, unit, source, converges: false, rate: None }
    }

    /// A pure number that must be below a bound.
    pub fn below(name: impl Into<String>, measured: f64, bound: f64, source: &'static str) -> Self {
        Self::new(name, measured, bound, Tolerance::Below, "1", source)
    }

    /// A pure number that must be above a bound.
    pub fn above(name: impl Into<String>, measured: f64, bound: f64, source: &'static str) -> Self {
        Self::new(name, measured, bound, Tolerance::Above, "1", source)
    }

    /// The same check, whose error must also decrease with resolution.
    #[must_use]
    pub fn converging(self) -> Self {
        Self { converges: true, ..self }
    }

    /// The same check, with a required rate of convergence.
    #[must_use]
    pub fn converging_at(self, rate: ConvergenceRate) -> Self {
        Self { converges: true, rate: Some(rate), ..self }
    }

    /// The same check with the relative tolerance multiplied by a factor: for a formulation that is compared
    /// with another.
    #[must_use]
    pub fn widened(self, factor: f64) -> Self {
        let tolerance = match self.tolerance {
            Tolerance::Relative(most) => Tolerance::Relative(factor * most),
            Tolerance::Between(low, high) => Tolerance::Between(factor * low, factor * high),
            other => other,
        };
        Self { tolerance, ..self }
    }

    /// Relative error; the difference where the reference is zero.
    pub fn error(&self) -> f64 {
        let difference = self.measured - self.reference;
        if self.reference == 0.0 { difference } else { difference / self.reference.abs() }
    }

    /// Whether the error is within the tolerance. NaN never is.
    pub fn passes(&self) -> bool {
        match self.tolerance {
            Tolerance::Relative(most) => self.error().abs() <= most,
            Tolerance::Between(low, high) => (low..=high).contains(&self.error()),
            Tolerance::Absolute(most) => (self.measured - self.reference).abs() <= most,
            Tolerance::Below => self.measured < self.reference,
            Tolerance::Above => self.measured > self.reference,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn check(measured: f64, tolerance: Tolerance) -> bool {
        Check::new("x", measured, -2.0, tolerance, "m", "").passes()
    }

    #[test]
    fn a_value_passes_within_its_tolerance_only() {
        assert!(check(-2.02, Tolerance::Relative(0.011)));
        assert!(!check(-2.03, Tolerance::Relative(0.011)));
        assert!(check(-1.97, Tolerance::Between(-0.001, 0.02)));
        assert!(!check(-2.01, Tolerance::Between(-0.001, 0.02)));
        assert!(check(-2.01, Tolerance::Absolute(0.02)));
        assert!(check(-3.0, Tolerance::Below) && !check(-2.0, Tolerance::Below));
        assert!(check(-1.0, Tolerance::Above) && !check(-2.0, Tolerance::Above));
    }

    #[test]
    fn errors_of_first_order_fall_at_their_rate_and_lead_to_none() {
        let rate = ConvergenceRate { per_halving: 1.6, extrapolated: 0.015 };
        assert!(rate.is_met(&[(20, 0.04), (40, 0.02), (80, 0.01)]));
        // Too slow; to another value; a single run.
        assert!(!rate.is_met(&[(20, 0.04), (40, 0.03), (80, 0.015)]));
        assert!(!rate.is_met(&[(20, 0.1), (40, 0.05), (80, -0.001)]));
        assert!(!rate.is_met(&[(20, 0.01)]));
        assert!(at_no_spacing(&[(20, 0.06), (40, 0.04)]).is_some_and(|error| (error - 0.02).abs() < 1e-12));
    }

    #[test]
    fn what_is_not_a_number_never_passes() {
        for tolerance in
            [Tolerance::Relative(1e9), Tolerance::Absolute(1e9), Tolerance::Below, Tolerance::Above]
        {
            assert!(!check(f64::NAN, tolerance));
        }
    }
}
