//! F14: a wedge that enters water at constant speed.

use anyhow::{Context, Result};
use meshless_engine::formulations::fluid::FlowCloud;
use meshless_engine::plugin::Registry;

use crate::case::Case;
use crate::check::{Check, Tolerance};
use crate::measure::{Kind, Record, body, run};
use crate::template::Template;

pub(crate) const CASE: Case = Case {
    id: "F14",
    title: "wedge entering water",
    resolutions: &[13, 26, 52],
    ci_resolution: 13,
    run: wedge_entry,
};

/// The resolution is the half width of the wetted wedge at the end over the spacing; at 13 the spacing is 20
/// mm.
const SPACING: f64 = 0.26;
/// Time at which the apex touches the water, s.
const TOUCH: f64 = 0.005;
/// Force over rho V^3 t of a wedge of 30 degrees.
const FORCE: f64 = 14.139;

fn wedge_entry(registry: &Registry, across: usize) -> Result<Vec<Check>> {
    let spacing = SPACING / across as f64;
    let side = 2.0 + 4.0 * spacing;
    let path = "tests/validation/wedge_entry/scene.ron";
    let text = include_str!("../../../tests/validation/wedge_entry/scene.ron");
    let mut simulation = Template::new(path, text)
        .set("bodies.water.spacing", spacing)?
        .set("bodies.wedge.spacing", spacing)?
        .set("bodies.tank.spacing", spacing)?
        .set("bodies.tank.shape[0].min", format!("({}, {})", -side, -side))?
        .set("bodies.tank.shape[0].max", format!("({side}, 0.3)"))?
        .build(registry)?;
    let wedge = body(&simulation, "wedge")?;
    let mut force = Record::default();
    let balance = run(&mut simulation, |simulation| {
        let time = simulation.clock().time;
        if time >= 0.06 {
            let cloud = simulation.resources().get::<FlowCloud>();
            let forces = cloud.forces_on(wedge).context("the wedge is not in the flow")?;
            let up: f64 = forces.iter().map(|(all, _)| all.y).sum();
            force.push(time, up / (1000.0 * (time - TOUCH)));
        }
        Ok(())
    })?;
    let mean = force.0.iter().map(|sample| sample.1).sum::<f64>() / force.0.len() as f64;
    // 5 % at a spacing of 5 mm, 52 across.
    let tolerance = Tolerance::Relative(0.05 * 52.0 / across as f64);
    Ok(vec![
        Check::new(
            "force over rho V^3 t, mean of 0.06 to 0.1 s",
            mean,
            FORCE,
            tolerance,
            "1",
            "similarity solution",
        )
        .converging(),
        balance.check(Kind::Smooth),
    ])
}
