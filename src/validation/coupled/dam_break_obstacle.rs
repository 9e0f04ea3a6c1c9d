//! X2: a dam break on an elastic obstacle.

use anyhow::Result;
use meshless_engine::glam::DVec3;
use meshless_engine::plugin::Registry;

use crate::case::Case;
use crate::check::{Check, Tolerance};
use crate::measure::{Kind, MaterialPoint, Record, body, run};
use crate::template::Template;

pub(crate) const CASE: Case = Case {
    id: "X2",
    title: "dam break on an elastic obstacle",
    resolutions: &[4, 6],
    ci_resolution: 4,
    run: dam_break_obstacle,
};

const SOURCE: &str = "Meduri et al. 2017 and Ryzhakov et al. 2010, middle of both";

/// Time and value of the maximum of a curve of the reference.
fn peak(column: &str) -> Result<(f64, f64)> {
    let csv = include_str!("../../../tests/validation/dam_break_obstacle/reference.csv");
    // The first line after the comment has the quantities of the columns, the second one their authors.
    let lines: Vec<&str> = csv.lines().filter(|line| !line.starts_with("x,")).collect();
    Record::read(&lines.join("\n"), "t_s", column)?.maximum()
}

fn dam_break_obstacle(registry: &Registry, across: usize) -> Result<Vec<Check>> {
    let dry = 0.012 / across as f64;
    let wet = 4.0 / 3.0 * dry;
    let text = include_str!("../../../tests/validation/dam_break_obstacle/scene.ron");
    let mut simulation = Template::new("tests/validation/dam_break_obstacle/scene.ron", text)
        .set("bodies.water.spacing", wet)?
        .set("bodies.plate.spacing", dry)?
        .set("bodies.tank.spacing", wet)?
        .build(registry)?;
    let plate = body(&simulation, "plate")?;
    let corner = MaterialPoint::new(&simulation, plate, DVec3::new(0.292, 0.08, 0.0))?;
    let mut deflection = Record::default();
    let balance = run(&mut simulation, |simulation| {
        deflection.push(simulation.clock().time, corner.displacement(simulation)?.x);
        Ok(())
    })?;
    let (time, value) = deflection.maximum()?;
    let (first, second) = (peak("Meduri2017_m")?, peak("Ryzhakov2010_m")?);
    let mean = |a: f64, b: f64| 0.5 * (a + b);
    Ok(vec![
        Check::new("first peak", value, mean(first.1, second.1), Tolerance::Relative(0.2), "m", SOURCE),
        Check::new("its time", time, mean(first.0, second.0), Tolerance::Absolute(0.02), "s", SOURCE),
        balance.check(Kind::Smooth),
    ])
}
