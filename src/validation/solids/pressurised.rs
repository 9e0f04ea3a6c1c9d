//! S23: a thick ring, a tube and a hollow sphere under internal pressure, which acts through their surfaces.

use anyhow::Result;
use meshless_engine::glam::DVec3;
use meshless_engine::plugin::Registry;
use meshless_engine::world::{Position, ReferencePosition};

use crate::case::Case;
use crate::check::{Check, Tolerance};
use crate::measure::{body, relax};
use crate::template::Template;

pub(crate) const RING: Case = Case {
    id: "S23",
    title: "thick ring under internal pressure",
    resolutions: &[8, 16, 32],
    ci_resolution: 16,
    run: ring,
};

pub(crate) const TUBE: Case = Case {
    id: "S23b",
    title: "tube under internal pressure",
    resolutions: &[4, 8, 16],
    ci_resolution: 8,
    run: tube,
};

pub(crate) const SPHERE: Case = Case {
    id: "S23c",
    title: "hollow sphere under internal pressure",
    resolutions: &[4, 8, 12],
    ci_resolution: 8,
    run: sphere,
};

/// Radii, m, pressure, Pa, and elastic constants, Pa.
const INNER: f64 = 0.05;
const OUTER: f64 = 0.1;
const PRESSURE: f64 = 100.0;
const YOUNG: f64 = 1.0e6;
const POISSON: f64 = 0.3;

/// Radial displacement of a ring that is held along its axis, m (Lame, plane strain).
fn of_ring(radius: f64) -> f64 {
    let factor = (1.0 + POISSON) * PRESSURE * INNER * INNER / (YOUNG * (OUTER * OUTER - INNER * INNER));
    factor * ((1.0 - 2.0 * POISSON) * radius + OUTER * OUTER / radius)
}

/// Radial displacement of a tube with free ends, m (Lame, no axial stress).
fn of_tube(radius: f64) -> f64 {
    let factor = PRESSURE * INNER * INNER / (YOUNG * (OUTER * OUTER - INNER * INNER));
    factor * ((1.0 - POISSON) * radius + (1.0 + POISSON) * OUTER * OUTER / radius)
}

/// Radial displacement of a hollow sphere, m (Lame).
fn of_sphere(radius: f64) -> f64 {
    let (a3, b3) = (INNER.powi(3), OUTER.powi(3));
    let factor = PRESSURE * a3 / (YOUNG * (b3 - a3));
    factor * ((1.0 - 2.0 * POISSON) * radius + (1.0 + POISSON) * b3 / (2.0 * radius * radius))
}

/// A body whose inner surface is under pressure.
struct Shell {
    scene: Template,
    /// Name of the body.
    body: &'static str,
    tolerance: f64,
    /// The radial displacement at a radius, m.
    exact: fn(f64) -> f64,
    /// Distance of a place from the axis or the centre, m.
    radius: fn(DVec3) -> f64,
}

fn ring(registry: &Registry, across: usize) -> Result<Vec<Check>> {
    let scene = Template::new(
        "tests/validation/thick_ring/scene.ron",
        include_str!("../../../tests/validation/thick_ring/scene.ron"),
    );
    let tolerance = if across < 16 { 0.03 } else { 0.01 };
    let radius = |x: DVec3| x.truncate().length();
    displacements(Shell { scene, body: "ring", tolerance, exact: of_ring, radius }, registry, across)
}

fn tube(registry: &Registry, across: usize) -> Result<Vec<Check>> {
    let scene = Template::new(
        "tests/validation/thick_tube/scene.ron",
        include_str!("../../../tests/validation/thick_tube/scene.ron"),
    );
    let tolerance = if across < 16 { 0.06 } else { 0.01 };
    let radius = |x: DVec3| x.truncate().length();
    displacements(Shell { scene, body: "shell", tolerance, exact: of_tube, radius }, registry, across)
}

fn sphere(registry: &Registry, across: usize) -> Result<Vec<Check>> {
    let scene = Template::new(
        "tests/validation/hollow_sphere/scene.ron",
        include_str!("../../../tests/validation/hollow_sphere/scene.ron"),
    );
    let tolerance = if across < 12 { 0.1 } else { 0.02 };
    let radius = |x: DVec3| x.length();
    displacements(Shell { scene, body: "shell", tolerance, exact: of_sphere, radius }, registry, across)
}

/// The radial displacement of the innermost and the outermost layer of particles over that of the closed form at their radii; `across` is the
/// number of layers across the wall.
fn displacements(shell: Shell, registry: &Registry, across: usize) -> Result<Vec<Check>> {
    let Shell { scene, body: name, tolerance, exact, radius } = shell;
    let spacing = (OUTER - INNER) / across as f64;
    let mut simulation = scene.set(&format!("bodies.{name}.spacing"), spacing)?.build(registry)?;
    relax(&mut simulation)?;
    let (view, rows) = simulation.world().body_view(body(&simulation, name)?);
    let (x, reference) = (view.read::<Position>()?, view.read::<ReferencePosition>()?);
    let ratio = |from: f64| {
        let in_layer = |row: &usize| (from..from + spacing).contains(&radius(reference[*row].0));
        let of = |row: usize| (radius(x[row].0) - radius(reference[row].0)) / exact(radius(reference[row].0));
        let found: Vec<f64> = rows.clone().filter(in_layer).map(of).collect();
        found.iter().sum::<f64>() / found.len() as f64
    };
    let check = |name: &str, radius: f64, ratio: f64| {
        Check::new(name, ratio * exact(radius), exact(radius), Tolerance::Relative(tolerance), "m", "Lame")
            .converging()
    };
    Ok(vec![
        check("displacement of the bore", INNER, ratio(INNER)),
        check("displacement of the outer side", OUTER, ratio(OUTER - spacing)),
    ])
}
