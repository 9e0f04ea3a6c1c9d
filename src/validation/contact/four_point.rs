//! C6b: a beam in four-point bending on fixed rollers.

use anyhow::{Context, Result};
use meshless_engine::glam::DVec3;
use meshless_engine::plugin::Registry;
use meshless_engine::simulation::Simulation;

use crate::case::Case;
use crate::check::{Check, Tolerance};
use crate::measure::{MaterialPoint, body, relax, state};
use crate::template::Template;

pub(crate) const CASE: Case = Case {
    id: "C6b",
    title: "four-point bending on fixed rollers",
    resolutions: &[8, 16, 32],
    ci_resolution: 8,
    run: four_point,
};

/// Height of the beam, m.
const HEIGHT: f64 = 0.1;
/// Deflection of the neutral axis between the supports and the middle, m, and stress at the lower and the
/// upper side in the middle, Pa: plane elasticity with point loads, by nine-node finite elements, whose
/// results with 16, 32 and 64 elements over the height agree to five digits. Beam theory with a shear strain
/// of Q / (G A) gives 2.262e-4 m, and 6e5 Pa at both sides; it neglects the compression of the beam under the
/// rollers.
const DEFLECTION: f64 = 2.2587e-4;
const SIDES: [(&str, f64); 2] = [("lower", 6.0556e5), ("upper", -5.9422e5)];
/// Force on each support, N, and its arm to the roller above, m.
const FORCE: f64 = 1e4;
const ARM: f64 = 0.1;
/// Half the length of the line along which the scene probes the stress, m.
const LINE: f64 = 0.04;

/// `across` is the number of particles over the height of the beam.
fn four_point(registry: &Registry, across: usize) -> Result<Vec<Check>> {
    let mut simulation = Template::new(
        "tests/validation/four_point/scene.ron",
        include_str!("../../../tests/validation/four_point/scene.ron"),
    )
    .set("bodies.beam.spacing", HEIGHT / across as f64)?
    .build(registry)?;
    let beam = body(&simulation, "beam")?;
    let middle = MaterialPoint::new(&simulation, beam, DVec3::ZERO)?;
    let support = MaterialPoint::new(&simulation, beam, DVec3::new(0.2, 0.0, 0.0))?;
    relax(&mut simulation)?;
    let deflection = support.displacement(&simulation)?.y - middle.displacement(&simulation)?.y;
    let tolerance = Tolerance::Relative(if across < 16 { 0.03 } else { 0.015 });
    let source = "plane elasticity";
    let mut checks =
        vec![Check::new("deflection", deflection, DEFLECTION, tolerance, "m", source).converging()];
    // The tolerance of the stiffness of a cantilever, S2: at few particles across, the hourglass control
    // carries a part of the moment.
    let tolerance = Tolerance::Relative([0.04, 0.02, 0.015][across.ilog2().clamp(3, 5) as usize - 3]);
    let bending = 12.0 * FORCE * ARM / HEIGHT.powi(3);
    let slope = slope(&simulation)?;
    checks.push(Check::new("slope of the stress", slope, -bending, tolerance, "Pa/m", "M / I").converging());
    for (side, stress) in SIDES {
        let shown = simulation.measure(side)?;
        let measured = shown.first().with_context(|| format!("the scene has no probe `{side}`"))?.1;
        let tolerance = Tolerance::Relative(0.64 / across as f64);
        let name = format!("bending stress, {side} side");
        checks.push(Check::new(name, measured, stress, tolerance, "Pa", source).converging());
    }
    for roller in ["left", "right"] {
        let force = state(&simulation, roller)?.force;
        let (name, tolerance) = (format!("force on the {roller} support"), Tolerance::Relative(1e-3));
        checks.push(Check::new(name, force.y, -FORCE, tolerance, "N", "equilibrium"));
        let name = format!("{roller} support: horizontal over vertical force");
        checks.push(Check::below(name, (force.x / force.y).abs(), 0.01, "no friction"));
    }
    Ok(checks)
}

/// Gradient of the stress along the beam over the height in the middle, Pa/m: least squares along the line.
fn slope(simulation: &Simulation) -> Result<f64> {
    let shown = simulation.measure("stress")?;
    let last = shown.len().saturating_sub(1).max(1) as f64;
    let (mut moment, mut square) = (0.0, 0.0);
    for (k, (_, stress)) in shown.iter().enumerate() {
        let y = LINE * (2.0 * k as f64 / last - 1.0);
        moment += stress * y;
        square += y * y;
    }
    Ok(moment / square)
}
