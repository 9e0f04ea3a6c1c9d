//! F5: the front of a dam break, against the exact flow without friction.

use anyhow::{Context, Result};
use meshless_engine::plugin::Registry;
use meshless_engine::simulation::Simulation;
use meshless_engine::world::{BodyId, Density, Mass, Position};

use crate::case::Case;
use crate::check::{Check, ConvergenceRate, Tolerance};
use crate::measure::{Kind, Record, body, run};
use crate::template::Template;

pub(crate) const CASE: Case = Case {
    id: "F5",
    title: "front of a dam break",
    resolutions: &[20, 40, 80],
    ci_resolution: 20,
    run: dam_front,
};

const REFERENCE: &str = include_str!("../../../tests/validation/dam_front/reference.csv");
const SOURCE: &str = "boundary elements, no friction";
/// Depth of the water where its front is, over the width of the column: 0.02 of its height.
const DEPTH: f64 = 0.04;
/// Positions of the front over the width of the column, and the maximum error of the times at 40 particles
/// across.
const PLACES: [(f64, f64); 4] = [(2.0, 0.035), (3.0, 0.025), (4.0, 0.02), (5.0, 0.02)];

/// Required rate of convergence of these errors, and their maximum extrapolated to zero spacing.
const RATE: ConvergenceRate = ConvergenceRate { per_halving: 1.6, extrapolated: 0.015 };

fn dam_front(registry: &Registry, across: usize) -> Result<Vec<Check>> {
    let spacing = 1.0 / across as f64;
    let side = 4.0 * spacing;
    let path = "tests/validation/dam_front/scene.ron";
    let text = include_str!("../../../tests/validation/dam_front/scene.ron");
    let mut simulation = Template::new(path, text)
        .set("bodies.water.spacing", spacing)?
        .set("bodies.tank.spacing", spacing)?
        .set("bodies.tank.shape[0].min", format!("({}, {})", -side, -side))?
        .build(registry)?;
    let water = body(&simulation, "water")?;
    // T = t sqrt(2 g / a) with a = 1 m.
    let per_time = (2.0 * 9.81f64).sqrt();
    let mut front = Record::default();
    let balance = run(&mut simulation, |simulation| {
        front.push(simulation.clock().time * per_time, foremost(simulation, water, spacing)?);
        Ok(())
    })?;
    // Of the height H = 2 a, in t sqrt(g / H) = T / 2 and x / H = z / 2.
    let exact = Record::read(REFERENCE, "t_sqrt(g/H)", "x_0.02")?;
    let mut checks = Vec::new();
    for (z, error) in PLACES {
        let reached = |record: &Record, level| record.upward_crossings(level).first().copied();
        let measured = reached(&front, z).context("the front does not come so far")?;
        let reference = 2.0 * reached(&exact, 0.5 * z).context("the reference does not come so far")?;
        let tolerance = Tolerance::Relative(error * (40.0 / across as f64).max(1.0));
        let name = format!("T at which the front is at {z} a");
        let check = Check::new(name, measured, reference, tolerance, "1", SOURCE);
        checks.push(check.converging_at(RATE));
    }
    checks.push(balance.check(Kind::Smooth));
    Ok(checks)
}

/// The foremost position with the depth of the front, m: volumes are spread over two spacings to either side.
fn foremost(simulation: &Simulation, water: BodyId, spacing: f64) -> Result<f64> {
    let (view, rows) = simulation.world().body_view(water);
    let (position, mass) = (view.read::<Position>()?, view.read::<Mass>()?);
    let density = view.read::<Density>()?;
    let mut volumes: Vec<(f64, f64)> =
        rows.map(|row| (position[row].0.x, mass[row].0 / density[row].0)).collect();
    volumes.sort_by(|a, b| b.0.total_cmp(&a.0));
    let reach = 2.0 * spacing;
    let depth = |x: f64| {
        let near = volumes.iter().skip_while(|(at, _)| *at > x + reach).take_while(|(at, _)| *at > x - reach);
        near.map(|(at, volume)| volume * (1.0 - (at - x).abs() / reach) / reach).sum::<f64>()
    };
    let first = volumes.first().context("there is no water")?.0 + reach;
    let places = (0..100_000).map(|k| first - 0.05 * spacing * f64::from(k));
    places.into_iter().find(|&x| depth(x) >= DEPTH).context("there is no front")
}
