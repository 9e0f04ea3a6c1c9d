//! F11: drag of a cylinder in a channel with inlet and outlet, Re 20.

use anyhow::{Context, Result};
use meshless_engine::formulations::fluid::FlowCloud;
use meshless_engine::glam::DVec3;
use meshless_engine::plugin::Registry;
use meshless_engine::world::{Mass, Velocity};

use crate::case::Case;
use crate::check::{Check, Tolerance};
use crate::measure::{Kind, body, run};
use crate::template::Template;

pub(crate) const CASE: Case = Case {
    id: "F11",
    title: "cylinder in a channel with inlet and outlet",
    resolutions: &[10, 14, 20],
    ci_resolution: 10,
    run: cylinder_in_channel,
};

/// Diameter of the cylinder, length of the periodic domain, m.
const DIAMETER: f64 = 0.1;
const LENGTH: f64 = 2.6;
/// Density, kg/m3, mean velocity of the inflow, m/s, and its flux, m2/s.
const DENSITY: f64 = 1000.0;
const VELOCITY: f64 = 0.2;
const FLUX: f64 = VELOCITY * 0.41;
/// Time from which means are taken, s.
const FROM: f64 = 1.5;
/// Drag coefficient: Schaefer and Turek (1996), 5.57 to 5.59.
const DRAG: f64 = 5.58;

fn cylinder_in_channel(registry: &Registry, across: usize) -> Result<Vec<Check>> {
    let path = "tests/validation/cylinder_in_channel/scene.ron";
    let text = include_str!("../../../tests/validation/cylinder_in_channel/scene.ron");
    let template = Template::new(path, text).set("parameters.dx", DIAMETER / across as f64)?;
    let mut simulation = template.build(registry)?;
    let (fluid, cylinder) = (body(&simulation, "fluid")?, body(&simulation, "cylinder")?);
    let (mut momentum, mut force, mut length) = (0.0, 0.0, 0.0);
    let balance = run(&mut simulation, |simulation| {
        let clock = simulation.clock();
        if clock.time > FROM {
            let (view, rows) = simulation.world().body_view(fluid);
            let (mass, velocity) = (view.read::<Mass>()?, view.read::<Velocity>()?);
            momentum += clock.dt * rows.map(|row| mass[row].0 * velocity[row].0.x).sum::<f64>();
            let forces = simulation.resources().get::<FlowCloud>().forces_on(cylinder).context("no fluid")?;
            force += clock.dt * forces.iter().map(|(force, _)| *force).sum::<DVec3>().x;
            length += clock.dt;
        }
        Ok(())
    })?;
    Ok(vec![
        Check::new(
            "drag coefficient",
            force / length / (0.5 * DENSITY * VELOCITY * VELOCITY * DIAMETER),
            DRAG,
            Tolerance::Relative(0.05),
            "1",
            "Schaefer and Turek 1996, 2D-1",
        )
        .converging(),
        // The flux is the same through all planes, and so is its mean over them.
        Check::new(
            "flux of the channel",
            momentum / length / (DENSITY * LENGTH),
            FLUX,
            Tolerance::Relative(0.015),
            "m2/s",
            "that of the inlet",
        ),
        balance.check(Kind::Smooth),
    ])
}
