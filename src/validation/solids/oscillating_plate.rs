//! S8: large-amplitude oscillation of a thin plate.

use anyhow::{Context, Result};
use meshless_engine::glam::DVec3;
use meshless_engine::plugin::Registry;

use crate::case::Case;
use crate::check::{Check, Tolerance};
use crate::measure::{Kind, MaterialPoint, Record, body, run};
use crate::template::Template;

pub(crate) const CASE: Case = Case {
    id: "S8",
    title: "oscillating plate",
    resolutions: &[10, 14, 20],
    ci_resolution: 10,
    run: oscillating_plate,
};

const SOURCE: &str = "spectral elements, reference.csv";

/// A plate that oscillates.
#[derive(Clone, Copy)]
pub(crate) struct SwingingPlate {
    /// Thickness, m.
    pub thickness: f64,
    /// Period, s.
    pub period: f64,
    /// Amplitude, m.
    pub amplitude: f64,
}

pub(crate) const PLATES: [SwingingPlate; 2] = [
    SwingingPlate { thickness: 0.02, period: 0.25485194, amplitude: 0.10659491 },
    SwingingPlate { thickness: 0.01, period: 0.49992132, amplitude: 0.16399172 },
];

fn oscillating_plate(registry: &Registry, across: usize) -> Result<Vec<Check>> {
    // Decay is measured over 2.5 s; one oscillation is enough for the rest, and for the cheapest run.
    let long = across > CASE.ci_resolution;
    let plates = PLATES.iter().map(|of| plate(registry, across, *of, long));
    Ok(plates.collect::<Result<Vec<_>>>()?.concat())
}

/// Runs the plate of a thickness, with its period and amplitude; `long` enough to measure its decay.
pub(super) fn plate(
    registry: &Registry,
    across: usize,
    reference: SwingingPlate,
    long: bool,
) -> Result<Vec<Check>> {
    let mut checks = Vec::new();
    let thickness = reference.thickness;
    let spacing = thickness / across as f64;
    let end = if long { 2.5 } else { 1.1 * reference.period };
    let mut simulation = Template::new(
        "tests/validation/oscillating_plate/scene.ron",
        include_str!("../../../tests/validation/oscillating_plate/scene.ron"),
    )
    .set("bodies.plate.spacing", spacing)?
    .set("bodies.plate.shape.min", format!("({}, {})", -3.0 * spacing, -0.5 * thickness))?
    .set("bodies.plate.shape.max", format!("(0.2, {})", 0.5 * thickness))?
    .set("time.end", end)?
    .build(registry)?;
    let tip = MaterialPoint::new(&simulation, body(&simulation, "plate")?, DVec3::new(0.2, 0.0, 0.0))?;
    let mut deflection = Record::default();
    let balance = run(&mut simulation, |simulation| {
        deflection.push(simulation.clock().time, tip.displacement(simulation)?.y);
        Ok(())
    })?;
    let crossings = deflection.upward_crossings(0.0);
    let period =
        *crossings.iter().find(|&&t| t > 0.5 * reference.period).context("the plate does not swing")?;
    let (_, amplitude) = deflection.clone().until(period).maximum()?;
    let name = |what: &str| format!("h = {thickness} m: {what}");
    let swing = Check::new(name("period"), period, reference.period, Tolerance::Relative(0.02), "s", SOURCE);
    // In the thin plate the bending stiffness of the control and the softness of the clamp cancel each other
    // at 10 across; both fall, their sum does not.
    checks.push(if thickness > 0.015 { swing.converging() } else { swing });
    checks.push(
        Check::new(name("amplitude"), amplitude, reference.amplitude, Tolerance::Relative(0.05), "m", SOURCE)
            .converging(),
    );
    checks.push(balance.check_of(&format!("h = {thickness} m"), Kind::Smooth));
    if end > 2.0 {
        let last = Record(deflection.0.into_iter().filter(|s| s.0 > end - 1.1 * period).collect());
        let decay = 1.0 - last.0.iter().map(|s| s.1).fold(0.0, f64::max) / amplitude;
        checks.push(Check::below(name("decay over 2.5 s"), decay, 0.05, "energy is conserved"));
    }
    Ok(checks)
}
