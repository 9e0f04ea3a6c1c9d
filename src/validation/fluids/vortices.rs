//! F13: vortices and channels at Reynolds numbers at which rows and lattices break up.

use std::f64::consts::PI;

use anyhow::Result;
use meshless_engine::plugin::Registry;
use meshless_engine::simulation::Simulation;
use meshless_engine::world::{Position, Velocity};

use super::viscous_channel;
use crate::case::Case;
use crate::check::{Check, Tolerance};
use crate::measure::{body, run};
use crate::template::Template;

pub(crate) const CASE: Case = Case {
    id: "F13",
    title: "vortices at Re 200 and 1000, Lamb-Oseen vortex, channels at Re 50 and 200",
    resolutions: &[25, 50, 100],
    ci_resolution: 25,
    run: vortices,
};

/// Tolerance of the kinetic energy at 100 across, proportional to the spacing.
const ENERGY: f64 = 0.015;
/// Tolerance of the effective viscosity with ten spacings in the core, proportional to the spacing.
const VISCOSITY: f64 = 0.03;

fn vortices(registry: &Registry, across: usize) -> Result<Vec<Check>> {
    let mut checks = Vec::new();
    for reynolds in [200.0, 1000.0] {
        for lattice in ["Relaxed(seed: 1, iterations: 30)", "Square"] {
            checks.push(taylor_green(registry, across, reynolds, lattice)?);
        }
    }
    checks.push(lamb_oseen(registry, across)?);
    for reynolds in [50.0, 200.0] {
        for lattice in ["Square", "Relaxed(seed: 1, iterations: 30)"] {
            // Channels are compared at 40 across where vortices are at 100.
            checks.push(viscous_channel::flux(registry, across * 2 / 5, reynolds, lattice)?);
        }
    }
    Ok(checks)
}

fn taylor_green(registry: &Registry, across: usize, reynolds: f64, lattice: &str) -> Result<Check> {
    let path = "tests/validation/taylor_green/scene.ron";
    let text = include_str!("../../../tests/validation/taylor_green/scene.ron");
    let mut simulation = Template::new(path, text)
        .set("bodies.fluid.spacing", 1.0 / across as f64)?
        .set("bodies.fluid.lattice", lattice)?
        .set("materials.fluid.viscosity", 1.0 / reynolds)?
        .set("time.end", 1.0)?
        .build(registry)?;
    simulation.start()?;
    let kinetic = |simulation: &Simulation| simulation.ledger().total_named("kinetic");
    let start = kinetic(&simulation);
    run(&mut simulation, |_| Ok(()))?;
    let exact = (-16.0 * PI * PI * simulation.clock().time / reynolds).exp();
    let name = lattice.split('(').next().unwrap_or(lattice).to_lowercase();
    let check = Check::new(
        format!("kinetic energy at 1 s, Re {reynolds}, {name}"),
        kinetic(&simulation) / start,
        exact,
        Tolerance::Relative(ENERGY * 100.0 / across as f64),
        "1",
        "exp(-16 pi^2 t / Re), exact solution",
    );
    // The break-up of a square lattice does not depend on the spacing.
    Ok(if lattice == "Square" { check } else { check.converging() })
}

/// As many spacings in half a metre as `across`: five in the core at 25.
fn lamb_oseen(registry: &Registry, across: usize) -> Result<Check> {
    let spacing = 0.5 / across as f64;
    let path = "tests/validation/lamb_oseen/scene.ron";
    let text = include_str!("../../../tests/validation/lamb_oseen/scene.ron");
    let mut simulation = Template::new(path, text)
        .set("bodies.fluid.spacing", spacing)?
        .set("bodies.wall.spacing", spacing)?
        .set("bodies.wall.shape.outer", 0.6 + 4.0 * spacing)?
        .build(registry)?;
    let fluid = body(&simulation, "fluid")?;
    run(&mut simulation, |_| Ok(()))?;
    let (view, rows) = simulation.world().body_view(fluid);
    let (position, velocity) = (view.read::<Position>()?, view.read::<Velocity>()?);
    let swirl: Vec<(f64, f64)> = rows
        .map(|row| (position[row].0, velocity[row].0))
        .map(|(x, v)| (x.length(), (x.x * v.y - x.y * v.x) / x.length()))
        .filter(|(r, _)| (1e-6..0.4).contains(r))
        .collect();
    let misfit = |core: f64| -> f64 {
        let exact = |r: f64| 0.1 / r * (1.0 - (-r * r / core).exp());
        swirl.iter().map(|&(r, u)| (u - exact(r)).powi(2)).sum()
    };
    let core = minimizer(misfit, 0.005, 0.06);
    let viscosity = (core - 0.01) / (4.0 * simulation.clock().time);
    let check = Check::new(
        "effective viscosity of the Lamb-Oseen vortex",
        viscosity,
        1e-3,
        Tolerance::Relative(VISCOSITY * 10.0 * spacing / 0.1),
        "m2/s",
        "that of the scene",
    );
    Ok(check.converging())
}

/// Position of the minimum of a function, by trisection.
fn minimizer(of: impl Fn(f64) -> f64, mut low: f64, mut high: f64) -> f64 {
    for _ in 0..60 {
        let third = (high - low) / 3.0;
        if of(low + third) < of(high - third) { high -= third } else { low += third }
    }
    0.5 * (low + high)
}
