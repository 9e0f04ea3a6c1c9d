//! `meshless validate`: cases with known answers, run through the real engine and compared.

mod report;

use meshless_engine::plugin::Registry;
use meshless_validation::{CASES, Case, sweep};

use super::failure::CommandFailure;
use super::text::say;
use super::values::whole;
use report::ValidationReport;

/// Run cases with known answers and print measured value, reference, error and tolerance.
#[derive(Clone, Debug, Default, clap::Args)]
pub struct ValidateArguments {
    /// Cases to run, such as `S11`; all if none is given. `sweep` runs every plugin of fluids on every
    /// shipped flow, which takes an hour, `sweep-dam_break` on one of them.
    #[arg(value_name = "ID")]
    pub cases: Vec<String>,
    /// Particles across the smallest dimension, in place of the cheapest meaningful resolution of each case.
    #[arg(long, conflicts_with = "all_resolutions", value_name = "N", value_parser = whole(1..=100_000_usize))]
    pub resolution: Option<usize>,
    /// Run all resolutions of each case and check that the errors fall.
    #[arg(long)]
    pub all_resolutions: bool,
    /// List the cases and their resolutions, run nothing.
    #[arg(long)]
    pub list: bool,
}

/// Runs the cases; fails where a case fails or an error is too large.
pub(super) fn execute(arguments: &ValidateArguments, registry: &Registry) -> Result<(), CommandFailure> {
    let cases = chosen(&arguments.cases)?;
    if arguments.list {
        cases.iter().for_each(|case| say(&report::description(case)));
        return Ok(());
    }
    let mut report = ValidationReport::default();
    for case in cases {
        if arguments.all_resolutions {
            for &resolution in case.resolutions {
                report.run(case, resolution, registry);
            }
            report.check_convergence(case);
        } else {
            report.run(case, arguments.resolution.unwrap_or(case.ci_resolution), registry);
        }
    }
    report.finish()
}

fn chosen(names: &[String]) -> Result<Vec<&'static Case>, CommandFailure> {
    if names.is_empty() {
        return Ok(CASES.iter().collect());
    }
    let mut cases = Vec::new();
    for name in names {
        if name.eq_ignore_ascii_case("sweep") {
            cases.extend(sweep::CASES);
            continue;
        }
        let all = CASES.iter().chain(sweep::CASES);
        match all.clone().find(|case| case.id.eq_ignore_ascii_case(name)) {
            Some(case) => cases.push(case),
            None => {
                let known: Vec<&str> = all.map(|case| case.id).collect();
                return Err(CommandFailure::Usage(format!(
                    "unknown case `{name}`; the cases are {}",
                    known.join(", ")
                )));
            }
        }
    }
    Ok(cases)
}
