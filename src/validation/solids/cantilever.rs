//! S2: linear stiffness of a cantilever.

use anyhow::Result;
use meshless_engine::glam::DVec3;
use meshless_engine::plugin::Registry;

use crate::case::Case;
use crate::check::{Check, Tolerance};
use crate::measure::{MaterialPoint, body, relax};
use crate::template::Template;

pub(crate) const CASE: Case = Case {
    id: "S2",
    title: "cantilever, linear stiffness",
    resolutions: &[4, 8, 16],
    ci_resolution: 8,
    run: cantilever,
};

/// Load on the top right particle, N per metre of thickness: its deflection of 1e-6 m is in the linear range.
const LOAD: f64 = 50.0;
/// Plane strain elasticity, kN/mm for a thickness of 1 mm.
const ELASTICITY: f64 = 0.05317;
/// The same load, on the corner cell, and the clamp at the last clamped centres, by finite elements:
/// particles across, kN/mm.
const SAME_LOAD: [(usize, f64); 3] = [(4, 0.053186739), (8, 0.053144471), (16, 0.053106957)];
/// Tolerance from this number of particles across.
const TOLERANCES: [(usize, f64); 3] = [(32, 0.015), (16, 0.02), (0, 0.04)];
/// Stiffness of the discrete equations by a direct solution of the sparse linear system: particles across,
/// coefficient of the control, kN/mm.
const DISCRETE: [(usize, f64, f64); 6] = [
    (4, 0.0, 0.034838),
    (8, 0.0, 0.046970),
    (16, 0.0, 0.051111),
    (4, 10.0, 0.0536573 * 1.36408),
    (8, 10.0, 0.0536573 * 1.09985),
    (16, 10.0, 0.0536573 * 1.02029),
];

fn cantilever(registry: &Registry, across: usize) -> Result<Vec<Check>> {
    let (_, tolerance) = TOLERANCES.into_iter().find(|(from, _)| across >= *from).unwrap_or(TOLERANCES[2]);
    let stiffness = stiffness(registry, across, 5.0)?;
    let source = "finite elements, reference.csv";
    let tolerance = Tolerance::Relative(tolerance);
    let mut checks = vec![Check::new("stiffness", stiffness, ELASTICITY, tolerance, "kN/mm", source)];
    for (_, reference) in SAME_LOAD.into_iter().filter(|(n, _)| *n == across) {
        // The indentation under a point load grows without bound as the spacing falls: the error converges to
        // zero only if the loaded fraction of the end stays the same.
        let name = "stiffness with the same loaded cell";
        checks.push(Check::new(name, stiffness, reference, tolerance, "kN/mm", source).converging());
    }
    for (_, alpha, reference) in DISCRETE.into_iter().filter(|(n, ..)| *n == across) {
        let name = format!("discrete stiffness at alpha {alpha}");
        let measured = self::stiffness(registry, across, alpha)?;
        checks.push(Check::new(
            name,
            measured,
            reference,
            Tolerance::Absolute(1e-5),
            "kN/mm",
            "direct sparse solution",
        ));
    }
    Ok(checks)
}

/// Force over displacement at rest, kN/mm for a thickness of 1 mm.
fn stiffness(registry: &Registry, across: usize, alpha: f64) -> Result<f64> {
    let spacing = 1e-3 / across as f64;
    let mut simulation = Template::new(
        "tests/validation/cantilever/scene.ron",
        include_str!("../../../tests/validation/cantilever/scene.ron"),
    )
    .set("bodies.beam.spacing", spacing)?
    .set("bodies.beam.shape.min", format!("({}, -0.5e-3)", -2.5 * spacing))?
    .set("bodies.beam.shape.max", format!("({}, 0.5e-3)", 8e-3 + 0.5 * spacing))?
    .set("bodies.beam.plugins.hourglass_control.alpha", alpha)?
    .set("conditions.Force.value", format!("(0.0, {LOAD})"))?
    .build(registry)?;
    // The centre of the top right particle itself.
    let corner = DVec3::new(8e-3, 0.5e-3 - 0.5 * spacing, 0.0);
    let loaded = MaterialPoint::new(&simulation, body(&simulation, "beam")?, corner)?;
    relax(&mut simulation)?;
    // N/m for a thickness of 1 m are 1e-9 kN/mm for one of 1 mm.
    Ok(1e-9 * LOAD / loaded.displacement(&simulation)?.y)
}
