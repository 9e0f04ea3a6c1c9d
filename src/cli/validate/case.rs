//! What a case is, and the list of all cases.

use anyhow::Result;
use meshless_engine::plugin::Registry;

use super::check::Check;
use super::{
    bar_impact, bending_column, cantilever, cantilever_large, cook_membrane, elliptic_drop, hertz,
    hydrostatic_tank, incline, invariants, jaumann_shear, johnson_cook, kernels, laminar_flows, laws,
    neighbor_lists, oscillating_plate, patch, punch, rebound, restitution, rubber_pull, taylor_bars,
    taylor_plane, tensile_failure, turek_hron, twisting_column, uniaxial_strain,
};

/// A case with a known answer.
pub struct Case {
    /// Its identity, such as `S11`.
    pub id: &'static str,
    /// What it is, in one line.
    pub title: &'static str,
    /// Resolutions that show convergence, ascending: particles across the smallest dimension.
    pub resolutions: &'static [usize],
    /// The cheapest meaningful resolution, which tests run.
    pub ci_resolution: usize,
    /// Runs it at a resolution.
    pub run: fn(&Registry, usize) -> Result<Vec<Check>>,
}

/// All cases.
pub const CASES: &[Case] = &[
    kernels::CASE,
    invariants::AFFINE,
    invariants::GRADIENT,
    invariants::PAIR_TERM,
    neighbor_lists::CASE,
    invariants::THROWN,
    laws::STRETCH,
    laws::CONSISTENCY,
    uniaxial_strain::CASE,
    johnson_cook::CASE,
    jaumann_shear::CASE,
    patch::CASE,
    cantilever::CASE,
    cantilever_large::CASE,
    rubber_pull::CASE,
    taylor_plane::CASE,
    tensile_failure::CASE,
    oscillating_plate::CASE,
    turek_hron::CASE,
    cook_membrane::CASE,
    bending_column::CASE,
    twisting_column::CASE,
    taylor_bars::COPPER,
    taylor_bars::STEEL,
    taylor_bars::ALUMINIUM,
    punch::CASE,
    bar_impact::CASE,
    hertz::CASE,
    incline::CASE,
    restitution::CASE,
    rebound::CASE,
    hydrostatic_tank::CASE,
    laminar_flows::CASE,
    elliptic_drop::CASE,
];
