//! F10: a square that starts to move in a box, SPHERIC benchmark 6.

use std::ops::RangeInclusive;

use anyhow::{Context, Result};
use meshless_engine::formulations::fluid::FlowCloud;
use meshless_engine::plugin::Registry;
use meshless_engine::simulation::Simulation;
use meshless_engine::world::BodyId;

use crate::case::Case;
use crate::check::{Check, Tolerance};
use crate::measure::{Kind, Record, body, run};
use crate::template::Template;

pub(crate) const CASE: Case = Case {
    id: "F10",
    title: "moving square",
    resolutions: &[10, 20, 40],
    ci_resolution: 10,
    run: moving_square,
};

const MOTION: &str = include_str!("../../../tests/validation/moving_square/motion.csv");
const REFERENCE: &str = include_str!("../../../tests/validation/moving_square/reference.csv");
const SOURCE: &str = "finite differences, reference.csv";
/// Averaging intervals, s: during the acceleration of the square, and over the time in which sound crosses
/// the box and comes back.
const START: RangeInclusive<f64> = 0.4..=0.6;
const STEADY: RangeInclusive<f64> = 1.5..=2.17;
/// Tolerances at 40 across, proportional to the spacing. The error of friction is relative to the whole drag.
const DRAG: f64 = 0.05;
const FRICTION: f64 = 0.1;
/// Factor from a force on the half of the square, N, to the drag over rho U^2 L / 2.
const PER_FORCE: f64 = -4.0;

fn moving_square(registry: &Registry, across: usize) -> Result<Vec<Check>> {
    let mut simulation = scene(registry, 1.0 / across as f64)?;
    let square = body(&simulation, "square")?;
    let (mut pressure, mut friction) = (Record::default(), Record::default());
    let mut next = 0.0;
    let balance = run(&mut simulation, |simulation| {
        let time = simulation.clock().time;
        if time >= next {
            next = time + 0.005;
            let [of_pressure, of_friction] = drag(simulation, square)?;
            pressure.push(time, of_pressure);
            friction.push(time, of_friction);
        }
        Ok(())
    })?;
    let reference = [Record::read(REFERENCE, "t", "pressure")?, Record::read(REFERENCE, "t", "viscous")?];
    let coarse = 40.0 / across as f64;
    let mut checks = Vec::new();
    for (name, times) in [("at the start", START), ("after it", STEADY)] {
        let [of_pressure, of_friction] = [reference[0].mean(&times)?, reference[1].mean(&times)?];
        let [pressure, friction] = [pressure.mean(&times)?, friction.mean(&times)?];
        let whole = of_pressure + of_friction;
        let tolerance = Tolerance::Relative(DRAG * coarse);
        let drag = Check::new(format!("drag {name}"), pressure + friction, whole, tolerance, "1", SOURCE);
        let tolerance = Tolerance::Absolute(FRICTION * coarse * whole);
        let name = format!("drag of friction {name}");
        let friction = Check::new(name, friction, of_friction, tolerance, "1", SOURCE);
        checks.extend([drag.converging(), friction.converging()]);
    }
    checks.push(balance.check(Kind::Smooth));
    Ok(checks)
}

fn scene(registry: &Registry, spacing: f64) -> Result<Simulation> {
    let side = 4.0 * spacing;
    let path = "tests/validation/moving_square/scene.ron";
    let text = include_str!("../../../tests/validation/moving_square/scene.ron");
    let mut template = Template::new(path, text)
        .set("tables.speed", points(MOTION))?
        .set("bodies.box.shape[0].min", format!("({}, 2.5)", -side))?
        .set("bodies.box.shape[0].max", format!("({}, {})", 10.0 + side, 5.0 + side))?
        .set("bodies.symmetry.shape.min", format!("({}, {})", -side, 2.5 - side))?
        .set("bodies.symmetry.shape.max", format!("({}, 2.5)", 10.0 + side))?;
    for name in ["fluid", "square", "box", "symmetry"] {
        template = template.set(&format!("bodies.{name}.spacing"), spacing)?;
    }
    Ok(template.build(registry)?)
}

/// The lines of a file as points of a table.
fn points(csv: &str) -> String {
    let lines: Vec<String> = csv.lines().skip(1).map(|line| format!("({line})")).collect();
    format!("(points: [{}])", lines.join(", "))
}

/// Drag by pressure and by friction.
fn drag(simulation: &Simulation, square: BodyId) -> Result<[f64; 2]> {
    let forces = simulation.resources().get::<FlowCloud>().forces_on(square).context("no fluid")?;
    let (all, friction) =
        forces.iter().fold((0.0, 0.0), |sum, (all, friction)| (sum.0 + all.x, sum.1 + friction.x));
    Ok([PER_FORCE * (all - friction), PER_FORCE * friction])
}
