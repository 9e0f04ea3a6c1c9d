//! The flux of a viscous channel, a part of F13.

use anyhow::Result;
use meshless_engine::plugin::Registry;
use meshless_engine::simulation::Simulation;
use meshless_engine::world::{BodyId, Velocity};

use crate::check::{Check, Tolerance};
use crate::measure::{body, run};
use crate::template::Template;

/// Tolerance of the flux at 40 across, proportional to the spacing.
const FLUX: f64 = 0.015;
/// Particles across from which a run has its full duration.
const FINE: usize = 20;
/// Duration of the run over H^2 / nu, full and short. Rows break up within the first tenth.
const WHOLE: f64 = 3.0;
const SHORT: f64 = 0.4;

/// Flux over that of the exact profile, averaged over the last quarter of the run.
pub(super) fn flux(registry: &Registry, across: usize, reynolds: f64, lattice: &str) -> Result<Check> {
    let spacing = 1.0 / across as f64;
    let (length, side) = (8.0 * spacing.min(0.125), 4.0 * spacing);
    let end = reynolds * if across < FINE { SHORT } else { WHOLE };
    let path = "tests/validation/viscous_channel/scene.ron";
    let text = include_str!("../../../tests/validation/viscous_channel/scene.ron");
    let mut template = Template::new(path, text)
        .set("parameters.nu", 1.0 / reynolds)?
        .set("domain.max", format!("({length:?}, 2.0)"))?
        .set("bodies.fluid.lattice", lattice)?
        .set("time.end", end)?;
    for (name, low, high) in [("fluid", 0.0, 1.0), ("lower", -side, 0.0), ("upper", 1.0, 1.0 + side)] {
        template = template
            .set(&format!("bodies.{name}.spacing"), spacing)?
            .set(&format!("bodies.{name}.shape.min"), format!("(0.0, {low:?})"))?
            .set(&format!("bodies.{name}.shape.max"), format!("({length:?}, {high:?})"))?;
    }
    let mut simulation = template.build(registry)?;
    let fluid = body(&simulation, "fluid")?;
    let (mut sum, mut samples) = (0.0, 0.0);
    run(&mut simulation, |simulation| {
        if simulation.clock().time >= 0.75 * end {
            sum += mean_velocity(simulation, fluid)?;
            samples += 1.0;
        }
        Ok(())
    })?;
    let name = lattice.split('(').next().unwrap_or(lattice).to_lowercase();
    Ok(Check::new(
        format!("flux of a channel, Re {reynolds}, {name}"),
        sum / samples,
        2.0 / 3.0,
        Tolerance::Relative(FLUX * 40.0 / across as f64),
        "m2/s",
        "closed form",
    ))
}

/// Mean velocity along the channel, m/s; the channel is 1 m wide.
fn mean_velocity(simulation: &Simulation, fluid: BodyId) -> Result<f64> {
    let (view, rows) = simulation.world().body_view(fluid);
    let velocity = view.read::<Velocity>()?;
    let count = rows.len() as f64;
    Ok(rows.map(|row| velocity[row].0.x).sum::<f64>() / count)
}
