//! S23: a thick ring, a tube and a hollow sphere under internal pressure on their surfaces.

use anyhow::{Result, ensure};
use meshless_engine::glam::DVec3;
use meshless_engine::plugin::Registry;
use meshless_engine::simulation::Simulation;
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
    resolutions: &[4, 8, 16],
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
struct PressurisedShell {
    scene: Template,
    /// Name of the body.
    body: &'static str,
    tolerance: f64,
    /// The radial displacement at a radius, m.
    exact: fn(f64) -> f64,
    /// Distance of a point from the axis or the centre, m.
    radius: fn(DVec3) -> f64,
}

fn ring(registry: &Registry, across: usize) -> Result<Vec<Check>> {
    let scene = Template::new(
        "tests/validation/thick_ring/scene.ron",
        include_str!("../../../tests/validation/thick_ring/scene.ron"),
    );
    let tolerance = if across < 16 { 0.03 } else { 0.01 };
    let radius = |x: DVec3| x.truncate().length();
    let ring = PressurisedShell { scene, body: "ring", tolerance, exact: of_ring, radius };
    let simulation = at_rest(&ring, registry, across)?;
    let mut checks = displacements(&ring, &simulation, across)?;
    checks.extend(stresses(&simulation, across)?);
    Ok(checks)
}

/// Stresses at the surfaces of the ring: across them they are those of the pressure, around them Lame's.
fn stresses(simulation: &Simulation, across: usize) -> Result<[Check; 4]> {
    let tolerances = if across < 16 { [0.09, 0.02] } else { [0.03, 0.005] };
    let [a2, b2] = [INNER * INNER, OUTER * OUTER];
    let around = |radius: f64| PRESSURE * a2 / (b2 - a2) * (1.0 + b2 / (radius * radius));
    let check = |name: &str, probe: &str, exact: f64, tolerance: Tolerance| -> Result<Check> {
        let shown = simulation.measure(probe)?;
        Ok(Check::new(name, shown[0].1, exact, tolerance, "Pa", "Lame"))
    };
    let [bore, rim] = tolerances.map(Tolerance::Relative);
    let exact = Tolerance::Absolute(1e-3 * PRESSURE);
    Ok([
        check("radial stress at the bore", "bore_radial", -PRESSURE, exact)?,
        check("hoop stress at the bore", "bore_hoop", around(INNER), bore)?.converging(),
        check("radial stress at the rim", "rim_radial", 0.0, exact)?,
        check("hoop stress at the rim", "rim_hoop", around(OUTER), rim)?,
    ])
}

fn tube(registry: &Registry, across: usize) -> Result<Vec<Check>> {
    let scene = Template::new(
        "tests/validation/thick_tube/scene.ron",
        include_str!("../../../tests/validation/thick_tube/scene.ron"),
    );
    let tolerance = if across < 16 { 0.06 } else { 0.01 };
    let radius = |x: DVec3| x.truncate().length();
    let tube = PressurisedShell { scene, body: "shell", tolerance, exact: of_tube, radius };
    displacements(&tube, &at_rest(&tube, registry, across)?, across)
}

fn sphere(registry: &Registry, across: usize) -> Result<Vec<Check>> {
    let scene = Template::new(
        "tests/validation/hollow_sphere/scene.ron",
        include_str!("../../../tests/validation/hollow_sphere/scene.ron"),
    );
    let tolerance = if across < 16 { 0.1 } else { 0.01 };
    let radius = |x: DVec3| x.length();
    let shell = PressurisedShell { scene, body: "shell", tolerance, exact: of_sphere, radius };
    let simulation = at_rest(&shell, registry, across)?;
    let mut checks = displacements(&shell, &simulation, across)?;
    checks.extend(at_the_surface(&simulation, across)?);
    Ok(checks)
}

/// Number of radial lines from the cavity to the outer surface of the hollow sphere with probes at both ends.
const WAYS: usize = 7;

/// The radial displacement of the surface of the cavity and of the outer surface: the mean over the probes at
/// the ends of some radial lines.
fn at_the_surface(simulation: &Simulation, across: usize) -> Result<Vec<Check>> {
    let mut means = [0.0; 2];
    for way in 1..=WAYS {
        let shown = simulation.measure(&format!("way_{way}"))?;
        ensure!(shown.len() == 6, "the probe `way_{way}` does not show two places");
        for (mean, place) in means.iter_mut().zip(shown.chunks(3)) {
            *mean += DVec3::new(place[0].1, place[1].1, place[2].1).length() / WAYS as f64;
        }
    }
    let tolerance = Tolerance::Relative(if across < 16 { 0.1 } else { 0.01 });
    let check = |name: &str, mean: f64, radius: f64| {
        Check::new(name, mean - radius, of_sphere(radius), tolerance, "m", "Lame")
    };
    let [inner, outer] = means;
    Ok(vec![
        check("displacement of the surface of the cavity", inner, INNER).converging(),
        // The error passes through zero below 8 shells.
        check("displacement of the outer surface", outer, OUTER),
    ])
}

/// The body in balance with the pressure; `across` is the number of layers across the wall.
fn at_rest(shell: &PressurisedShell, registry: &Registry, across: usize) -> Result<Simulation> {
    let spacing = (OUTER - INNER) / across as f64;
    let scene = shell.scene.clone().set(&format!("bodies.{}.spacing", shell.body), spacing)?;
    let mut simulation = scene.build(registry)?;
    relax(&mut simulation)?;
    Ok(simulation)
}

/// The radial displacement of the innermost and the outermost layer of particles over that of the closed form
/// at their radii.
fn displacements(shell: &PressurisedShell, simulation: &Simulation, across: usize) -> Result<Vec<Check>> {
    let PressurisedShell { body: name, tolerance, exact, radius, .. } = *shell;
    let spacing = (OUTER - INNER) / across as f64;
    let (view, rows) = simulation.world().body_view(body(simulation, name)?);
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
