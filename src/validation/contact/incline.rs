//! C2: a block on an incline that sticks or slides, and a rolling disc.

use anyhow::{Context, Result};
use meshless_engine::plugin::Registry;

use crate::case::Case;
use crate::check::{Check, Tolerance};
use crate::measure::{rows, run, state};
use crate::template::Template;

pub(crate) const CASE: Case = Case {
    id: "C2",
    title: "block and disc on an incline",
    resolutions: &[4, 8],
    ci_resolution: 4,
    run: incline,
};

const REFERENCE: &str = include_str!("../../../tests/validation/incline/reference.csv");
const SOURCE: &str = "closed form, reference.csv";
const GRAVITY: f64 = 9.81;

/// `across` is the number of particles over the height of the block.
fn incline(registry: &Registry, across: usize) -> Result<Vec<Check>> {
    let mut checks = Vec::new();
    for row in rows(REFERENCE) {
        let number = |k: usize| row[k].parse::<f64>().context("a number");
        let (angle, friction, expected) = (number(0)?, number(1)?, number(3)?);
        let mut simulation =
            scene(angle, friction)?.set("bodies.block.spacing", 0.1 / across as f64)?.build(registry)?;
        run(&mut simulation, |_| Ok(()))?;
        let slide = state(&simulation, "block")?.center.x - 0.1;
        let name = format!("{angle} degrees, friction {friction}: slide in 1 s");
        // A sticking block moves only by the extension of the tangential springs.
        let tolerance = if expected == 0.0 { Tolerance::Absolute(1e-4) } else { Tolerance::Relative(0.01) };
        checks.push(Check::new(name, slide, expected, tolerance, "m", SOURCE));
    }
    for (friction, angle) in [(0.6, 30.0f64), (0.1, 30.0)] {
        let mut simulation = scene(angle, friction)?
            .set("bodies.block.shape", "Sphere(center: (0.1, 0.1), radius: 0.1)")?
            .set("bodies.block.spacing", 0.2 / across as f64)?
            .build(registry)?;
        run(&mut simulation, |_| Ok(()))?;
        let disc = state(&simulation, "block")?;
        let (sin, cos) = angle.to_radians().sin_cos();
        // A disc rolls if the friction can carry a third of the downhill force; otherwise it slides and spins
        // up.
        let rolls = angle.to_radians().tan() <= 3.0 * friction;
        let (along, spin) = if rolls {
            (2.0 / 3.0 * GRAVITY * sin, 2.0 / 3.0 * GRAVITY * sin / 0.1)
        } else {
            (GRAVITY * (sin - friction * cos), 2.0 * friction * GRAVITY * cos / 0.1)
        };
        let name = |what| format!("disc, friction {friction}: {what}");
        let near = |name, measured, reference, unit| {
            Check::new(name, measured, reference, Tolerance::Relative(0.01), unit, "closed form, E_incline")
        };
        checks.push(near(name("distance in 1 s"), disc.center.x - 0.1, 0.5 * along, "m"));
        checks.push(near(name("angular velocity"), -disc.angular_velocity.z, spin, "1/s"));
    }
    Ok(checks)
}

fn scene(angle: f64, friction: f64) -> Result<Template> {
    let (sin, cos) = angle.to_radians().sin_cos();
    Template::new(
        "tests/validation/incline/scene.ron",
        include_str!("../../../tests/validation/incline/scene.ron"),
    )
    .set("gravity", format!("({:?}, {:?})", GRAVITY * sin, -GRAVITY * cos))?
    .set("contacts[0].friction", friction)
}
