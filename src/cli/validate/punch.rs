//! S4: a rubber block between two rigid tools.

use anyhow::{Context, Result};
use meshless_engine::plugin::Registry;

use super::case::Case;
use super::check::{Check, Tolerance};
use super::disorder::Disorder;
use super::measure::{body, run};
use super::rigid::state;
use super::template::Template;

pub(super) const CASE: Case =
    Case { id: "S4", title: "punch", resolutions: &[22, 44, 88], ci_resolution: 22, run: punch };

const SOURCE: &str = "this code at 88 across; prototype 5.05e6 at 50 %";

/// `across` is the number of particles over the height of the block.
fn punch(registry: &Registry, across: usize) -> Result<Vec<Check>> {
    let scene = Template::new(
        "tests/validation/punch/scene.ron",
        include_str!("../../../tests/validation/punch/scene.ron"),
    )
    .set("bodies.block.spacing", 3.0e-3 / across as f64)?;
    let mut simulation = scene.clone().build(registry)?;
    let block = body(&simulation, "block")?;
    // Reaction over compression: the mean of both tools.
    let mut reaction: Vec<(f64, f64)> = Vec::new();
    let disorder = Disorder::new(&simulation, block)?;
    run(&mut simulation, |simulation| {
        let (upper, lower) = (state(simulation, "upper")?, state(simulation, "lower")?);
        let gap = upper.center.y - lower.center.y - 0.6e-3;
        reaction.push((1.0 - gap / 3.0e-3, 0.5 * (upper.force.y - lower.force.y)));
        Ok(())
    })?;
    let worst = disorder.measure(&simulation)?;
    let at = |compression: f64| -> Result<f64> {
        let window: Vec<f64> = reaction
            .iter()
            .filter(|(done, _)| (done - compression).abs() < 0.005)
            .map(|(_, force)| *force)
            .collect();
        anyhow::ensure!(!window.is_empty(), "the block was not pressed to {compression}");
        Ok(window.iter().sum::<f64>() / window.len() as f64)
    };
    let energy = simulation.ledger().relative_error().abs();
    let mut without = scene.set("bodies.block.plugins", "[]")?.build(registry)?;
    let pairs = Disorder::new(&without, block)?;
    // It may end early: particles turn inside out.
    let _ = run(&mut without, |_| Ok(()));
    let spoiled = pairs.measure(&without)?;
    let last = reaction.last().context("no step")?;
    anyhow::ensure!(last.0 > 0.5, "pressed to {} only", last.0);
    Ok(vec![
        Check::new("reaction at 10 %", at(0.1)?, REACTION_AT_10, Tolerance::Relative(0.05), "N/m", SOURCE),
        Check::new("reaction at 50 %", at(0.5)?, REACTION_AT_50, Tolerance::Relative(0.05), "N/m", SOURCE),
        Check::below("disorder with control", worst, 0.05, "coherent"),
        Check::above("disorder without control", spoiled, 0.3, "pairing"),
        Check::below("energy balance error", energy, 1e-2, "energy is conserved"),
    ])
}

const REACTION_AT_10: f64 = 7.5e5;
const REACTION_AT_50: f64 = 5.05e6;
