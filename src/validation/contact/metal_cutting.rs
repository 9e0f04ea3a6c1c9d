//! C5: orthogonal cutting of aluminium by a rigid tool.

use anyhow::Result;
use meshless_engine::plugin::Registry;
use meshless_engine::simulation::Simulation;
use meshless_engine::world::{BodyId, Damage, PlasticStrain, ReferencePosition, Temperature};

use crate::case::Case;
use crate::check::{Check, Tolerance};
use crate::measure::{Kind, body, run, state};
use crate::template::Template;

pub(crate) const CASE: Case = Case {
    id: "C5",
    title: "metal cutting",
    resolutions: &[5, 10, 20],
    ci_resolution: 5,
    run: metal_cutting,
};

/// Depth of cut, and place of the cut in the workpiece, m.
const DEPTH: f64 = 2.0e-4;
const CUT: f64 = 2.0e-4;
/// Friction.
const FRICTION: f64 = 0.2;
/// Time from which forces are averaged, s: half of the way.
const FROM: f64 = 1.5e-5;

/// `across` is the number of particles in the depth of cut.
fn metal_cutting(registry: &Registry, across: usize) -> Result<Vec<Check>> {
    let spacing = DEPTH / across as f64;
    let held = 3.0 * spacing;
    let mut simulation = Template::new(
        "tests/validation/metal_cutting/scene.ron",
        include_str!("../../../tests/validation/metal_cutting/scene.ron"),
    )
    .set("bodies.workpiece.spacing", spacing)?
    .set("bodies.workpiece.shape.min", format!("(0, {})", -held))?
    .set("bodies.workpiece.shape.max", format!("({}, 4.0e-4)", 1.0e-3 + held))?
    .build(registry)?;
    let workpiece = body(&simulation, "workpiece")?;
    let (mut cutting, mut thrust, mut count) = (0.0, 0.0, 0.0);
    let balance = run(&mut simulation, |simulation| {
        if simulation.clock().time > FROM {
            let force = state(simulation, "tool")?.force;
            (cutting, thrust, count) = (cutting - force.x, thrust + force.y, count + 1.0);
        }
        Ok(())
    })?;
    let (cutting, thrust) = (cutting / count, thrust / count);
    let expected = shear_strength(&simulation, workpiece)? * force_over_strength();
    let off = failed_off_the_cut(&simulation, workpiece)? / DEPTH;
    let source = "shear plane between Lee-Shaffer and Merchant";
    Ok(vec![
        Check::new("cutting force", cutting, expected, Tolerance::Relative(0.25), "N/m", source),
        Check::new(
            "thrust over cutting force",
            thrust / cutting,
            FRICTION,
            Tolerance::Relative(0.25),
            "1",
            "friction",
        ),
        Check::below("failed particles from the cut, in depths", off, 0.4, "the chip parts along the cut"),
        balance.check(Kind::Abrupt),
    ])
}

/// d cos(beta) / (sin(phi) cos(phi + beta)), m, with rake 0 and the friction angle beta; phi is half-way between Lee and Shaffer's 45 deg - beta and Merchant's
/// 45 deg - beta/2.
fn force_over_strength() -> f64 {
    let beta = FRICTION.atan();
    let phi = std::f64::consts::FRAC_PI_4 - 0.75 * beta;
    DEPTH * beta.cos() / (phi.sin() * (phi + beta).cos())
}

/// Flow stress over sqrt 3 at the mean strain and temperature of what is sheared and holds, at a strain rate of v / (d / 10), Pa.
fn shear_strength(simulation: &Simulation, workpiece: BodyId) -> Result<f64> {
    let (view, rows) = simulation.world().body_view(workpiece);
    let (strain, damage) = (view.read::<PlasticStrain>()?, view.read::<Damage>()?);
    let temperature = view.read::<Temperature>()?;
    let sheared: Vec<usize> = rows.filter(|&k| strain[k].0 > 0.3 && damage[k].0 < 1.0).collect();
    let mean = |of: &dyn Fn(usize) -> f64| sheared.iter().map(|&k| of(k)).sum::<f64>() / sheared.len() as f64;
    let (strain, temperature) = (mean(&|k| strain[k].0), mean(&|k| temperature[k].0));
    let hot = ((temperature - 292.0) / (925.0 - 292.0)).max(0.0);
    let rate: f64 = 10.0 / (DEPTH / 10.0);
    let flow = (164.0e6 + 211.0e6 * strain.powf(0.465)) * (1.0 + 0.002 * rate.ln()) * (1.0 - hot.powf(1.419));
    Ok(flow / 3f64.sqrt())
}

/// Mean distance of failed particles from the cut, in the workpiece as it was, m.
fn failed_off_the_cut(simulation: &Simulation, workpiece: BodyId) -> Result<f64> {
    let (view, rows) = simulation.world().body_view(workpiece);
    let (reference, damage) = (view.read::<ReferencePosition>()?, view.read::<Damage>()?);
    let failed: Vec<f64> =
        rows.filter(|&k| damage[k].0 >= 1.0).map(|k| (reference[k].0.y - CUT).abs()).collect();
    Ok(failed.iter().sum::<f64>() / failed.len() as f64)
}
