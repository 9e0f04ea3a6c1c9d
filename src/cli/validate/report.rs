//! The table that `meshless validate` prints.

use std::time::{Duration, Instant};

use meshless_engine::plugin::Registry;
use meshless_validation::{Case, Check, Tolerance, at_no_spacing};

use crate::cli::failure::CommandFailure;
use crate::cli::text::say;

/// State of a validation so far.
#[derive(Default)]
pub struct ValidationReport {
    done: Vec<(&'static str, usize, Vec<Check>)>,
    passed: usize,
    failed: usize,
}

/// A case in one line.
pub fn description(case: &Case) -> String {
    let resolutions: Vec<String> = case.resolutions.iter().map(usize::to_string).collect();
    format!(
        "{:<4} {} (resolutions {}; tests: {})",
        case.id,
        case.title,
        resolutions.join(", "),
        case.ci_resolution
    )
}

impl ValidationReport {
    /// Runs a case at a resolution and prints its lines.
    pub fn run(&mut self, case: &'static Case, resolution: usize, registry: &Registry) {
        say(&format!("{} {}, resolution {resolution}", case.id, case.title));
        let start = Instant::now();
        match (case.run)(registry, resolution) {
            Ok(checks) => {
                for check in &checks {
                    self.count(check.passes());
                    say(&line(check));
                }
                say(&format!("  {:>61}", seconds(start.elapsed())));
                self.done.push((case.id, resolution, checks));
            }
            Err(error) => {
                self.count(false);
                say(&format!("  FAILED after {}: {error:#}", seconds(start.elapsed())));
            }
        }
    }

    /// Checks that errors fall over the resolutions of a case that have been run.
    pub fn check_convergence(&mut self, case: &Case) {
        let runs: Vec<_> = self.done.iter().filter(|(id, ..)| *id == case.id).collect();
        let Some((_, _, last)) = runs.last() else { return };
        let mut lines = Vec::new();
        for check in last.iter().filter(|check| check.converges) {
            let name = &check.name;
            let errors: Vec<(usize, f64)> = runs
                .iter()
                .filter_map(|(_, n, checks)| Some((*n, checks.iter().find(|c| c.name == *name)?.error())))
                .collect();
            let falls = errors.len() == case.resolutions.len()
                && falls(&errors)
                && check.rate.is_none_or(|rate| rate.is_met(&errors));
            let mut list: Vec<String> =
                errors.iter().map(|(n, e)| format!("{n}: {:+.3} %", 100.0 * e)).collect();
            if let Some(error) = check.rate.and_then(|_| at_no_spacing(&errors)) {
                list.push(format!("extrapolated: {:+.3} %", 100.0 * error));
            }
            lines.push((falls, format!("  convergence of {name}: {}", list.join(", "))));
        }
        for (falls, text) in lines {
            self.count(falls);
            say(&format!("{text}  {}", if falls { "falls" } else { "DOES NOT FALL" }));
        }
    }

    /// Prints the totals; an error unless everything has passed.
    pub fn finish(&self) -> Result<(), CommandFailure> {
        say(&format!("{} checks passed, {} failed", self.passed, self.failed));
        if self.failed == 0 {
            Ok(())
        } else {
            Err(CommandFailure::Run(format!("{} checks failed", self.failed)))
        }
    }

    fn count(&mut self, passes: bool) {
        if passes {
            self.passed += 1;
        } else {
            self.failed += 1;
        }
    }
}

/// Whether the size of the error falls from each resolution to the next.
fn falls(errors: &[(usize, f64)]) -> bool {
    errors.windows(2).all(|pair| pair[1].1.abs() < pair[0].1.abs())
}

/// That share in per cent, to a hundredth.
fn percent(share: f64) -> f64 {
    (1e4 * share).round() / 100.0
}

fn line(check: &Check) -> String {
    let measured = number(check.measured);
    let reference = number(check.reference);
    let unit = if check.unit == "1" { "" } else { check.unit };
    let error = format!("{:+.3} %", 100.0 * check.error());
    let (error, tolerance) = match check.tolerance {
        Tolerance::Relative(most) => (error, format!("+-{} %", percent(most))),
        Tolerance::Between(low, high) => (error, format!("{} to {:+} %", percent(low), percent(high))),
        Tolerance::Absolute(most) => (error, format!("+-{most} {unit}")),
        Tolerance::Below => (String::new(), "below".to_owned()),
        Tolerance::Above => (String::new(), "above".to_owned()),
    };
    let verdict = if check.passes() { "ok" } else { "FAILED" };
    format!(
        "  {:<46} {measured:>12} {reference:>12} {unit:<8} {error:>11}  {tolerance:<14} {verdict:<7} {}",
        check.name, check.source
    )
}

fn number(value: f64) -> String {
    let size = value.abs();
    if size != 0.0 && !(1e-3..1e5).contains(&size) { format!("{value:.4e}") } else { format!("{value:.6}") }
}

fn seconds(time: Duration) -> String {
    format!("{:.1} s", time.as_secs_f64())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_error_that_grows_anywhere_does_not_fall() {
        assert!(falls(&[(4, 0.1), (8, -0.05), (16, 0.01)]));
        assert!(!falls(&[(4, 0.1), (8, 0.01), (16, -0.02)]));
        assert!(!falls(&[(4, 0.1), (8, f64::NAN)]));
    }
}
