//! S11: a column with an initial sideways velocity that bends to half its height.

use anyhow::Result;
use meshless_engine::glam::DVec3;
use meshless_engine::plugin::Registry;

use crate::case::Case;
use crate::check::{Check, Tolerance};
use crate::measure::{Kind, MaterialPoint, Record, body, run};
use crate::template::Template;

pub(crate) const CASE: Case = Case {
    id: "S11",
    title: "bending column",
    resolutions: &[12, 16, 24],
    ci_resolution: 12,
    run: bending_column,
};

const REFERENCE: &str = include_str!("../../../tests/validation/bending_column/reference.csv");
const SOURCE: &str = "spectral elements, reference.csv";

fn bending_column(registry: &Registry, across: usize) -> Result<Vec<Check>> {
    let path = "tests/validation/bending_column/scene.ron";
    let spacing = 1.0 / across as f64;
    let mut simulation =
        Template::new(path, include_str!("../../../tests/validation/bending_column/scene.ron"))
            .set("bodies.column.spacing", spacing)?
            .set("bodies.column.shape.min", format!("(-0.5, -0.5, {})", -3.0 * spacing))?
            .build(registry)?;
    let top = MaterialPoint::new(&simulation, body(&simulation, "column")?, DVec3::new(0.0, 0.0, 6.0))?;
    let mut deflection = Record::default();
    let balance = run(&mut simulation, |simulation| {
        deflection.push(simulation.clock().time, top.displacement(simulation)?.x);
        Ok(())
    })?;
    let reference = Record::read(REFERENCE, "t_s", "ux_c")?.until(0.8);
    let ((_, peak), (_, peak_reference)) = (deflection.maximum()?, reference.maximum()?);
    let (time, time_reference) = (deflection.middle_of_peak(0.9)?, reference.middle_of_peak(0.9)?);
    Ok(vec![
        Check::new(
            "largest deflection of the top",
            peak,
            peak_reference,
            Tolerance::Relative(0.04),
            "m",
            SOURCE,
        )
        .converging(),
        Check::new(
            "middle of the time above 90 % of it",
            time,
            time_reference,
            Tolerance::Relative(0.02),
            "s",
            SOURCE,
        )
        .converging(),
        balance.check(Kind::Smooth),
    ])
}
