//! F1: water at rest in a tank.

use anyhow::{Context, Result};
use meshless_engine::plugin::Registry;
use meshless_engine::simulation::Simulation;
use meshless_engine::world::{BodyId, Mass, Position, Pressure};

use crate::case::Case;
use crate::check::{Check, Tolerance};
use crate::measure::{Kind, Record, body, run};
use crate::template::Template;

pub(crate) const CASE: Case = Case {
    id: "F1",
    title: "tank at rest",
    resolutions: &[20, 40, 80],
    ci_resolution: 20,
    run: hydrostatic_tank,
};

/// In equilibrium the floor carries the weight, whatever the water is compressed to.
const SOURCE: &str = "weight over area of the floor";
const GRAVITY: f64 = 9.81;
/// Weight of a volume of water, N/m3.
const WEIGHT: f64 = 1000.0 * GRAVITY;
/// Potential energy of the water, J: rho g H^2 / 2 per metre.
const POTENTIAL: f64 = 4905.0;

/// Mean over the lowest layer of the pressure at the bottom: that of the particle and of the water below its
/// centre.
fn bottom(simulation: &Simulation, water: BodyId) -> Result<f64> {
    let (view, rows) = simulation.world().body_view(water);
    let (position, pressure) = (view.read::<Position>()?, view.read::<Pressure>()?);
    let spacing = simulation.world().body(water).spacing;
    let low: Vec<f64> = rows
        .filter(|&row| position[row].0.y < spacing)
        .map(|row| pressure[row].0 + WEIGHT * position[row].0.y)
        .collect();
    Ok(low.iter().sum::<f64>() / low.len() as f64)
}

/// Weight of the water over the area of the floor, which is 1 m2 per metre, Pa.
fn weight_on_floor(simulation: &Simulation, water: BodyId) -> Result<f64> {
    let (view, rows) = simulation.world().body_view(water);
    let mass = view.read::<Mass>()?;
    Ok(GRAVITY * rows.map(|row| mass[row].0).sum::<f64>())
}

fn hydrostatic_tank(registry: &Registry, across: usize) -> Result<Vec<Check>> {
    let spacing = 1.0 / across as f64;
    let side = 4.0 * spacing;
    let path = "tests/validation/hydrostatic_tank/scene.ron";
    let text = include_str!("../../../tests/validation/hydrostatic_tank/scene.ron");
    let mut simulation = Template::new(path, text)
        .set("bodies.water.spacing", spacing)?
        .set("bodies.tank.spacing", spacing)?
        .set("bodies.tank.shape[0].min", format!("({}, {})", -side, -side))?
        .set("bodies.tank.shape[0].max", format!("({}, 1.2)", 1.0 + side))?
        .build(registry)?;
    let water = body(&simulation, "water")?;
    let weight = weight_on_floor(&simulation, water)?;
    let (mut pressure, mut kinetic) = (Record::default(), Record::default());
    let balance = run(&mut simulation, |simulation| {
        let time = simulation.clock().time;
        pressure.push(time, bottom(simulation, water)?);
        kinetic.push(time, simulation.ledger().total_named("kinetic"));
        Ok(())
    })?;
    let end = simulation.end();
    let largest = kinetic.0.iter().map(|sample| sample.1).reduce(f64::max).context("no sample")?;
    let (early, late) = (kinetic.mean(&(0.0..=0.5 * end))?, kinetic.mean(&(0.5 * end..=end))?);
    Ok(vec![
        Check::new(
            "pressure at the bottom",
            pressure.mean(&(0.25 * end..=end))?,
            weight,
            Tolerance::Relative(if across < 40 { 0.01 } else { 0.005 }),
            "Pa",
            SOURCE,
        )
        .converging(),
        Check::below("largest kinetic over potential energy", largest / POTENTIAL, 1e-5, "at rest"),
        Check::below("kinetic energy, second half over first", late / early, 1.0, "at rest"),
        balance.check(Kind::Smooth),
    ])
}
