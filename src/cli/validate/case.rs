//! What a case is, and the list of all cases.

use anyhow::Result;
use meshless_engine::plugin::Registry;

use super::check::Check;
use super::{
    bending_column, cantilever, cantilever_large, cook_membrane, elliptic_drop, hydrostatic_tank, invariants,
    kernels, laminar_flows, laws, neighbor_lists, oscillating_plate, patch, rubber_pull, turek_hron, twisting_column,
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
    patch::CASE,
    cantilever::CASE,
    cantilever_large::CASE,
    rubber_pull::CASE,
    oscillating_plate::CASE,
    turek_hron::CASE,
    cook_membrane::CASE,
    bending_column::CASE,
    twisting_column::CASE,
    hydrostatic_tank::CASE,
    laminar_flows::CASE,
    elliptic_drop::CASE,
];
