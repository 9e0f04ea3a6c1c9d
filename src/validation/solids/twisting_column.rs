//! S12: a column that is twisted by almost a full turn.

use anyhow::Result;
use meshless_engine::glam::DVec3;
use meshless_engine::plugin::Registry;

use crate::case::Case;
use crate::check::{Check, Tolerance};
use crate::measure::{Kind, MaterialPoint, Record, body, run};
use crate::template::Template;

pub(crate) const CASE: Case = Case {
    id: "S12",
    title: "twisting column",
    resolutions: &[10, 12, 16],
    ci_resolution: 12,
    run: twisting_column,
};

const REFERENCE: &str = include_str!("../../../tests/validation/twisting_column/reference.csv");
const SOURCE: &str = "spectral elements, reference.csv";

fn twisting_column(registry: &Registry, across: usize) -> Result<Vec<Check>> {
    let path = "tests/validation/twisting_column/scene.ron";
    let spacing = 1.0 / across as f64;
    let mut simulation =
        Template::new(path, include_str!("../../../tests/validation/twisting_column/scene.ron"))
            .set("bodies.column.spacing", spacing)?
            .set("bodies.column.shape.min", format!("(-0.5, -0.5, {})", -3.0 * spacing))?
            .build(registry)?;
    let corner = MaterialPoint::new(&simulation, body(&simulation, "column")?, DVec3::new(0.5, 0.5, 6.0))?;
    let mut angle = Record::default();
    let (mut last, mut turned) = (DVec3::new(0.5, 0.5, 0.0), 0.0);
    let balance = run(&mut simulation, |simulation| {
        let arm = corner.position(simulation)?;
        turned += (last.x * arm.y - last.y * arm.x).atan2(last.x * arm.x + last.y * arm.y);
        last = arm;
        angle.push(simulation.clock().time, f64::to_degrees(turned));
        Ok(())
    })?;
    let reference = Record::read(REFERENCE, "t_s", "top_corner_angle_deg")?.until(0.16);
    let ((_, peak), (_, peak_reference)) = (angle.maximum()?, reference.maximum()?);
    let (time, time_reference) = (angle.middle_of_peak(0.9)?, reference.middle_of_peak(0.9)?);
    Ok(vec![
        Check::new(
            "largest angle of a top corner",
            peak,
            peak_reference,
            Tolerance::Relative(0.05),
            "deg",
            SOURCE,
        ),
        Check::new(
            "middle of the time above 90 % of it",
            time,
            time_reference,
            Tolerance::Relative(0.03),
            "s",
            SOURCE,
        ),
        balance.check(Kind::Smooth),
    ])
}
