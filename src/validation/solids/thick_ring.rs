//! S23: a thick ring under internal pressure, which acts through its surface.

use anyhow::Result;
use meshless_engine::plugin::Registry;
use meshless_engine::world::{Position, ReferencePosition};

use crate::case::Case;
use crate::check::{Check, Tolerance};
use crate::measure::{body, relax};
use crate::template::Template;

pub(crate) const CASE: Case = Case {
    id: "S23",
    title: "thick ring under internal pressure",
    resolutions: &[8, 16, 32],
    ci_resolution: 16,
    run: thick_ring,
};

/// Radii, m, pressure, Pa, and elastic constants, Pa.
const INNER: f64 = 0.05;
const OUTER: f64 = 0.1;
const PRESSURE: f64 = 100.0;
const YOUNG: f64 = 1.0e6;
const POISSON: f64 = 0.3;

/// The displacement at a radius, m (Lame, plane strain).
fn lame(radius: f64) -> f64 {
    let factor = (1.0 + POISSON) * PRESSURE * INNER * INNER / (YOUNG * (OUTER * OUTER - INNER * INNER));
    factor * ((1.0 - 2.0 * POISSON) * radius + OUTER * OUTER / radius)
}

/// `across` is the number of rings of particles across the wall.
fn thick_ring(registry: &Registry, across: usize) -> Result<Vec<Check>> {
    let spacing = (OUTER - INNER) / across as f64;
    let mut simulation = Template::new(
        "tests/validation/thick_ring/scene.ron",
        include_str!("../../../tests/validation/thick_ring/scene.ron"),
    )
    .set("bodies.ring.spacing", spacing)?
    .build(registry)?;
    relax(&mut simulation)?;
    let (view, rows) = simulation.world().body_view(body(&simulation, "ring")?);
    let (x, reference) = (view.read::<Position>()?, view.read::<ReferencePosition>()?);
    // The mean over a ring of particles, over that of the closed form at its radius.
    let ratio = |from: f64| {
        let on_ring = |row: &usize| (from..from + spacing).contains(&reference[*row].0.length());
        let of = |row: usize| {
            let radius = reference[row].0.length();
            (x[row].0 - reference[row].0).dot(reference[row].0) / radius / lame(radius)
        };
        let found: Vec<f64> = rows.clone().filter(on_ring).map(of).collect();
        found.iter().sum::<f64>() / found.len() as f64
    };
    let tolerance = Tolerance::Relative(if across < 16 { 0.03 } else { 0.01 });
    let check = |name: &str, radius: f64, ratio: f64| {
        Check::new(name, ratio * lame(radius), lame(radius), tolerance, "m", "Lame, plane strain")
            .converging()
    };
    Ok(vec![
        check("displacement of the bore", INNER, ratio(INNER)),
        check("displacement of the outer side", OUTER, ratio(OUTER - spacing)),
    ])
}
