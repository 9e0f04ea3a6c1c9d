//! S24: a Taylor bar without hardening as an updated-Lagrangian body; a fixed reference is inaccurate here.

use anyhow::Result;
use meshless_engine::glam::DVec3;
use meshless_engine::plugin::Registry;
use meshless_engine::world::{BodyId, DeformationGradient, Mass};

use super::taylor::{BarShape, impact};
use crate::case::Case;
use crate::check::{Check, Tolerance};
use crate::measure::Kind;
use crate::template::Template;

pub(crate) const CASE: Case = Case {
    id: "S24",
    title: "Taylor bar without hardening",
    resolutions: &[8, 12, 16],
    ci_resolution: 8,
    run: taylor_soft,
};

const DIAMETER: f64 = 7.62e-3;
/// Length and largest radius of the finest mesh, m.
const LENGTH: f64 = 14.2456e-3;
const RADIUS: f64 = 9.5104e-3;

fn taylor_soft(registry: &Registry, across: usize) -> Result<Vec<Check>> {
    let (shape, volume) = bar(registry, across, "UpdatedLagrangian()")?;
    let (fixed, _) = bar(registry, across, "TotalLagrangian")?;
    let source = "finite elements, reference.csv";
    let error = |shape: &BarShape| (shape.length / LENGTH - 1.0).abs();
    Ok(vec![
        Check::new("length", shape.length, LENGTH, Tolerance::Relative(0.02), "m", source).converging(),
        Check::new("largest radius", shape.radius, RADIUS, Tolerance::Relative(0.06), "m", source)
            .converging(),
        Check::below("change of volume", (volume - 1.0).abs(), 0.01, "metal keeps its volume"),
        Check::below(
            "error of the length over that with a fixed reference",
            error(&shape) / error(&fixed),
            0.7,
            "what the formulation is for",
        ),
        shape.balance.check(Kind::Abrupt),
    ])
}

/// The shape of a bar with this formulation at the end, and the mean of its volume over the initial one.
fn bar(registry: &Registry, across: usize, formulation: &str) -> Result<(BarShape, f64)> {
    let text = include_str!("../../../tests/validation/taylor_soft/scene.ron");
    let mut simulation = Template::new("tests/validation/taylor_soft/scene.ron", text)
        .set("bodies.bar.spacing", DIAMETER / across as f64)?
        .set("bodies.bar.formulation", formulation)?
        .build(registry)?;
    let shape = impact(&mut simulation, DVec3::Z)?;
    let (view, rows) = simulation.world().body_view(BodyId(0));
    let (gradient, mass) = (view.read::<DeformationGradient>()?, view.read::<Mass>()?);
    let volume = rows.clone().map(|row| mass[row].0 * gradient[row].0.determinant()).sum::<f64>();
    Ok((shape, volume / rows.map(|row| mass[row].0).sum::<f64>()))
}
