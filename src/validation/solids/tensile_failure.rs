//! S7: a bar with a slight waist is pulled to failure.

use anyhow::{Result, ensure};
use meshless_engine::plugin::Registry;
use meshless_engine::simulation::Simulation;
use meshless_engine::world::{Damage, Force, ReferencePosition};

use crate::case::Case;
use crate::check::{Check, Tolerance};
use crate::measure::{Balance, Kind, body};
use crate::template::Template;

pub(crate) const CASE: Case = Case {
    id: "S7",
    title: "tensile failure in three dimensions",
    resolutions: &[8, 10, 12],
    ci_resolution: 8,
    run: tensile_failure,
};

/// Half the gauge length, m, and the speed of either grip, m/s.
const GAUGE: (f64, f64) = (0.02, 5.0);
/// Limit of the principal logarithmic strain.
const LIMIT: f64 = 0.08;
/// Relative difference of the widths of the ends and the middle.
const WAIST: f64 = 0.05;

/// Results of a failure.
struct Break {
    /// Elongation of the gauge when the first particle has failed, m.
    first: f64,
    /// Elongation at the maximum force, m.
    peak: f64,
    /// Distance from the middle of the first particle that has failed, and the mean of all when the force has
    /// halved, m.
    place: (f64, f64),
    /// Energy balance.
    balance: Balance,
}

fn tensile_failure(registry: &Registry, across: usize) -> Result<Vec<Check>> {
    let uniform = elongation_of_uniform_sections();
    let with = pull(registry, across, 5.0)?;
    let without = pull(registry, across, 0.0)?;
    let tolerance = Tolerance::Relative(0.05);
    let source = "uniform sections";
    Ok(vec![
        Check::new("elongation at the first failure", with.first, uniform, tolerance, "m", source),
        Check::new("elongation at the largest force", with.peak, uniform, tolerance, "m", source),
        Check::below(
            "mean distance of failed particles from the middle over half the gauge",
            with.place.0 / GAUGE.0,
            0.15,
            "in the middle",
        ),
        Check::below(
            "distance of the first failure from the middle over half the gauge",
            with.place.1 / GAUGE.0,
            0.15,
            "in the middle",
        ),
        with.balance.check(Kind::Inelastic),
        Check::below(
            "elongation at the largest force without control, over that of uniform sections",
            without.peak / uniform,
            0.92,
            "too early",
        ),
    ])
}

/// Elongation at which the middle of the gauge reaches the limit if every section is strained uniformly by
/// the same force: the strain is inversely proportional to the area, whose width falls linearly to the
/// middle.
fn elongation_of_uniform_sections() -> f64 {
    let pieces = 1000;
    let stretch = |k: usize| {
        let from_middle = (k as f64 + 0.5) / f64::from(pieces as u32);
        (LIMIT * (1.0 - WAIST) / (1.0 - WAIST * (1.0 - from_middle))).exp() - 1.0
    };
    2.0 * GAUGE.0 * (0..pieces).map(stretch).sum::<f64>() / pieces as f64
}

fn pull(registry: &Registry, across: usize, alpha: f64) -> Result<Break> {
    let mut simulation = Template::new(
        "tests/validation/tensile_failure/scene.ron",
        include_str!("../../../tests/validation/tensile_failure/scene.ron"),
    )
    .set("bodies.bar.spacing", 0.01 / across as f64)?
    .set("bodies.bar.plugins.hourglass_control.alpha", alpha)?
    .build(registry)?;
    let mut seen = Break { first: 0.0, peak: 0.0, place: (0.0, 0.0), balance: Balance::default() };
    simulation.start()?;
    let mut largest = 0.0;
    // Later the halves oscillate, and may fail again elsewhere.
    let failed = loop {
        simulation.step()?;
        seen.balance.see(&simulation);
        let elongation = 2.0 * GAUGE.1 * simulation.clock().time;
        let (force, failed) = look(&simulation)?;
        if force > largest {
            (largest, seen.peak) = (force, elongation);
        }
        if seen.first == 0.0 && !failed.is_empty() {
            seen.first = elongation;
            seen.place.1 = mean_distance(&failed);
        }
        if seen.first > 0.0 && force < 0.5 * largest {
            break failed;
        }
        ensure!(!simulation.is_finished(), "the bar has not broken");
    };
    seen.place.0 = mean_distance(&failed);
    Ok(seen)
}

/// Mean of the distances from the middle, m.
fn mean_distance(places: &[f64]) -> f64 {
    places.iter().map(|x| x.abs()).sum::<f64>() / places.len() as f64
}

/// Force on the right grip, N, and positions of failed particles in the reference configuration along the
/// bar, m.
fn look(simulation: &Simulation) -> Result<(f64, Vec<f64>)> {
    let (view, rows) = simulation.world().body_view(body(simulation, "bar")?);
    let reference = view.read::<ReferencePosition>()?;
    let force = view.read::<Force>()?;
    let damage = view.read::<Damage>()?;
    let grip = rows.clone().filter(|&k| reference[k].0.x > GAUGE.0);
    let failed = rows.filter(|&k| damage[k].0 >= 1.0).map(|k| reference[k].0.x);
    Ok((-grip.map(|k| force[k].0.x).sum::<f64>(), failed.collect()))
}
