//! X1: a column of water on a clamped plate.

use anyhow::Result;
use meshless_engine::glam::DVec3;
use meshless_engine::plugin::Registry;

use crate::case::Case;
use crate::check::{Check, Tolerance};
use crate::measure::{Kind, MaterialPoint, Record, body, run};
use crate::template::Template;

pub(crate) const CASE: Case = Case {
    id: "X1",
    title: "column of water on a plate",
    resolutions: &[5, 7, 9],
    ci_resolution: 4,
    run: water_on_plate,
};

/// Deflection of the middle of the plate under water and its own weight, m, by plane finite elements: see
/// reference.csv.
const DEFLECTION: f64 = -7.055e-5;
const SOURCE: &str = "plane finite elements, 80 x 8 of second order";

fn water_on_plate(registry: &Registry, across: usize) -> Result<Vec<Check>> {
    let wet = 1.0 / (14 * across) as f64;
    let text = include_str!("../../../tests/validation/water_on_plate/scene.ron");
    let side = 4.0 * wet;
    // Particles lie in the planes of the clamps and are held, so that the span is that of the reference.
    let dry = 0.05 / across as f64;
    let clamp = 0.1 - 0.5 * dry;
    let mut simulation = Template::new("tests/validation/water_on_plate/scene.ron", text)
        .set("bodies.water.spacing", wet)?
        .set("bodies.plate.spacing", dry)?
        .set("bodies.plate.shape.min", format!("({}, -0.05)", -clamp))?
        .set("bodies.plate.shape.max", format!("({}, 0.0)", 1.0 + clamp))?
        .set("bodies.left.spacing", wet)?
        .set("bodies.left.shape.min", format!("({}, 0.0)", -side))?
        .set("bodies.right.spacing", wet)?
        .set("bodies.right.shape.max", format!("({}, 2.2)", 1.0 + side))?
        .build(registry)?;
    let plate = body(&simulation, "plate")?;
    let middle = MaterialPoint::new(&simulation, plate, DVec3::new(0.5, -0.025, 0.0))?;
    let mut deflection = Record::default();
    let from = 0.75 * simulation.end();
    let balance = run(&mut simulation, |simulation| {
        if simulation.clock().time >= from {
            deflection.push(simulation.clock().time, middle.displacement(simulation)?.y);
        }
        Ok(())
    })?;
    let values = || deflection.0.iter().map(|sample| sample.1);
    let mean = values().sum::<f64>() / deflection.0.len() as f64;
    let swing = values().map(|value| (value / mean - 1.0).abs()).fold(0.0, f64::max);
    let tolerance = Tolerance::Relative(match across {
        ..5 => 0.08,
        5..7 => 0.03,
        _ => 0.015,
    });
    Ok(vec![
        Check::new("deflection of the middle", mean, DEFLECTION, tolerance, "m", SOURCE).converging(),
        Check::below("change of the deflection over it, last quarter", swing, 1e-2, "at rest"),
        balance.check(Kind::Smooth),
    ])
}
