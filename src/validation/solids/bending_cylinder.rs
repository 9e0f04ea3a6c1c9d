//! S18: a cylinder that flies sideways when its foot is stopped.

use anyhow::Result;
use meshless_engine::glam::DVec3;
use meshless_engine::plugin::Registry;

use crate::case::Case;
use crate::check::{Check, Tolerance};
use crate::measure::{Balance, Kind, MaterialPoint, Record, body, run};
use crate::template::Template;

pub(crate) const CASE: Case = Case {
    id: "S18",
    title: "bending cylinder",
    resolutions: &[8, 12],
    ci_resolution: 8,
    run: bending_cylinder,
};

const REFERENCE: &str = include_str!("../../../tests/validation/bending_cylinder/reference.csv");
const SOURCE: &str = "spectral elements, reference.csv";

/// Maximum deflection of the middle of the top, m, its time, s, and the energy balance.
fn deflection(
    registry: &Registry,
    across: usize,
    formulation: &str,
    plugin: &str,
) -> Result<(f64, f64, Balance)> {
    let spacing = 0.64 / across as f64;
    let mut simulation = Template::new(
        "tests/validation/bending_cylinder/scene.ron",
        include_str!("../../../tests/validation/bending_cylinder/scene.ron"),
    )
    .set("bodies.cylinder.spacing", spacing)?
    .set("bodies.cylinder.shape.from", format!("(0.0, 0.0, {})", -3.0 * spacing))?
    .set("bodies.cylinder.formulation", formulation)?
    .set("bodies.cylinder.plugins", format!("[{plugin}]"))?
    .build(registry)?;
    let top = MaterialPoint::new(&simulation, body(&simulation, "cylinder")?, DVec3::new(0.0, 0.0, 3.24))?;
    let mut record = Record::default();
    let balance = run(&mut simulation, |simulation| {
        record.push(simulation.clock().time, top.displacement(simulation)?.x);
        Ok(())
    })?;
    let (time, most) = record.maximum()?;
    Ok((most, time, balance))
}

fn bending_cylinder(registry: &Registry, across: usize) -> Result<Vec<Check>> {
    let (time_reference, most) = Record::read(REFERENCE, "t_s", "ux_c")?.maximum()?;
    let total = deflection(registry, across, "TotalLagrangian", "hourglass_control()")?;
    let near = |name: String, found, reference, most, unit, source| {
        Check::new(name, found, reference, Tolerance::Relative(most), unit, source)
    };
    let mut checks = vec![
        near("TL: largest deflection of the top".into(), total.0, most, 0.03, "m", SOURCE).converging(),
        near("TL: time of it".into(), total.1, time_reference, 0.03, "s", SOURCE).converging(),
    ];
    let updated = deflection(registry, across, "UpdatedLagrangian(update: Every(3))", "hourglass_control()")?;
    let name = |what: &str| format!("UL: {what}");
    checks.push(near(name("largest deflection"), updated.0, most, 0.03, "m", SOURCE));
    checks.push(near(name("the same"), updated.0, total.0, 0.03, "m", "total Lagrangian"));
    checks.push(near(name("time of it"), updated.1, time_reference, 0.03, "s", SOURCE));
    checks.push(updated.2.check_of("UL", Kind::Abrupt));
    Ok(checks)
}
