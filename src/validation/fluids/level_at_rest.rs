//! F15: the level of water at rest, with and without shifting, in two and three dimensions.

use anyhow::{Result, ensure};
use meshless_engine::plugin::Registry;
use meshless_engine::world::{Mass, Position, Removed};

use crate::case::Case;
use crate::check::{Check, Tolerance};
use crate::measure::{body, run};
use crate::template::Template;

pub(crate) const CASE: Case = Case {
    id: "F15",
    title: "level at rest",
    resolutions: &[10, 20, 40],
    ci_resolution: 10,
    run: level_at_rest,
};

/// Area of the water over the length of the tank, m.
const LEVEL: f64 = 0.2;
/// Tolerance from that many particles over the level on; with fewer it is proportional to the spacing.
const TOLERANCE: f64 = 0.01;
const DEEP: f64 = 8.0;
/// Resolution from which on the run in three dimensions without shifting is part of the case.
const FINE: usize = 20;
const SHIFTED: &str =
    "[density_diffusion(), artificial_viscosity(alpha: 0.05, beta: 0.0), particle_shifting()]";

fn level_at_rest(registry: &Registry, across: usize) -> Result<Vec<Check>> {
    let mut checks = Vec::new();
    for solid in [false, true] {
        // In three dimensions the coarse run is only the one with shifting.
        for shifted in [false, true].into_iter().filter(|&shifted| shifted || !solid || across >= FINE) {
            checks.extend(settle(registry, across, solid, shifted)?);
        }
    }
    Ok(checks)
}

/// `solid` in three dimensions, in a tank 0.2 m wide.
fn settle(registry: &Registry, across: usize, solid: bool, shifted: bool) -> Result<[Check; 2]> {
    let spacing = 0.4 / if solid { (across / 2).max(8) } else { across } as f64;
    let side = 4.0 * spacing;
    let path = "tests/validation/level_at_rest/scene.ron";
    let text = include_str!("../../../tests/validation/level_at_rest/scene.ron");
    let place = |x: f64, y: f64, z: f64| {
        if solid { format!("({x:?}, {y:?}, {z:?})") } else { format!("({x:?}, {y:?})") }
    };
    let mut template = Template::new(path, text)
        .set("dimension", if solid { "Three" } else { "Two" })?
        .set("bodies.water.spacing", spacing)?
        .set("bodies.water.shape.min", place(0.0, 0.0, 0.0))?
        .set("bodies.water.shape.max", place(0.4, 0.4, 0.2))?
        .set("bodies.tank.spacing", spacing)?
        .set("bodies.tank.shape[0].min", place(-side, -side, -side))?
        .set("bodies.tank.shape[0].max", place(0.8 + side, 1.2, 0.2 + side))?
        .set("bodies.tank.shape[1].min", place(0.0, 0.0, 0.0))?
        .set("bodies.tank.shape[1].max", place(0.8, 2.0, 0.2))?;
    if shifted {
        template = template.set("bodies.water.plugins", SHIFTED)?;
    }
    let mut simulation = template.build(registry)?;
    let water = body(&simulation, "water")?;
    run(&mut simulation, |_| Ok(()))?;
    let (view, rows) = simulation.world().body_view(water);
    let (position, mass, removed) = (view.read::<Position>()?, view.read::<Mass>()?, view.read::<Removed>()?);
    ensure!(rows.clone().all(|row| removed[row] == Removed::NO), "particles have left the tank");
    let total: f64 = rows.clone().map(|row| mass[row].0).sum();
    // Twice the height of the centre of mass: the level of a flat surface.
    let level = 2.0 * rows.map(|row| mass[row].0 * position[row].0.y).sum::<f64>() / total;
    let name = format!(
        "{}, {}",
        if solid { "three dimensions" } else { "two dimensions" },
        if shifted { "shifting" } else { "no shifting" }
    );
    let supplied = simulation.ledger().total_named("gravity");
    let given = -simulation.ledger().total_named("particle_shifting") / supplied;
    Ok([
        Check::new(
            format!("level, {name}"),
            level,
            LEVEL,
            Tolerance::Relative(TOLERANCE * (DEEP * spacing / LEVEL).max(1.0)),
            "m",
            "volume over area",
        )
        .converging(),
        Check::below(format!("what shifting gives, {name}"), given, 1e-3, "shifting is no source of energy"),
    ])
}
