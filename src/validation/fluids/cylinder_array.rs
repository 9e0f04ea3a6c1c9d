//! F16: drag of a square array of cylinders in a slow flow.

use std::f64::consts::PI;

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
    id: "F16",
    title: "square array of cylinders",
    resolutions: &[10, 20, 40],
    ci_resolution: 20,
    run: cylinder_array,
};

/// Radius of the cylinders over the side of the cell, which is 1 m.
const RADIUS: f64 = 0.2;
/// Force on the oil, N/m3; its density, kg/m3, and its viscosity, Pa s, are one.
const DRIVING: f64 = 7.5;
/// Final fraction of the run over which means are taken.
const FROM: f64 = 0.9;

/// Drag over viscosity and mean velocity over the whole cell, for a solid fraction `c`: Sangani and Acrivos
/// (1982).
fn drag(c: f64) -> f64 {
    4.0 * PI / (-0.5 * c.ln() - 0.738 + c - 0.887 * c.powi(2) + 2.038 * c.powi(3))
}

fn cylinder_array(registry: &Registry, across: usize) -> Result<Vec<Check>> {
    let path = "tests/validation/cylinder_array/scene.ron";
    let text = include_str!("../../../tests/validation/cylinder_array/scene.ron");
    let spacing = 1.0 / across as f64;
    let template = Template::new(path, text).set("bodies.oil.spacing", spacing)?;
    let mut simulation = template.set("bodies.cylinder.spacing", spacing)?.build(registry)?;
    let (oil, cylinder) = (body(&simulation, "oil")?, body(&simulation, "cylinder")?);
    let solid = PI * RADIUS * RADIUS;
    let (mut flux, mut force, mut length) = (0.0, 0.0, 0.0);
    let from = FROM * simulation.end();
    let balance = run(&mut simulation, |simulation| {
        let clock = simulation.clock();
        if clock.time > from {
            let (view, rows) = simulation.world().body_view(oil);
            let (mass, velocity) = (view.read::<Mass>()?, view.read::<Velocity>()?);
            flux += clock.dt * rows.map(|row| mass[row].0 * velocity[row].0.x).sum::<f64>();
            let forces = simulation.resources().get::<FlowCloud>().forces_on(cylinder).context("no fluid")?;
            force += clock.dt * forces.iter().map(|(force, _)| *force).sum::<DVec3>().x;
            length += clock.dt;
        }
        Ok(())
    })?;
    let most = if across >= 20 { 0.03 } else { 0.1 };
    // The pressure gradient that the body force replaces also acts on the cylinder: the drag is the body
    // force on the whole cell.
    Ok(vec![
        Check::new(
            "drag over viscosity and mean velocity of the cell",
            DRIVING / (flux / length),
            drag(solid),
            Tolerance::Relative(most),
            "1",
            "Sangani and Acrivos 1982",
        )
        .converging(),
        Check::new(
            "force on the cylinder over that on the oil",
            force / length / (DRIVING * (1.0 - solid)),
            1.0,
            Tolerance::Relative(0.01),
            "1",
            "balance of momentum",
        ),
        balance.check(Kind::Smooth),
    ])
}
