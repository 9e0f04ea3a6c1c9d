//! K2, K3, K4 and K6: exact properties of an irregular total-Lagrangian body and its stabilizers.

use std::f64::consts::PI;

use anyhow::Result;
use meshless_engine::glam::{DMat3, DVec3};
use meshless_engine::invariants::{Momenta, NetForce, Specimen};
use meshless_engine::plugin::Registry;
use meshless_engine::simulation::Simulation;
use meshless_engine::world::{BodyId, Force, Position, Velocity};

use crate::case::Case;
use crate::check::{Check, Tolerance};
use crate::template::Template;

pub(crate) const AFFINE: Case = Case {
    id: "K2",
    title: "affine map of an irregular body",
    resolutions: &[5],
    ci_resolution: 5,
    run: affine,
};
pub(crate) const GRADIENT: Case = Case {
    id: "K3",
    title: "force against the slope of strain and hourglass energy",
    resolutions: &[5],
    ci_resolution: 5,
    run: gradient,
};
pub(crate) const PAIR_TERM: Case = Case {
    id: "K4",
    title: "artificial viscosity as a pair term",
    resolutions: &[5],
    ci_resolution: 5,
    run: pair_term,
};
pub(crate) const THROWN: Case = Case {
    id: "K6",
    title: "thrown, spinning and swinging body, 100 periods",
    resolutions: &[5],
    ci_resolution: 5,
    run: thrown,
};

/// Bodies of 1 x 0.5 m, irregular, `across` particles high, with the plugins of the scene given.
fn block(registry: &Registry, across: usize, plugins: &str) -> Result<Simulation> {
    let template = Template::new(
        "tests/validation/invariants/scene.ron",
        include_str!("../../../tests/validation/invariants/scene.ron"),
    );
    let template = template.set("bodies.block.spacing", 0.5 / across as f64)?;
    Ok(template.set("plugins", format!("[{plugins}]"))?.build(registry)?)
}

/// Net force and net torque, over the sum of the magnitudes of the forces.
fn net(net: NetForce) -> [Check; 2] {
    [
        Check::below("net force over all forces", net.force, 1e-10, "exact"),
        Check::below("net torque over all forces", net.torque, 1e-10, "exact"),
    ]
}

fn affine(registry: &Registry, across: usize) -> Result<Vec<Check>> {
    let map = DMat3::from_cols(DVec3::new(1.2, 0.3, 0.0), DVec3::new(-0.2, 0.8, 0.0), DVec3::Z);
    let make = || block(registry, across, "");
    let found = Specimen::new(&make).affine(map, DVec3::new(0.7, -0.4, 0.0))?;
    let mut checks = vec![Check::below("largest error of F", found.gradient, 1e-10, "exact")];
    checks.extend(net(found.net));
    Ok(checks)
}

fn gradient(registry: &Registry, across: usize) -> Result<Vec<Check>> {
    let make = || block(registry, across, "");
    let found = Specimen::new(&make).slope()?;
    let mut checks =
        vec![Check::below("force plus slope, over the largest force", found.error, 1e-6, "exact")];
    checks.extend(net(found.net));
    Ok(checks)
}

/// Velocities that are not affine in any neighbourhood, m/s.
fn wild(x: DVec3) -> DVec3 {
    let phase = 31.0 * x.x + 17.0 * x.y;
    0.01 * DVec3::new(phase.sin(), (1.7 * phase + 0.3).cos(), 0.0)
}

/// Force and velocity of every particle.
fn forces(simulation: &Simulation) -> Result<Vec<(DVec3, DVec3)>> {
    let (view, rows) = simulation.world().body_view(BodyId(0));
    let (f, v) = (view.read::<Force>()?, view.read::<Velocity>()?);
    Ok(rows.map(|k| (f[k].0, v[k].0)).collect())
}

fn pair_term(registry: &Registry, across: usize) -> Result<Vec<Check>> {
    let moving = |plugins: &str, velocity: fn(DVec3) -> DVec3| {
        Specimen::new(&|| block(registry, across, plugins)).moved(|_, x| x, velocity)
    };
    let with = "artificial_viscosity(alpha: 1.0, beta: 0.0)";
    let mut simulation = moving(with, wild)?;
    simulation.start()?;
    let power: f64 = forces(&simulation)?.iter().map(|(f, v)| f.dot(*v)).sum();
    let start = Momenta::of(&simulation)?;
    simulation.run(|simulation| simulation.clock().step < 50)?;
    let push = Momenta::of(&simulation)?.linear.distance(start.linear) / start.linear_size;
    let mut rigid = moving(with, |_| DVec3::new(0.3, -0.2, 0.0))?;
    rigid.start()?;
    let idle: f64 = forces(&rigid)?.iter().map(|(f, _)| f.length()).sum();
    let after = |plugins: &str| -> Result<Vec<[DVec3; 3]>> {
        let mut simulation = moving(plugins, wild)?;
        simulation.run(|simulation| simulation.clock().step < 20)?;
        let (view, rows) = simulation.world().body_view(BodyId(0));
        let x = view.read::<Position>()?;
        Ok(forces(&simulation)?.iter().zip(rows).map(|((f, v), k)| [*f, *v, x[k].0]).collect())
    };
    let off = after("artificial_viscosity(alpha: 0.0, beta: 0.0)")?;
    let differ = off.iter().zip(&after("")?).filter(|(a, b)| a != b).count() as f64;
    let zero = |name, found, most, unit, why| Check::new(name, found, 0.0, most, unit, why);
    Ok(vec![
        Check::below("change of momentum in 50 steps", push, 1e-12, "opposite forces"),
        zero("power of the forces", power, Tolerance::Below, "W", "it dissipates"),
        zero("forces in a translation", idle, Tolerance::Absolute(1e-12), "N", "exact"),
        zero("particles that differ with coefficient 0", differ, Tolerance::Absolute(0.0), "1", "bitwise"),
    ])
}

fn thrown(registry: &Registry, across: usize) -> Result<Vec<Check>> {
    let (center, spin) = (DVec3::new(0.5, 0.25, 0.0), DVec3::new(0.0, 0.0, 0.05));
    let make = || block(registry, across, "");
    let found = Specimen::new(&make).thrown(|x| {
        let swing = 0.02 * (PI * x.x).cos();
        DVec3::new(0.01 + swing, 0.02, 0.0) + spin.cross(x - center)
    })?;
    Ok(vec![
        Check::below("change of momentum", found.momentum, 1e-12, "exact"),
        Check::below("change of angular momentum", found.angular_momentum, 1e-10, "exact"),
        Check::below("change of energy", found.energy, 5e-3, "conserved"),
    ])
}
