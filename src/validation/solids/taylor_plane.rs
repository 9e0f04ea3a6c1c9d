//! S6: Taylor bar in plane strain, with and without the switch of the hourglass control, and without the
//! control.

use anyhow::Result;
use meshless_engine::glam::DVec3;
use meshless_engine::plugin::Registry;
use meshless_engine::world::BodyId;

use super::taylor::{BarShape, impact};
use crate::case::Case;
use crate::check::{Check, Tolerance};
use crate::measure::{Disorder, Kind};
use crate::template::Template;

pub(crate) const CASE: Case = Case {
    id: "S6",
    title: "Taylor bar in plane strain",
    resolutions: &[11, 22, 44],
    ci_resolution: 11,
    run: taylor_plane,
};

fn taylor_plane(registry: &Registry, across: usize) -> Result<Vec<Check>> {
    let (shape, disorder) = bar(registry, across, "hourglass_control()")?;
    let source = "finite elements, reference.csv";
    let mut checks = vec![
        Check::new("length", shape.length, 0.0203, Tolerance::Relative(0.02), "m", source),
        Check::new(
            "width of the mushroom",
            2.0 * shape.radius,
            0.010094,
            Tolerance::Between(-0.12, 0.02),
            "m",
            source,
        )
        .converging(),
        shape.balance.check(Kind::Inelastic),
    ];
    let (elastic, _) = bar(registry, across, "hourglass_control(after_yield: Young)")?;
    checks.push(Check::below(
        "plastic strain without the switch over that with it",
        elastic.plastic_strain / shape.plastic_strain,
        0.7,
        "Ganzenmueller 2015, section 4.5",
    ));
    let (_, free) = bar(registry, across, "")?;
    checks.push(Check::above("hourglass residual without control", free, 0.3, "disorder"));
    checks.push(Check::below(
        "hourglass residual with control over that without",
        disorder / free,
        0.5,
        "order",
    ));
    Ok(checks)
}

fn bar(registry: &Registry, across: usize, plugins: &str) -> Result<(BarShape, f64)> {
    let text = include_str!("../../../tests/validation/taylor_plane/scene.ron");
    let mut simulation = Template::new("tests/validation/taylor_plane/scene.ron", text)
        .set("bodies.bar.spacing", 3.91e-3 / across as f64)?
        .set("bodies.bar.plugins", format!("[{plugins}]"))?
        .build(registry)?;
    let disorder = Disorder::new(&simulation, BodyId(0))?;
    let shape = impact(&mut simulation, DVec3::Y)?;
    Ok((shape, disorder.measure(&simulation)?))
}
