//! Tests of shapes and filling against closed forms and naive second implementations.

mod concentric;
mod errors;
mod fitted;
mod hexagonal;
mod mutation;
mod order;
mod points;
mod regions;
mod regular;
mod relaxed;
mod surfaces;
mod text;
mod walls;

use std::path::Path;

use super::{FillError, FillErrorKind, Filling, Lattice, Shape, Site, fill};
use crate::scene::Dimension;

pub(super) fn shape(text: &str) -> Shape {
    ron::from_str(text).unwrap()
}

fn try_fill(
    text: &str,
    lattice: Lattice,
    spacing: f64,
    dimension: Dimension,
) -> Result<Vec<Site>, FillError> {
    fill(
        &shape(text),
        Filling { lattice, spacing, dimension, folder: Path::new("."), limit: 1_000_000, is_wall: false },
    )
}

fn filled(text: &str, lattice: Lattice, spacing: f64, dimension: Dimension) -> Vec<Site> {
    try_fill(text, lattice, spacing, dimension).unwrap()
}

fn total(sites: &[Site]) -> f64 {
    sites.iter().map(|site| site.volume).sum()
}

fn assert_close(value: f64, expected: f64, relative: f64) {
    assert!((value - expected).abs() <= relative * expected.abs(), "{value} is not {expected}");
}

fn min_distance(sites: &[Site]) -> f64 {
    let mut least = f64::INFINITY;
    for (n, a) in sites.iter().enumerate() {
        for b in &sites[..n] {
            least = least.min(a.position.distance(b.position));
        }
    }
    least
}

fn kind(text: &str, spacing: f64, dimension: Dimension) -> (String, FillErrorKind) {
    let FillError { path, kind } = try_fill(text, Lattice::Regular, spacing, dimension).unwrap_err();
    (path, kind)
}
