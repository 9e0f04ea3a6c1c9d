//! S4: a rubber block between two rigid tools.

use anyhow::{Context, Result};
use meshless_engine::plugin::Registry;

use crate::case::Case;
use crate::check::{Check, Tolerance};
use crate::measure::{Disorder, Kind, body, run, state};
use crate::template::Template;

pub(crate) const CASE: Case =
    Case { id: "S4", title: "punch", resolutions: &[22, 44], ci_resolution: 22, run: punch };

/// Reactions at compressions, N per metre of thickness: corner radius and mesh to zero.
const REACTIONS: [(f64, f64); 4] = [(0.1, 8.20e5), (0.2, 1.691e6), (0.3, 2.620e6), (0.5, 5.09e6)];
const SOURCE: &str = "finite elements, reference.csv";

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
    let balance = run(&mut simulation, |simulation| {
        let (upper, lower) = (state(simulation, "upper")?, state(simulation, "lower")?);
        let gap = upper.center.y - lower.center.y - 0.6e-3;
        reaction.push((1.0 - gap / 3.0e-3, 0.5 * (upper.force.y - lower.force.y)));
        Ok(())
    })?;
    let worst = disorder.measure(&simulation)?;
    // The force falls in steps, whenever a particle slips over the edge of a tool: a line through some of them.
    let at = |compression: f64| -> Result<f64> {
        let near = |done: &f64| (done - compression).abs() < WINDOW;
        let window: Vec<_> = reaction.iter().filter(|(done, _)| near(done)).collect();
        anyhow::ensure!(!window.is_empty(), "the block was not pressed to {compression}");
        let mean = |f: &dyn Fn(f64, f64) -> f64| {
            window.iter().map(|(done, force)| f(done - compression, *force)).sum::<f64>()
                / window.len() as f64
        };
        let (x, y) = (mean(&|x, _| x), mean(&|_, y| y));
        let slope = (mean(&|x, y| x * y) - x * y) / (mean(&|x, _| x * x) - x * x);
        Ok(y - slope * x)
    };
    let mut without = scene.set("bodies.block.plugins", "[]")?.build(registry)?;
    let pairs = Disorder::new(&without, block)?;
    // It may end early: particles turn inside out.
    let _ = run(&mut without, |_| Ok(()));
    let spoiled = pairs.measure(&without)?;
    let last = reaction.last().context("no step")?;
    anyhow::ensure!(last.0 > 0.5, "pressed to {} only", last.0);
    // At half height a particle beside an edge of a tool is nearly two spacings wide.
    let smooth = if across < 44 { 0.12 } else { 0.1 };
    let mut checks = Vec::new();
    for (compression, reaction) in REACTIONS {
        let name = format!("reaction at {:.0} %", 100.0 * compression);
        let tolerance = Tolerance::Relative(if compression > 0.4 { 0.05 } else { 0.03 });
        checks.push(Check::new(name, at(compression)?, reaction, tolerance, "N/m", SOURCE));
    }
    checks.extend([
        Check::below("hourglass residual with control", worst, smooth, "smooth"),
        Check::above("hourglass residual without control", spoiled, 0.3, "pairing"),
        balance.check(Kind::Inelastic),
    ]);
    Ok(checks)
}

/// Half the range of compression that the line is taken over.
const WINDOW: f64 = 0.02;
