//! F8: a box that floats.

use anyhow::Result;
use meshless_engine::glam::DVec3;
use meshless_engine::plugin::Registry;
use meshless_engine::simulation::Simulation;
use meshless_engine::world::{BodyId, Force, Mass, Position};

use crate::case::Case;
use crate::check::{Check, Tolerance};
use crate::measure::{Kind, body, momentum, rounded_forces, run, state};
use crate::template::Template;

pub(crate) const CASE: Case =
    Case { id: "F8", title: "floating box", resolutions: &[8, 16], ci_resolution: 8, run: floating_box };

const GRAVITY: DVec3 = DVec3::new(0.0, -9.81, 0.0);
/// Half the height of the box, m: its density is half that of water.
const DRAUGHT: f64 = 0.05;
const SOURCE: &str = "Archimedes";
/// Columns of water nearer to the box than this, over its half-width, are omitted.
const APART: f64 = 1.5;

/// Height of the water away from the box, m: the top of the highest particle in every column, on average.
fn level(simulation: &Simulation, water: BodyId, center: f64) -> Result<f64> {
    let (view, rows) = simulation.world().body_view(water);
    let position = view.read::<Position>()?;
    let spacing = simulation.world().body(water).spacing;
    let mut tops = vec![f64::NEG_INFINITY; (1.0 / spacing).round() as usize];
    for row in rows {
        let x = position[row].0;
        let column = ((x.x / spacing) as usize).min(tops.len() - 1);
        tops[column] = tops[column].max(x.y + 0.5 * spacing);
    }
    let middle = |column: usize| (column as f64 + 0.5) * spacing;
    let free = (0..tops.len()).filter(|&k| (middle(k) - center).abs() > 0.1 * APART);
    let heights: Vec<f64> = free.map(|k| tops[k]).filter(|top| top.is_finite()).collect();
    Ok(heights.iter().sum::<f64>() / heights.len() as f64)
}

/// Mass of some bodies, kg.
fn mass(simulation: &Simulation, bodies: [BodyId; 2]) -> Result<f64> {
    let mut total = 0.0;
    for body in bodies {
        let (view, rows) = simulation.world().body_view(body);
        total += view.read::<Mass>()?[rows].iter().map(|mass| mass.0).sum::<f64>();
    }
    Ok(total)
}

/// External force on water and box, N: their weight, and the opposite of their force on the tank.
fn outside(simulation: &Simulation, bodies: [BodyId; 2], tank: BodyId) -> Result<DVec3> {
    let (view, rows) = simulation.world().body_view(tank);
    let force = view.read::<Force>()?;
    Ok(mass(simulation, bodies)? * GRAVITY - rows.map(|row| force[row].0).sum::<DVec3>())
}

fn floating_box(registry: &Registry, across: usize) -> Result<Vec<Check>> {
    let spacing = 0.1 / across as f64;
    let side = 4.0 * spacing;
    let path = "tests/validation/floating_box/scene.ron";
    let text = include_str!("../../../tests/validation/floating_box/scene.ron");
    let mut simulation = Template::new(path, text)
        .set("bodies.water.spacing", spacing)?
        .set("bodies.tank.spacing", spacing)?
        .set("bodies.box.spacing", spacing)?
        .set("bodies.tank.shape[0].min", format!("({}, {})", -side, -side))?
        .set("bodies.tank.shape[0].max", format!("({}, 0.5)", 1.0 + side))?
        .build(registry)?;
    let (water, tank) = (body(&simulation, "water")?, body(&simulation, "tank")?);
    let moving = [water, body(&simulation, "box")?];
    let weight = mass(&simulation, moving)? * GRAVITY.length();
    let half = 0.5 * simulation.end();
    let (mut draught, mut samples, mut tilt) = (0.0, 0.0, 0.0f64);
    let (mut impulse, mut force, mut start) = (DVec3::ZERO, DVec3::ZERO, DVec3::ZERO);
    let (mut lost, mut given, mut in_a_step, mut before) = (0.0f64, 0.0, 0.0f64, DVec3::ZERO);
    let balance = run(&mut simulation, |simulation| {
        let now = outside(simulation, moving, tank)?;
        let carried = momentum(simulation, moving)?;
        if simulation.clock().step == 0 {
            start = carried;
        } else {
            let dt = simulation.clock().dt;
            let of_step = 0.5 * dt * (force + now);
            impulse += of_step;
            lost = lost.max((carried - start - impulse).length());
            in_a_step =
                in_a_step.max((carried - before - of_step).length() / (dt * rounded_forces(simulation)));
            given += dt * weight;
        }
        (force, before) = (now, carried);
        if simulation.clock().time >= half {
            let state = state(simulation, "box")?;
            draught += level(simulation, water, state.center.x)? - (state.center.y - DRAUGHT);
            tilt = tilt.max((state.rotation * DVec3::X).y.abs());
            samples += 1.0;
        }
        Ok(())
    })?;
    Ok(vec![
        Check::new("draught", draught / samples, DRAUGHT, Tolerance::Relative(0.03), "m", SOURCE),
        Check::below(
            "change of momentum of water and box in a step, over that by rounding",
            in_a_step,
            1.0,
            "pair forces are opposites, and rounded",
        ),
        Check::below(
            "momentum of water and box",
            lost / given,
            1e-6,
            "pair forces are opposites, and rounded",
        ),
        Check::below("sine of the largest tilt", tilt, 1e-2, "the box floats upright"),
        balance.check(Kind::Smooth),
    ])
}
