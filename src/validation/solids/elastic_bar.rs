//! S16: a bar whose right quarter is set in motion, with updates of the reference every three steps.

use anyhow::Result;
use meshless_engine::glam::DVec3;
use meshless_engine::plugin::Registry;
use meshless_engine::world::{BodyId, Position, ReferencePosition};

use crate::case::Case;
use crate::check::{Check, Tolerance};
use crate::measure::{Balance, Kind, MaterialPoint, Record, body, run};
use crate::template::Template;

pub(crate) const CASE: Case = Case {
    id: "S16",
    title: "bar whose right quarter is pulled, reference updated every three steps",
    resolutions: &[40],
    ci_resolution: 40,
    run: elastic_bar,
};

const TOTAL: &str = "TotalLagrangian(kernel: cubic_spline, support: 2.4)";
const UPDATED: &str = "UpdatedLagrangian(update: Every(3))";
/// Velocity of the right quarter, m/s.
const SPEED: f64 = 5.0;
/// Wave speed, m/s; the bar is 1 m long.
const WAVE: f64 = 166.66667;
const SOURCE: &str = "d'Alembert";

/// Results of a run.
struct BarMotion {
    /// Displacement of the free end, over v0 L / c.
    end: Record,
    /// High-frequency part of the last displacements along the bar, over the largest displacement.
    saw_tooth: f64,
    /// Energy balance.
    balance: Balance,
}

impl BarMotion {
    /// The maximum and the minimum displacement of the end.
    fn extremes(&self) -> (f64, f64) {
        let values = || self.end.0.iter().map(|sample| sample.1);
        (values().fold(f64::MIN, f64::max), values().fold(f64::MAX, f64::min))
    }

    /// Mean displacement of the end while it is at rest.
    fn plateau(&self) -> f64 {
        let still = |sample: &&(f64, f64)| (0.35..1.65).contains(&(sample.0 * WAVE));
        let values: Vec<f64> = self.end.0.iter().filter(still).map(|sample| sample.1).collect();
        values.iter().sum::<f64>() / values.len() as f64
    }
}

/// Runs the bar; a run that stops with an error counts as fully disordered.
fn bar(registry: &Registry, along: usize, formulation: &str, plugins: &str) -> Result<BarMotion> {
    let spacing = 1.0 / along as f64;
    let mut simulation = Template::new(
        "tests/validation/elastic_bar/scene.ron",
        include_str!("../../../tests/validation/elastic_bar/scene.ron"),
    )
    .set("bodies.bar.spacing", spacing)?
    .set("bodies.bar.shape.max", format!("(1.0, {})", 3.0 * spacing))?
    .set("conditions.Fix.on.within.max", format!("({spacing}, 1.0)"))?
    .set("conditions[3].at", 3.0 * spacing)?
    .set("bodies.bar.formulation", formulation)?
    .set("bodies.bar.plugins", format!("[{plugins}]"))?
    .build(registry)?;
    let end =
        MaterialPoint::new(&simulation, body(&simulation, "bar")?, DVec3::new(1.0, 1.5 * spacing, 0.0))?;
    let mut record = Record::default();
    let balance = run(&mut simulation, |simulation| {
        record.push(simulation.clock().time, end.displacement(simulation)?.x * WAVE / SPEED);
        Ok(())
    });
    let saw_tooth = if balance.is_err() { 1.0 } else { saw_tooth(&simulation, spacing)? };
    Ok(BarMotion { end: record, saw_tooth, balance: balance.unwrap_or(Balance::UNKNOWN) })
}

/// Root mean square of the second difference of the displacements of the middle row over four, over the
/// largest displacement.
fn saw_tooth(simulation: &meshless_engine::simulation::Simulation, spacing: f64) -> Result<f64> {
    let (view, _) = simulation.world().body_view(BodyId(0));
    let (x, start) = (view.read::<Position>()?, view.read::<ReferencePosition>()?);
    let middle = (0..view.len()).filter(|&row| (start[row].0.y - 1.5 * spacing).abs() < 0.1 * spacing);
    let mut row: Vec<(f64, f64)> = middle.map(|k| (start[k].0.x, x[k].0.x - start[k].0.x)).collect();
    row.sort_by(|a, b| a.0.total_cmp(&b.0));
    let largest = row.iter().map(|at| at.1.abs()).fold(0.0, f64::max);
    let parts = row.windows(3).map(|w| (0.25 * (w[0].1 - 2.0 * w[1].1 + w[2].1)).powi(2));
    Ok((parts.sum::<f64>() / (row.len() - 2) as f64).sqrt() / largest)
}

fn elastic_bar(registry: &Registry, along: usize) -> Result<Vec<Check>> {
    let total = bar(registry, along, TOTAL, "")?;
    let (most, least) = total.extremes();
    let mut checks = vec![Check::new(
        "total Lagrangian: displacement of the end at rest",
        total.plateau(),
        0.25,
        Tolerance::Relative(0.03),
        "v0 L/c",
        SOURCE,
    )];
    let bare = bar(registry, along, UPDATED, "")?;
    let (highest, lowest) = bare.extremes();
    let off = (highest / most - 1.0).abs().max((lowest / least - 1.0).abs());
    checks.push(Check::above("without stabilization: extremes are off by", off, 0.5, "spoiled"));
    for (stabilizer, plugin) in STABILIZERS {
        let motion = bar(registry, along, UPDATED, plugin)?;
        let (highest, lowest) = motion.extremes();
        let name = |what: &str| format!("{stabilizer}: {what}");
        let near = |what: &str, found: f64, reference: f64, most: f64| {
            let tolerance = Tolerance::Relative(most);
            Check::new(name(what), found, reference, tolerance, "v0 L/c", "total Lagrangian")
        };
        checks.push(near("largest displacement of the end", highest, most, 0.10));
        checks.push(near("smallest displacement of the end", lowest, least, 0.15));
        checks.push(Check::below(name("saw-tooth"), motion.saw_tooth, 0.03, "none"));
        checks.push(motion.balance.check_of(stabilizer, Kind::Abrupt));
    }
    Ok(checks)
}

/// Stabilizers of the bar.
const STABILIZERS: [(&str, &str); 2] =
    [("Hessian", "hessian_stabilization()"), ("hourglass", "hourglass_control()")];
