//! X4: grains in a flow wear a floor.

use std::collections::HashMap;

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
use crate::measure::{Balance, Kind, body, run};
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
/// Initial speeds of the fluid, m/s. Wear is chaotic: runs whose initial speeds differ by a thousandth differ
/// in the worn area by some tens of per cent.
const STARTS: [f64; 5] = [SPEED, 100.1, 99.9, 100.2, 99.8];
/// Maximum depth of damage below the floor away from impacts, in spacings.
const DEPTH: f64 = 5.0;
/// Time in which fluid fills the place of a removed particle, s: the flow travels ten micrometres, half the
/// height of the rectangle.
const FILLING: f64 = 1.0e-7;
/// Number of these runs and their duration, s: at the resolution of the tests, and at others.
const RUNS: [(usize, f64); 2] = [(3, 5.0e-7), (5, 1.0e-6)];

/// `across` is the number of particles over the height of the rectangle.
fn abrasive_flow(registry: &Registry, across: usize) -> Result<Vec<Check>> {
    let (starts, end) = RUNS[usize::from(across != CASE.ci_resolution)];
    let worn: Result<Vec<WornRun>> =
        STARTS[..starts].iter().map(|&speed| wear(registry, across, speed, end)).collect();
    Ok(checks(&worn?))
}

/// Results of a run.
struct WornRun {
    /// Worn area of the rectangle, over its area.
    area: f64,
    /// Ra over its initial value.
    roughness: f64,
    /// Maximum depth of damage below the floor away from impacts, in spacings.
    depth: f64,
    /// Fraction of the places of removed particles that are filled again.
    filled: f64,
    /// Number of warnings of fluid inside of bodies.
    inside: usize,
    /// Fraction of the fluid particles next to a void.
    opened: f64,
    /// Maximum deviation of the mean speed over the speed.
    off: f64,
    balance: Balance,
}

/// Runs the channel from an initial speed of the fluid, m/s, to `end`, s.
fn wear(registry: &Registry, across: usize, speed: f64, end: f64) -> Result<WornRun> {
    let spacing = RECTANGLE / across as f64;
    let mut simulation = Template::new(
        "assets/scenes/abrasive_flow.ron",
        include_str!("../../../assets/scenes/abrasive_flow.ron"),
    )
    .set("parameters.dx", spacing)?
    .set("bodies.fluid.velocity", format!("({speed:?}, 0)"))?
    .set("time.end", end)?
    .set("plugins", "[]")?
    .build(registry)?;
    let (floor, fluid) = (body(&simulation, "floor")?, body(&simulation, "fluid")?);
    let (mut off, mut worn_before) = (0.0f64, Vec::new());
    let balance = run(&mut simulation, |simulation| {
        off = off.max((mean_speed(simulation)? / SPEED - 1.0).abs());
        if simulation.clock().time < end - FILLING {
            worn_before = removed_rows(simulation, floor)?;
        }
        Ok(())
    })?;
    let at_start = 2.0 * RECTANGLE * (WIDTHS[0] / WIDTHS[1]) * (1.0 - WIDTHS[0] / WIDTHS[1]);
    Ok(WornRun {
        area: worn(&simulation, floor)? / (WIDTHS[0] * RECTANGLE),
        roughness: roughness(&simulation, floor, spacing)? / at_start,
        depth: deepest_damage(&simulation, floor, spacing)? / spacing,
        filled: filled(&simulation, floor, &worn_before)?,
        inside: simulation.warnings().iter().filter(|text| text.contains("is inside of")).count(),
        opened: opened(&simulation, fluid)?,
        off,
        balance,
    })
}

/// The checks of all runs: means of random quantities, and the worst values of invariants.
fn checks(runs: &[WornRun]) -> Vec<Check> {
    let mean = |of: fn(&WornRun) -> f64| runs.iter().map(of).sum::<f64>() / runs.len() as f64;
    let largest = |of: fn(&WornRun) -> f64| runs.iter().map(of).fold(f64::NEG_INFINITY, f64::max);
    let inside = largest(|run| run.inside as f64);
    let case = "X4";
    let mut checks = vec![
        Check::above(
            "worn off the rectangle, of its area, mean of all starts",
            mean(|run| run.area),
            0.1,
            case,
        ),
        Check::below("Ra over that at the start, mean of all starts", mean(|run| run.roughness), 1.0, case),
        Check::below("damage away from hits: depth, in spacings", largest(|run| run.depth), DEPTH, case),
        Check::above(
            "share of worn places that are filled, mean of all starts",
            mean(|run| run.filled),
            0.9,
            "fluid fills what is worn",
        ),
        Check::new(
            "fluid inside of bodies",
            inside,
            0.0,
            Tolerance::Absolute(0.5),
            "1",
            "nothing passes a surface",
        ),
        Check::below(
            "volume of the fluid that tension has opened",
            largest(|run| run.opened),
            0.02,
            "no voids",
        ),
        Check::below("mean speed, largest deviation", largest(|run| run.off), 0.02, "kept by the force"),
    ];
    checks.extend(
        runs.iter()
            .zip(STARTS)
            .map(|(run, speed)| run.balance.check_of(&format!("from {speed} m/s"), Kind::Abrupt)),
    );
    checks
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

/// Maximum depth below the floor of damage above 0.1 away from impacts, m: farther than the allowed depth
/// from all removed particles. Material dug out of the floor by a grain may be deeper, with damage around it.
fn deepest_damage(simulation: &Simulation, floor: BodyId, spacing: f64) -> Result<f64> {
    let (view, rows) = simulation.world().body_view(floor);
    let (reference, damage) = (view.read::<ReferencePosition>()?, view.read::<Damage>()?);
    let place = |row: usize| reference[row].0;
    let worn: Vec<DVec3> = removed_rows(simulation, floor)?.into_iter().map(place).collect();
    let is_hit = |x: DVec3| worn.iter().any(|hit| along_period(x - *hit).length() <= DEPTH * spacing);
    let damaged = rows.filter(|&row| damage[row].0 > 0.1).map(place);
    Ok(damaged.filter(|x| !is_hit(*x)).map(|x| FLOOR - x.y).fold(0.0, f64::max))
}

/// The shortest of a vector and its periodic images.
fn along_period(u: DVec3) -> DVec3 {
    DVec3::new(u.x - WIDTHS[1] * (u.x / WIDTHS[1]).round(), u.y, u.z)
}

/// Worn area of the rectangle, m2.
fn worn(simulation: &Simulation, floor: BodyId) -> Result<f64> {
    let (view, rows) = simulation.world().body_view(floor);
    let (reference, removed) = (view.read::<ReferencePosition>()?, view.read::<Removed>()?);
    let volume = view.read::<ReferenceVolume>()?;
    let gone = |row: &usize| removed[*row] == Removed::YES && reference[*row].0.y > FLOOR;
    Ok(rows.filter(gone).map(|row| volume[row].0).sum())
}

/// Mean deviation of the height of the floor from its mean, m: a second implementation of the probe, column
/// by column. What has come off the floor and drifts or lies on it is no part of its surface.
fn roughness(simulation: &Simulation, floor: BodyId, spacing: f64) -> Result<f64> {
    let (view, _) = simulation.world().body_view(floor);
    let position = view.read::<Position>()?;
    let count = (WIDTHS[1] / spacing).round() as usize;
    let mut heights = vec![0.0f64; count];
    for row in attached_rows(simulation, floor, spacing)? {
        let x = position[row].0.x.rem_euclid(WIDTHS[1]);
        let k = ((x / spacing) as usize).min(count - 1);
        heights[k] = heights[k].max(position[row].0.y);
    }
    let mean = heights.iter().sum::<f64>() / count as f64;
    Ok(heights.iter().map(|z| (z - mean).abs()).sum::<f64>() / count as f64)
}

/// Rows of the particles that hang together with the base of the floor, by particles that were next to each
/// other on its square lattice and have not failed.
fn attached_rows(simulation: &Simulation, floor: BodyId, spacing: f64) -> Result<Vec<usize>> {
    let (view, rows) = simulation.world().body_view(floor);
    let (reference, removed) = (view.read::<ReferencePosition>()?, view.read::<Removed>()?);
    let damage = view.read::<Damage>()?;
    let count = (WIDTHS[1] / spacing).round() as i64;
    let cell = |x: DVec3| ((x.x / spacing).floor() as i64, (x.y / spacing).floor() as i64);
    let intact = rows.filter(|&row| removed[row] == Removed::NO && damage[row].0 < 1.0);
    let mut unseen: HashMap<_, _> = intact.map(|row| (cell(reference[row].0), row)).collect();
    let mut next: Vec<_> = (0..count).map(|i| (i, 0)).collect();
    let mut attached = Vec::new();
    while let Some((i, j)) = next.pop() {
        if let Some(row) = unseen.remove(&(i.rem_euclid(count), j)) {
            attached.push(row);
            next.extend((0..9).map(|k| (i + k % 3 - 1, j + k / 3 - 1)));
        }
    }
    Ok(attached)
}

/// Rows of the particles that have been removed.
fn removed_rows(simulation: &Simulation, floor: BodyId) -> Result<Vec<usize>> {
    let (view, rows) = simulation.world().body_view(floor);
    let removed = view.read::<Removed>()?;
    Ok(rows.filter(|&row| removed[row] == Removed::YES).collect())
}

/// Fraction of the places of earlier removed particles with fluid, a grain or the rest of the floor within
/// one spacing now.
fn filled(simulation: &Simulation, floor: BodyId, gone: &[usize]) -> Result<f64> {
    let (view, _) = simulation.world().body_view(floor);
    let reference = view.read::<ReferencePosition>()?;
    let spacing = simulation.world().body(floor).spacing;
    let cloud = simulation.resources().try_get::<FlowCloud>().context("there is no flow")?;
    let is_filled = |x: DVec3| {
        let near = |record: &&meshless_engine::formulations::fluid::FlowParticle| {
            record.volume() > 0.0 && cloud.offset(x, record.position()).length() < spacing
        };
        cloud.records().iter().any(|record| near(&record))
    };
    let full = gone.iter().filter(|&&row| is_filled(reference[row].0)).count();
    Ok(full as f64 / gone.len() as f64)
}

/// Fraction of the fluid particles with a gap of more than half their volume around them.
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
