//! `meshless validate`: cases with known answers, run through the real engine and compared.
//!
//! A case is a scene in `tests/validation/<case>/`, whose resolution and few parameters are set the way `--set` sets
//! them, and one file here, which says what is measured and what it is compared with.

mod abrasive_flow;
mod bar_impact;
mod bending_column;
mod bending_cylinder;
mod cantilever;
mod cantilever_large;
mod case;
mod check;
mod closed_box;
mod cook_membrane;
mod dam_break;
mod dam_break_box;
mod dam_break_obstacle;
mod dam_front;
mod disorder;
mod elastic_bar;
mod elliptic_drop;
mod eulerian;
mod floating_box;
mod four_point;
mod hertz;
mod homogeneous;
mod hydrostatic_tank;
mod incline;
mod invariants;
mod jaumann_shear;
mod johnson_cook;
mod kernels;
mod laminar_flows;
mod laws;
mod level_at_rest;
mod lid_driven_cavity;
mod measure;
mod metal_cutting;
mod moving_square;
mod neighbor_lists;
mod oscillating_plate;
mod patch;
mod plate_with_hole;
mod pressurised;
mod punch;
mod quarter_punch;
mod random;
mod rebound;
mod report;
mod restitution;
mod rigid;
mod rotating_flows;
mod rotating_patch;
mod rubber_pull;
mod rubber_rings;
pub mod sweep;
mod taylor;
mod taylor_bars;
mod taylor_plane;
mod tensile_failure;
mod thick_ring;
mod touching_surfaces;
mod turek_hron;
mod twisting_column;
mod uniaxial_strain;
mod updated_lagrangian;
mod upsetting;
mod viscous_channel;
mod viscous_layers;
mod vortices;
mod water_on_plate;
mod waves;
mod wedge_entry;

use meshless_engine::plugin::Registry;

use super::failure::Failure;
use super::template;
use super::text::say;
pub use case::{CASES, Case};
pub use check::{Check, Tolerance};
use report::Report;

/// Run cases with known answers and print measured value, reference, error and tolerance.
#[derive(Clone, Debug, Default, clap::Args)]
pub struct Arguments {
    /// Cases to run, such as `S11`; all if none is given. `sweep` runs every plugin of fluids on every shipped flow, which takes minutes.
    #[arg(value_name = "ID")]
    pub cases: Vec<String>,
    /// Particles across the smallest dimension, in place of the cheapest meaningful resolution of each case.
    #[arg(long, conflicts_with = "all_resolutions", value_name = "N")]
    pub resolution: Option<usize>,
    /// Run all resolutions of each case and check that the errors fall.
    #[arg(long)]
    pub all_resolutions: bool,
    /// List the cases and their resolutions, run nothing.
    #[arg(long)]
    pub list: bool,
}

/// Runs the cases; fails where a case fails or an error is too large.
pub(super) fn execute(arguments: &Arguments, registry: &Registry) -> Result<(), Failure> {
    let cases = chosen(&arguments.cases)?;
    if arguments.list {
        cases.iter().for_each(|case| say(&report::description(case)));
        return Ok(());
    }
    let mut report = Report::default();
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

fn chosen(names: &[String]) -> Result<Vec<&'static Case>, Failure> {
    if names.is_empty() {
        return Ok(CASES.iter().collect());
    }
    let mut cases = Vec::new();
    for name in names {
        let all = CASES.iter().chain([&sweep::CASE]);
        match all.clone().find(|case| case.id.eq_ignore_ascii_case(name)) {
            Some(case) => cases.push(case),
            None => {
                let known: Vec<&str> = all.map(|case| case.id).collect();
                return Err(Failure::Usage(format!(
                    "unknown case `{name}`; the cases are {}",
                    known.join(", ")
                )));
            }
        }
    }
    Ok(cases)
}
