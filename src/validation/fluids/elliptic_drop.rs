//! F3: a circular drop that is stretched to an ellipse.

use anyhow::Result;
use meshless_engine::glam::DVec3;
use meshless_engine::plugin::Registry;
use meshless_engine::world::{Mass, Position};

use crate::case::Case;
use crate::check::{Check, Tolerance};
use crate::measure::{Kind, Record, body, run};
use crate::template::Template;

pub(crate) const CASE: Case = Case {
    id: "F3",
    title: "elliptic drop",
    resolutions: &[40, 80, 160],
    ci_resolution: 40,
    run: elliptic_drop,
};

const REFERENCE: &str = include_str!("../../../tests/validation/elliptic_drop/reference.csv");
const SOURCE: &str = "incompressible ellipse, reference.csv";

fn elliptic_drop(registry: &Registry, across: usize) -> Result<Vec<Check>> {
    let path = "tests/validation/elliptic_drop/scene.ron";
    let text = include_str!("../../../tests/validation/elliptic_drop/scene.ron");
    let mut simulation =
        Template::new(path, text).set("bodies.drop.spacing", 2.0 / across as f64)?.build(registry)?;
    let drop = body(&simulation, "drop")?;
    let balance = run(&mut simulation, |_| Ok(()))?;
    let (view, rows) = simulation.world().body_view(drop);
    let position = view.read::<Position>()?;
    let mass = view.read::<Mass>()?;
    let total: f64 = rows.clone().map(|row| mass[row].0).sum();
    let square: DVec3 =
        rows.map(|row| position[row].0 * position[row].0 * mass[row].0).sum::<DVec3>() / total;
    // The mean square of a coordinate over an ellipse is a quarter of its squared semi-axis.
    let (minor, major) = (2.0 * square.x.sqrt(), 2.0 * square.y.sqrt());
    let at_end = |name| -> Result<f64> {
        let record = Record::read(REFERENCE, "t_s", name)?;
        let sample = record.0.iter().find(|sample| (sample.0 - 0.0082).abs() < 1e-9);
        Ok(sample.map_or(f64::NAN, |sample| sample.1))
    };
    let exact = at_end("semi_major_y")?;
    Ok(vec![
        Check::new("semi-major axis", major, exact, Tolerance::Relative(0.01), "m", SOURCE),
        Check::new("product of the semi-axes", minor * major, 1.0, Tolerance::Relative(0.01), "m2", SOURCE),
        balance.check(Kind::Smooth),
    ])
}
