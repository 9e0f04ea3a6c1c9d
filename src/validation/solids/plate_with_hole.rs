//! S23: a plate with a hole under tension: stress at the edge of the hole.

use anyhow::{Context, Result};
use meshless_engine::plugin::Registry;

use crate::case::Case;
use crate::check::{Check, Tolerance};
use crate::measure::relax;
use crate::template::Template;

pub(crate) const CASE: Case = Case {
    id: "S23d",
    title: "plate with a hole",
    resolutions: &[8, 16, 24],
    ci_resolution: 8,
    run: plate_with_hole,
};

/// Radius of the hole, m, and tension, Pa.
const RADIUS: f64 = 0.03;
const TENSION: f64 = 100.0;
/// Stress at the edge of a hole with a diameter of 0.3 of the width over the remote stress: Howland, Phil.
/// Trans. R. Soc. A 229 (1930) 49.
const FACTOR: f64 = 3.368;

/// `per_radius` is the number of particles along the radius of the hole.
fn plate_with_hole(registry: &Registry, per_radius: usize) -> Result<Vec<Check>> {
    let mut simulation = Template::new(
        "tests/validation/plate_with_hole/scene.ron",
        include_str!("../../../tests/validation/plate_with_hole/scene.ron"),
    )
    .set("bodies.plate.spacing", RADIUS / per_radius as f64)?
    .build(registry)?;
    relax(&mut simulation)?;
    let shown = simulation.measure("edge")?;
    let stress = shown.first().context("the scene has no probe `edge`")?.1;
    let tolerance = Tolerance::Relative(if per_radius < 24 { 0.08 } else { 0.03 });
    let source = "Howland 1930";
    Ok(vec![
        Check::new("stress at the edge of the hole", stress, FACTOR * TENSION, tolerance, "Pa", source)
            .converging(),
    ])
}
