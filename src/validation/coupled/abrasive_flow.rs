//! X4: grains in a flow wear a floor.

use anyhow::{Context, Result};
use meshless_engine::formulations::fluid::FlowCloud;
use meshless_engine::glam::DVec3;
use meshless_engine::plugin::Registry;
use meshless_engine::simulation::Simulation;
use meshless_engine::world::{
    BodyId, Damage, Mass, Position, ReferencePosition, ReferenceVolume, Removed, Velocity,
};

use crate::case::Case;
use crate::check::{Check, Tolerance};
use crate::measure::{Kind, body, run};
use crate::template::Template;

pub(crate) const CASE: Case =
    Case { id: "X4", title: "abrasive flow", resolutions: &[10, 20], ci_resolution: 10, run: abrasive_flow };

/// Height of the floor and of the rectangle on it, m.
const FLOOR: f64 = 4.0e-5;
const RECTANGLE: f64 = 2.0e-5;
/// Width of the rectangle, and of the floor, m.
const WIDTHS: [f64; 2] = [4.0e-5, 2.0e-4];
/// Speed of the flow, m/s.
const SPEED: f64 = 100.0;
/// End of the run, s.
const END: f64 = 1.0e-6;

/// `across` is the number of particles over the height of the rectangle.
fn abrasive_flow(registry: &Registry, across: usize) -> Result<Vec<Check>> {
    let spacing = RECTANGLE / across as f64;
    let mut simulation = Template::new(
        "assets/scenes/abrasive_flow.ron",
        include_str!("../../../assets/scenes/abrasive_flow.ron"),
    )
    .set("parameters.dx", spacing)?
    .set("time.end", END)?
    .set("plugins", "[]")?
    .build(registry)?;
    let (floor, fluid) = (body(&simulation, "floor")?, body(&simulation, "fluid")?);
    let (mut off, mut deepest) = (0.0f64, 0.0f64);
    let balance = run(&mut simulation, |simulation| {
        off = off.max((mean_speed(simulation)? / SPEED - 1.0).abs());
        deepest = deepest.max(deepest_damage(simulation, floor)?);
        Ok(())
    })?;
    let inside = simulation.warnings().iter().filter(|text| text.contains("is inside of")).count();
    let whole = WIDTHS[0] * RECTANGLE;
    let at_start = 2.0 * RECTANGLE * (WIDTHS[0] / WIDTHS[1]) * (1.0 - WIDTHS[0] / WIDTHS[1]);
    let case = "X4";
    Ok(vec![
        Check::above("worn off the rectangle, of its area", worn(&simulation, floor)? / whole, 0.1, case),
        Check::below(
            "Ra over that at the start",
            roughness(&simulation, floor, spacing)? / at_start,
            1.0,
            case,
        ),
        Check::below("depth of damage below the floor, in spacings", deepest / spacing, 5.0, case),
        Check::above(
            "share of worn places that are filled",
            filled(&simulation, floor)?,
            0.9,
            "fluid fills what is worn",
        ),
        Check::new(
            "fluid inside of bodies",
            inside as f64,
            0.0,
            Tolerance::Absolute(0.5),
            "1",
            "nothing passes a surface",
        ),
        Check::below(
            "volume of the fluid that tension has opened",
            opened(&simulation, fluid)?,
            0.02,
            "no voids",
        ),
        Check::below("mean speed, largest deviation", off, 0.02, "kept by the force"),
        balance.check(Kind::Abrupt),
    ])
}

/// Mean speed along x of the fluid and the grains, m/s.
fn mean_speed(simulation: &Simulation) -> Result<f64> {
    let (mut momentum, mut mass) = (0.0, 0.0);
    for (k, body) in simulation.world().bodies().iter().enumerate() {
        if body.name == "fluid" || body.name.starts_with("grain") {
            let (view, rows) = simulation.world().body_view(BodyId(k));
            let (m, v) = (view.read::<Mass>()?, view.read::<Velocity>()?);
            momentum += rows.clone().map(|row| m[row].0 * v[row].0.x).sum::<f64>();
            mass += rows.map(|row| m[row].0).sum::<f64>();
        }
    }
    Ok(momentum / mass)
}

/// How far below the floor there is damage above 0.1, m.
fn deepest_damage(simulation: &Simulation, floor: BodyId) -> Result<f64> {
    let (view, rows) = simulation.world().body_view(floor);
    let (reference, damage) = (view.read::<ReferencePosition>()?, view.read::<Damage>()?);
    let depth = |row: usize| if damage[row].0 > 0.1 { FLOOR - reference[row].0.y } else { 0.0 };
    Ok(rows.map(depth).fold(0.0, f64::max))
}

/// Area of the rectangle that has been worn off, m2.
fn worn(simulation: &Simulation, floor: BodyId) -> Result<f64> {
    let (view, rows) = simulation.world().body_view(floor);
    let (reference, removed) = (view.read::<ReferencePosition>()?, view.read::<Removed>()?);
    let volume = view.read::<ReferenceVolume>()?;
    let gone = |row: &usize| removed[*row] == Removed::YES && reference[*row].0.y > FLOOR;
    Ok(rows.filter(gone).map(|row| volume[row].0).sum())
}

/// Mean deviation of the height of the floor from its mean, m: a second implementation of the probe, column by column.
fn roughness(simulation: &Simulation, floor: BodyId, spacing: f64) -> Result<f64> {
    let (view, rows) = simulation.world().body_view(floor);
    let (position, removed) = (view.read::<Position>()?, view.read::<Removed>()?);
    let count = (WIDTHS[1] / spacing).round() as usize;
    let mut heights = vec![0.0f64; count];
    for row in rows.filter(|&row| removed[row] == Removed::NO) {
        let x = position[row].0.x.rem_euclid(WIDTHS[1]);
        let k = ((x / spacing) as usize).min(count - 1);
        heights[k] = heights[k].max(position[row].0.y);
    }
    let mean = heights.iter().sum::<f64>() / count as f64;
    Ok(heights.iter().map(|z| (z - mean).abs()).sum::<f64>() / count as f64)
}

/// Share of the places of removed particles within a spacing of which there is something else now: fluid, a grain, the rest of the floor.
fn filled(simulation: &Simulation, floor: BodyId) -> Result<f64> {
    let (view, rows) = simulation.world().body_view(floor);
    let (reference, removed) = (view.read::<ReferencePosition>()?, view.read::<Removed>()?);
    let spacing = simulation.world().body(floor).spacing;
    let cloud = simulation.resources().try_get::<FlowCloud>().context("there is no flow")?;
    let is_filled = |x: DVec3| {
        let near = |record: &&meshless_engine::formulations::fluid::FlowParticle| {
            record.volume() > 0.0 && cloud.offset(x, record.position()).length() < spacing
        };
        cloud.records().iter().any(|record| near(&record))
    };
    let gone: Vec<usize> = rows.filter(|&row| removed[row] == Removed::YES).collect();
    let full = gone.iter().filter(|&&row| is_filled(reference[row].0)).count();
    Ok(full as f64 / gone.len() as f64)
}

/// Share of the fluid whose particles have a gap of more than half their volume around them.
fn opened(simulation: &Simulation, fluid: BodyId) -> Result<f64> {
    let cloud = simulation.resources().try_get::<FlowCloud>().context("there is no flow")?;
    let (_, rows) = simulation.world().body_view(fluid);
    let mut open = 0;
    for i in rows.clone() {
        let mut sum = cloud.volume(i) * cloud.kernel.value(0.0);
        cloud.for_each_neighbor(i, |near| sum += near.volume * near.kernel);
        open += usize::from(sum < 0.75);
    }
    Ok(open as f64 / rows.len() as f64)
}
