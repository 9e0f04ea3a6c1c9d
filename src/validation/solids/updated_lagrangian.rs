//! Cases of total-Lagrangian solids with the updated-Lagrangian formulation in its place: invariants as exact, errors within 1.5 times the tolerances.

use anyhow::Result;
use meshless_engine::plugin::Registry;

use super::{bending_column, cantilever, oscillating_plate, taylor_bars, turek_hron, twisting_column};
use crate::case::Case;
use crate::check::Check;
use crate::exact::invariants;

macro_rules! cases {
    ($($name:ident $id:literal $title:literal $case:path, $factor:literal;)*) => {$(
        pub(crate) const $name: Case = Case {
            id: $id,
            title: concat!($title, ", updated-Lagrangian"),
            run: |registry, resolution| run(registry, &$case, resolution, $factor),
            ..$case
        };
    )*};
}

cases! {
    AFFINE "K2U" "affine map of an irregular body" invariants::AFFINE, 1.0;
    GRADIENT "K3U" "force against the slope of strain and hourglass energy" invariants::GRADIENT, 1.0;
    PAIR_TERM "K4U" "artificial viscosity as a pair term" invariants::PAIR_TERM, 1.0;
    THROWN "K6U" "thrown, spinning and swinging body, 100 periods" invariants::THROWN, 1.0;
    CANTILEVER "S2U" "cantilever, linear stiffness" cantilever::CASE, 1.5;
    PLATE "S8U" "oscillating plate" oscillating_plate::CASE, 1.5;
    FLAG "S9U" "Turek-Hron CSM1, CSM2, CSM3" turek_hron::CASE, 1.5;
    COLUMN "S11U" "bending column" bending_column::CASE, 1.5;
    TWISTED "S12U" "twisting column" twisting_column::CASE, 1.5;
    COPPER "S13U" "Taylor bar of copper" taylor_bars::COPPER, 1.5;
    ALUMINIUM "S15U" "Taylor bar of aluminium 6061-T6" taylor_bars::ALUMINIUM, 1.5;
}

/// Runs a case with the other formulation and wider tolerances.
fn run(registry: &Registry, case: &Case, resolution: usize, factor: f64) -> Result<Vec<Check>> {
    let registry = registry.clone().with_stand_in("TotalLagrangian", "UpdatedLagrangian");
    let checks = (case.run)(&registry, resolution)?;
    // Regression values of the discrete equations belong to the other formulation.
    let general = checks.into_iter().filter(|check| check.source != "direct sparse solution");
    Ok(general.map(|check| check.widened(factor)).collect())
}
