//! F2: Taylor-Green vortices, and the start of Poiseuille and Couette flow.

use anyhow::{Result, ensure};
use meshless_engine::plugin::Registry;
use meshless_engine::simulation::Simulation;
use meshless_engine::world::{Position, Velocity};

use crate::case::Case;
use crate::check::{Check, Tolerance};
use crate::measure::{Kind, body, run, run_until};
use crate::template::Template;

pub(crate) const CASE: Case = Case {
    id: "F2",
    title: "Taylor-Green vortices, Poiseuille and Couette flow",
    resolutions: &[20, 40, 80],
    ci_resolution: 20,
    run: laminar_flows,
};

const PROFILES: &str = include_str!("../../../tests/validation/channel_flow/reference.csv");

fn laminar_flows(registry: &Registry, across: usize) -> Result<Vec<Check>> {
    let mut checks = taylor_green(registry, across, None)?;
    checks.extend(taylor_green(registry, across, Some("Square"))?);
    checks.extend(channel(registry, across, false)?);
    checks.extend(channel(registry, across, true)?);
    Ok(checks)
}

/// `lattice` is the initial one, in place of the irregular one of the scene.
fn taylor_green(registry: &Registry, across: usize, lattice: Option<&str>) -> Result<Vec<Check>> {
    let path = "tests/validation/taylor_green/scene.ron";
    let text = include_str!("../../../tests/validation/taylor_green/scene.ron");
    let mut template = Template::new(path, text).set("bodies.fluid.spacing", 1.0 / across as f64)?;
    if let Some(lattice) = lattice {
        template = template.set("bodies.fluid.lattice", lattice)?;
    }
    let mut simulation = template.build(registry)?;
    // The energy that a lattice loses as it breaks up is noise, which the leapfrog scheme resolves less well.
    let (start_from, kind) = if lattice.is_some() {
        ("a square lattice", Kind::Inelastic)
    } else {
        ("an irregular lattice", Kind::Smooth)
    };
    simulation.start()?;
    let kinetic = |simulation: &Simulation| simulation.ledger().total_named("kinetic");
    let start = kinetic(&simulation);
    let balance = run(&mut simulation, |_| Ok(()))?;
    let rate = (start / kinetic(&simulation)).ln() / (2.0 * simulation.clock().time);
    let exact = 8.0 * std::f64::consts::PI.powi(2) / 100.0;
    Ok(vec![
        Check::new(
            format!("decay rate of vortices on {start_from}"),
            rate,
            exact,
            Tolerance::Relative(0.03),
            "1/s",
            "8 pi^2 / Re, exact solution",
        ),
        balance.check_of(start_from, kind),
    ])
}

/// Rows `tau, y, u` of the reference at one time.
fn profile(tau: f64, couette: bool) -> Result<Vec<(f64, f64)>> {
    let mut rows = Vec::new();
    for line in PROFILES.lines().filter(|line| !line.starts_with(['#', 't'])) {
        let numbers = line.split(',').map(str::parse).collect::<Result<Vec<f64>, _>>()?;
        ensure!(numbers.len() == 4, "the reference has a short line: {line}");
        if (numbers[0] - tau).abs() < 1e-12 {
            rows.push((numbers[1], numbers[if couette { 3 } else { 2 }]));
        }
    }
    Ok(rows)
}

fn channel(registry: &Registry, across: usize, couette: bool) -> Result<Vec<Check>> {
    let spacing = 1.0 / across as f64;
    let side = 4.0 * spacing;
    let path = "tests/validation/channel_flow/scene.ron";
    let text = include_str!("../../../tests/validation/channel_flow/scene.ron");
    let mut template = Template::new(path, text)
        .set("bodies.fluid.spacing", spacing)?
        .set("bodies.lower.spacing", spacing)?
        .set("bodies.lower.shape.min", format!("(0.0, {})", -side))?
        .set("bodies.upper.spacing", spacing)?
        .set("bodies.upper.shape.max", format!("(0.5, {})", 1.0 + side))?;
    if couette {
        template = template
            .set("conditions", "[]")?
            .set("bodies.upper.formulation.surface_velocity", "(1.0, 0.0)")?;
    }
    let mut simulation = template.build(registry)?;
    let fluid = body(&simulation, "fluid")?;
    let name = if couette { "Couette" } else { "Poiseuille" };
    let mut checks = Vec::new();
    for tau in [0.05, 0.1, 0.8] {
        // nu = 0.1 m2/s and L = 1 m.
        run_until(&mut simulation, 10.0 * tau * (1.0 - 1e-9))?;
        let reference = profile(tau, couette)?;
        let (view, rows) = simulation.world().body_view(fluid);
        let (position, velocity) = (view.read::<Position>()?, view.read::<Velocity>()?);
        let count = rows.len() as f64;
        let error: f64 = rows
            .map(|row| {
                let exact = interpolated(&reference, position[row].0.y);
                (velocity[row].0.x - exact).powi(2)
            })
            .sum();
        checks.push(Check::new(
            format!("rms error of {name} flow at nu t / L^2 = {tau}, over the largest speed"),
            (error / count).sqrt(),
            0.0,
            Tolerance::Absolute(0.02),
            "1",
            "series, reference.csv",
        ));
    }
    Ok(checks)
}

/// The value at y of a profile given at equal distances, by the parabola through three of its points.
fn interpolated(profile: &[(f64, f64)], y: f64) -> f64 {
    let last = profile.len() - 1;
    let step = 1.0 / last as f64;
    let middle = ((y / step).round() as usize).clamp(1, last - 1);
    let [a, b, c] = [profile[middle - 1].1, profile[middle].1, profile[middle + 1].1];
    let s = y / step - middle as f64;
    b + 0.5 * s * (c - a) + 0.5 * s * s * (a - 2.0 * b + c)
}
