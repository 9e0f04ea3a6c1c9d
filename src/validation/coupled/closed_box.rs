//! X5: fluid, solid and rigid body in a closed periodic box.

use anyhow::Result;
use meshless_engine::glam::DVec3;
use meshless_engine::plugin::Registry;

use crate::case::Case;
use crate::check::Check;
use crate::measure::{Kind, body, momentum, run};
use crate::template::Template;

pub(crate) const CASE: Case = Case {
    id: "X5",
    title: "momentum of fluid, solid and rigid body",
    resolutions: &[7, 14],
    ci_resolution: 7,
    run: closed_box,
};

fn closed_box(registry: &Registry, across: usize) -> Result<Vec<Check>> {
    let spacing = 0.14 / across as f64;
    let text = include_str!("../../../tests/validation/closed_box/scene.ron");
    let mut simulation = Template::new("tests/validation/closed_box/scene.ron", text)
        .set("bodies.water.spacing", spacing)?
        .set("bodies.block.spacing", 0.5 * spacing)?
        .set("bodies.box.spacing", spacing)?
        .build(registry)?;
    let bodies = [body(&simulation, "water")?, body(&simulation, "block")?, body(&simulation, "box")?];
    let mut start: Option<DVec3> = None;
    let (mut lost, mut passed, mut box_at_start) = (0.0f64, 0.0f64, DVec3::ZERO);
    let balance = run(&mut simulation, |simulation| {
        let now = momentum(simulation, bodies)?;
        let own = momentum(simulation, [bodies[2]])?;
        match start {
            Some(start) => lost = lost.max((now - start).length() / start.length()),
            None => (start, box_at_start) = (Some(now), own),
        }
        passed = passed.max((own - box_at_start).length() / box_at_start.length());
        Ok(())
    })?;
    let (_, short) = simulation.sub_steps().unwrap_or_default();
    let per_step = short as f64 / simulation.clock().step as f64;
    Ok(vec![
        Check::below("change of momentum", lost, 1e-10, "momentum is conserved"),
        Check::above("momentum that the box has passed on", passed, 0.5, "the water drags it along"),
        Check::above("sub-steps in a step", per_step, 4.0, "the rubber is stiff"),
        balance.check(Kind::Abrupt),
    ])
}
