//! S5: rubber pulled to six times its length.

use anyhow::Result;
use meshless_engine::glam::DVec3;
use meshless_engine::plugin::Registry;
use meshless_engine::simulation::Simulation;
use meshless_engine::world::{Force, ReferencePosition};

use crate::case::Case;
use crate::check::{Check, Tolerance};
use crate::measure::{Disorder, MaterialPoint, body, run_until};
use crate::template::Template;

pub(crate) const CASE: Case =
    Case { id: "S5", title: "rubber pull", resolutions: &[10, 20, 30], ci_resolution: 10, run: rubber_pull };

const SOURCE: &str = "finite elements, reference.csv";
/// Force at 1.05 times the length, N/m: reference.csv.
const FIRST_FORCE: f64 = 141.766e3;
/// Stretch, end of its hold, force and half width in the middle: s, N/m for a thickness of 1 m, m; tolerance.
const STAGES: [(f64, f64, f64, f64, f64); 2] =
    [(3.0, 0.6e-3, 2232.0e3, 0.337e-3, 0.04), (6.0, 1.45e-3, 4280.0e3, 0.179e-3, 0.08)];

fn rubber_pull(registry: &Registry, across: usize) -> Result<Vec<Check>> {
    let mut checks = vec![
        Check::new(
            "force at 1.05 times the length",
            first_force(registry, across)?,
            FIRST_FORCE,
            Tolerance::Relative(0.01),
            "N/m",
            SOURCE,
        )
        .converging(),
    ];
    let (mut simulation, disorder) = sheet(registry, across, 5.0)?;
    let side = MaterialPoint::new(&simulation, body(&simulation, "sheet")?, DVec3::new(1e-3, 0.0, 0.0))?;
    for (stretch, time, force, half_width, tolerance) in STAGES {
        run_until(&mut simulation, time)?;
        let name = |what: &str| format!("{what} at {stretch} times the length");
        let tolerance = Tolerance::Relative(tolerance);
        let (top, bottom) = reactions(&simulation)?;
        checks.push(Check::new(name("force"), top, force, tolerance, "N/m", SOURCE).converging());
        let width = side.position(&simulation)?.x;
        checks.push(Check::new(name("half width"), width, half_width, tolerance, "m", SOURCE).converging());
        checks.push(Check::below(name("top over bottom force"), (top / bottom + 1.0).abs(), 1e-3, "balance"));
        let ledger = simulation.ledger();
        let moving = ledger.total_named("kinetic") / ledger.total_named("strain");
        checks.push(Check::below(name("kinetic over strain energy"), moving, 1e-3, "at rest"));
    }
    let with = disorder.measure(&simulation)?;
    checks.push(Check::below("hourglass residual at 6 times the length", with, 0.3, "not spoiled"));
    checks.push(Check::above(
        "hourglass residual without control",
        disorder_without(registry, across)?,
        0.3,
        "spoiled",
    ));
    Ok(checks)
}

/// Maximum disorder during the run, without control. An inverted particle ends the run and counts as infinite
/// disorder.
fn disorder_without(registry: &Registry, across: usize) -> Result<f64> {
    let (mut simulation, disorder) = sheet(registry, across, 0.0)?;
    let mut largest = 0.0f64;
    for k in 1..=20 {
        let time = simulation.end() * f64::from(k) / 20.0;
        match run_until(&mut simulation, time) {
            Err(error) if is_torn(&format!("{error:#}")) => return Ok(f64::INFINITY),
            other => other?,
        }
        largest = largest.max(disorder.measure(&simulation)?);
    }
    Ok(largest)
}

/// Whether an error reports an inverted particle, or one so nearly inverted that no step is small enough.
fn is_torn(error: &str) -> bool {
    error.contains("det F <= 0")
        || error.contains("limited by wave speed of `sheet` at a stretch factor of 0.00")
}

/// Force on the upper and on the lower clamp, N/m.
fn reactions(simulation: &Simulation) -> Result<(f64, f64)> {
    let (view, rows) = simulation.world().body_view(body(simulation, "sheet")?);
    let reference = view.read::<ReferencePosition>()?;
    let force = view.read::<Force>()?;
    let sum =
        |side: f64| rows.clone().filter(|&k| side * reference[k].0.y > 0.99e-3).map(|k| -force[k].0.y).sum();
    Ok((sum(1.0), sum(-1.0)))
}

/// Force on the upper clamp at a small stretch, N/m: it depends on the position of the edges of the clamps.
fn first_force(registry: &Registry, across: usize) -> Result<f64> {
    let pull = |sign: &str| format!("(0.0, \"{sign}5e-5*smoothstep(t/0.3e-3)\")");
    let mut simulation = template(across, 5.0)?
        .set("conditions[0].value", pull(""))?
        .set("conditions[1].value", pull("-"))?
        .build(registry)?;
    run_until(&mut simulation, 0.4e-3)?;
    Ok(reactions(&simulation)?.0)
}

fn template(across: usize, alpha: f64) -> Result<Template> {
    let spacing = 2e-3 / across as f64;
    let end = 1e-3 + 3.0 * spacing;
    Template::new(
        "tests/validation/rubber_pull/scene.ron",
        include_str!("../../../tests/validation/rubber_pull/scene.ron"),
    )
    .set("bodies.sheet.spacing", spacing)?
    .set("bodies.sheet.shape.min", format!("(-1e-3, {})", -end))?
    .set("bodies.sheet.shape.max", format!("(1e-3, {end})"))?
    .set("bodies.sheet.plugins.hourglass_control.alpha", alpha)
}

fn sheet(registry: &Registry, across: usize, alpha: f64) -> Result<(Simulation, Disorder)> {
    let simulation = template(across, alpha)?.build(registry)?;
    // Without the corners of the clamps, where the deformation gradient is singular.
    let disorder =
        Disorder::within(&simulation, body(&simulation, "sheet")?, |point| point.y.abs() < 0.5e-3)?;
    Ok((simulation, disorder))
}
