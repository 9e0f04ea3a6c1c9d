//! X5: fluid, solid and rigid body in a closed periodic box.

use anyhow::Result;
use meshless_engine::glam::DVec3;
use meshless_engine::plugin::Registry;

use crate::case::Case;
use crate::check::Check;
use crate::measure::{Balance, Kind, body, momentum, rounded_forces, run};
use crate::template::Template;

pub(crate) const CASE: Case = Case {
    id: "X5",
    title: "momentum of fluid, solid and rigid body",
    resolutions: &[7, 14],
    ci_resolution: 7,
    run: closed_box,
};

/// Results of a run.
struct BoxRun {
    /// Maximum change of momentum since the start, over the initial momentum.
    lost: f64,
    /// Maximum change of momentum in a step, over that by rounding.
    in_a_step: f64,
    /// Maximum change of the momentum of the box, over its initial momentum.
    passed: f64,
    per_step: f64,
    balance: Balance,
}

fn closed_box(registry: &Registry, across: usize) -> Result<Vec<Check>> {
    let double = run_in("Double", registry, across)?;
    let mixed = run_in("Mixed", registry, across)?;
    Ok(vec![
        Check::below("change of momentum", double.lost, 1e-10, "momentum is conserved"),
        Check::below(
            "change of momentum in a step in single precision, over that by rounding",
            mixed.in_a_step,
            1.0,
            "forces are rounded",
        ),
        Check::below("change of momentum in single precision", mixed.lost, 1e-6, "forces are rounded"),
        Check::above("momentum that the box has passed on", mixed.passed, 0.5, "the water drags it along"),
        Check::above("sub-steps in a step", mixed.per_step, 4.0, "the rubber is stiff"),
        mixed.balance.check(Kind::Abrupt),
    ])
}

fn run_in(precision: &str, registry: &Registry, across: usize) -> Result<BoxRun> {
    let spacing = 0.14 / across as f64;
    let text = include_str!("../../../tests/validation/closed_box/scene.ron");
    let mut simulation = Template::new("tests/validation/closed_box/scene.ron", text)
        .set("precision", precision)?
        .set("bodies.water.spacing", spacing)?
        .set("bodies.block.spacing", 0.5 * spacing)?
        .set("bodies.box.spacing", spacing)?
        .build(registry)?;
    let bodies = [body(&simulation, "water")?, body(&simulation, "block")?, body(&simulation, "box")?];
    let mut start: Option<DVec3> = None;
    let (mut lost, mut passed, mut in_a_step) = (0.0f64, 0.0f64, 0.0f64);
    let (mut before, mut box_at_start) = (DVec3::ZERO, DVec3::ZERO);
    let balance = run(&mut simulation, |simulation| {
        let now = momentum(simulation, bodies)?;
        let own = momentum(simulation, [bodies[2]])?;
        match start {
            Some(start) => {
                lost = lost.max((now - start).length() / start.length());
                let forces = simulation.clock().dt * rounded_forces(simulation);
                in_a_step = in_a_step.max((now - before).length() / forces);
            }
            None => (start, box_at_start) = (Some(now), own),
        }
        before = now;
        passed = passed.max((own - box_at_start).length() / box_at_start.length());
        Ok(())
    })?;
    let (_, short) = simulation.sub_steps().unwrap_or_default();
    let per_step = short as f64 / simulation.clock().step as f64;
    Ok(BoxRun { lost, in_a_step, passed, per_step, balance })
}
