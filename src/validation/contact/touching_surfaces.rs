//! C6: deformable blocks that slide flat on flat.

use anyhow::Result;
use meshless_engine::glam::DVec3;
use meshless_engine::plugin::Registry;
use meshless_engine::simulation::Simulation;
use meshless_engine::world::{Force, ReferencePosition};

use crate::case::Case;
use crate::check::{Check, Tolerance};
use crate::measure::{Balance, Kind, body, run};
use crate::template::Template;

pub(crate) const CASE: Case = Case {
    id: "C6",
    title: "sliding blocks",
    resolutions: &[8, 16, 32],
    ci_resolution: 8,
    run: touching_surfaces,
};

/// Height of the blocks, m.
const BLOCK: f64 = 0.4;

/// `across` is the number of particles over the height of the blocks.
fn touching_surfaces(registry: &Registry, across: usize) -> Result<Vec<Check>> {
    let slides = |friction: f64| -> Result<(Vec<f64>, Balance)> {
        let spacing = BLOCK / across as f64;
        let mut simulation = Template::new(
            "tests/validation/sliding_blocks/scene.ron",
            include_str!("../../../tests/validation/sliding_blocks/scene.ron"),
        )
        .set("bodies.lower.spacing", spacing)?
        .set("bodies.upper.spacing", spacing)?
        .set("contacts[0].friction", friction)?
        .build(registry)?;
        let mut ratios = Vec::new();
        let balance = run(&mut simulation, |simulation| {
            if simulation.clock().time > SLIDING {
                let held = held(simulation, spacing)?;
                ratios.push(held.x / held.y);
            }
            Ok(())
        })?;
        Ok((ratios, balance))
    };
    let (without, balance) = slides(0.0)?;
    let (with, rubbed) = slides(0.3)?;
    let rms = (without.iter().map(|ratio| ratio * ratio).sum::<f64>() / without.len() as f64).sqrt();
    let mean = with.iter().sum::<f64>() / with.len() as f64;
    Ok(vec![
        Check::below("blocks, friction 0: tangential over normal force, rms", rms, 0.01, "no friction")
            .converging(),
        balance.check_of("blocks, friction 0", Kind::Smooth),
        Check::new("blocks, friction 0.3", -mean, 0.3, Tolerance::Relative(0.02), "1", "law of Coulomb"),
        rubbed.check_of("blocks, friction 0.3", Kind::Smooth),
    ])
}

/// Time from which the blocks slide at a constant speed everywhere, s.
const SLIDING: f64 = 1.4;

/// The force on the held side of the upper block, N.
fn held(simulation: &Simulation, spacing: f64) -> Result<DVec3> {
    let (view, rows) = simulation.world().body_view(body(simulation, "upper")?);
    let (force, reference) = (view.read::<Force>()?, view.read::<ReferencePosition>()?);
    let held = rows.filter(|row| reference[*row].0.y > 2.0 * BLOCK - spacing);
    Ok(held.map(|row| force[row].0).sum())
}
