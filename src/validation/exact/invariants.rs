//! K2, K3, K4 and K6: what holds exactly for an irregular total-Lagrangian body and its stabilizers.

use std::f64::consts::PI;

use anyhow::Result;
use meshless_engine::glam::{DMat3, DVec3};
use meshless_engine::plugin::Registry;
use meshless_engine::simulation::Simulation;
use meshless_engine::world::{BodyId, DeformationGradient, Force, Mass, Position, Velocity};

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

/// Force, place, velocity and mass of a particle.
#[derive(Clone, Copy, PartialEq)]
struct Row {
    f: DVec3,
    x: DVec3,
    v: DVec3,
    m: f64,
}

/// A body of 1 x 0.5 m, irregular, `across` particles high, with the plugins of the scene given, that is moved to `place` and
/// has a velocity.
fn block(
    registry: &Registry,
    across: usize,
    plugins: &str,
    place: impl Fn(DVec3) -> DVec3,
    velocity: impl Fn(DVec3) -> DVec3,
) -> Result<Simulation> {
    let simulation = Template::new(
        "tests/validation/invariants/scene.ron",
        include_str!("../../../tests/validation/invariants/scene.ron"),
    )
    .set("bodies.block.spacing", 0.5 / across as f64)?
    .set("plugins", format!("[{plugins}]"))?
    .build(registry)?;
    {
        let (view, _) = simulation.world().body_view(BodyId(0));
        let (mut x, mut v) = (view.write::<Position>()?, view.write::<Velocity>()?);
        for (x, v) in x.iter_mut().zip(v.iter_mut()) {
            v.0 = velocity(x.0);
            x.0 = place(x.0);
        }
    }
    Ok(simulation)
}

fn at_rest(_: DVec3) -> DVec3 {
    DVec3::ZERO
}

fn rows(simulation: &Simulation) -> Result<Vec<Row>> {
    let (view, _) = simulation.world().body_view(BodyId(0));
    let (f, x) = (view.read::<Force>()?, view.read::<Position>()?);
    let (v, m) = (view.read::<Velocity>()?, view.read::<Mass>()?);
    Ok((0..view.len()).map(|k| Row { f: f[k].0, x: x[k].0, v: v[k].0, m: m[k].0 }).collect())
}

/// A displacement that no neighbourhood sees as affine.
fn rough(x: DVec3) -> DVec3 {
    let phase = 31.0 * x.x + 17.0 * x.y;
    0.004 * DVec3::new(phase.sin(), (1.7 * phase + 0.3).cos(), 0.0)
}

/// Net force and net torque, over the sum of the sizes of the forces.
fn net(rows: &[Row]) -> [Check; 2] {
    let size: f64 = rows.iter().map(|row| row.f.length()).sum();
    let force: DVec3 = rows.iter().map(|row| row.f).sum();
    let torque: DVec3 = rows.iter().map(|row| row.x.cross(row.f)).sum();
    [
        Check::below("net force over all forces", force.length() / size, 1e-10, "exact"),
        Check::below("net torque over all forces", torque.length() / size, 1e-10, "exact"),
    ]
}

fn affine(registry: &Registry, across: usize) -> Result<Vec<Check>> {
    let map = DMat3::from_cols(DVec3::new(1.2, 0.3, 0.0), DVec3::new(-0.2, 0.8, 0.0), DVec3::Z);
    let mut simulation = block(registry, across, "", |x| map * x + DVec3::new(0.7, -0.4, 0.0), at_rest)?;
    simulation.start()?;
    let (view, _) = simulation.world().body_view(BodyId(0));
    let off = |f: &DeformationGradient| (f.0 - map).to_cols_array().into_iter().map(f64::abs);
    let worst = view.read::<DeformationGradient>()?.iter().flat_map(off).fold(0.0, f64::max);
    let mut checks = vec![Check::below("largest error of F", worst, 1e-10, "exact")];
    checks.extend(net(&rows(&simulation)?));
    Ok(checks)
}

fn gradient(registry: &Registry, across: usize) -> Result<Vec<Check>> {
    let mut simulation = block(registry, across, "", |x| x + rough(x), at_rest)?;
    let start = rows(&block(registry, across, "", |x| x, at_rest)?)?;
    simulation.start()?;
    let moved = rows(&simulation)?;
    let scale = moved.iter().map(|row| row.f.length()).fold(0.0, f64::max);
    let mut worst = 0.0f64;
    for k in [0, moved.len() / 3, moved.len() / 2, moved.len() - 1] {
        for axis in [DVec3::X, DVec3::Y] {
            let energy = |by: f64| -> Result<f64> {
                let more = |x: DVec3| if x == start[k].x { by * axis } else { DVec3::ZERO };
                let mut simulation = block(registry, across, "", |x| x + rough(x) + more(x), at_rest)?;
                simulation.start()?;
                let ledger = simulation.ledger();
                Ok(ledger.total_named("strain") + ledger.total_named("hourglass"))
            };
            let h = 1e-4;
            let near = 8.0 * (energy(h)? - energy(-h)?);
            let slope = (near - (energy(2.0 * h)? - energy(-2.0 * h)?)) / (12.0 * h);
            worst = worst.max((moved[k].f.dot(axis) + slope).abs() / scale);
        }
    }
    let mut checks = vec![Check::below("force plus slope, over the largest force", worst, 1e-6, "exact")];
    checks.extend(net(&moved));
    Ok(checks)
}

fn pair_term(registry: &Registry, across: usize) -> Result<Vec<Check>> {
    let with = "artificial_viscosity(alpha: 1.0, beta: 0.0)";
    let wild = |x: DVec3| 2.5 * rough(x);
    let mut simulation = block(registry, across, with, |x| x, wild)?;
    simulation.start()?;
    let start = rows(&simulation)?;
    let power: f64 = start.iter().map(|row| row.f.dot(row.v)).sum();
    simulation.run(|simulation| simulation.clock().step < 50)?;
    let (before, _, size, _) = momenta(&start);
    let push = momenta(&rows(&simulation)?).0.distance(before) / size;
    let mut rigid = block(registry, across, with, |x| x, |_| DVec3::new(0.3, -0.2, 0.0))?;
    rigid.start()?;
    let idle: f64 = rows(&rigid)?.iter().map(|row| row.f.length()).sum();
    let after = |plugins: &str| -> Result<Vec<Row>> {
        let mut simulation = block(registry, across, plugins, |x| x, wild)?;
        simulation.run(|simulation| simulation.clock().step < 20)?;
        rows(&simulation)
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

/// Momentum, angular momentum about the origin, and the sums of their sizes.
fn momenta(rows: &[Row]) -> (DVec3, DVec3, f64, f64) {
    let momenta = || rows.iter().map(|row| row.m * row.v);
    let spins = || rows.iter().map(|row| row.x.cross(row.m * row.v));
    (momenta().sum(), spins().sum(), momenta().map(DVec3::length).sum(), spins().map(DVec3::length).sum())
}

fn thrown(registry: &Registry, across: usize) -> Result<Vec<Check>> {
    let (center, spin) = (DVec3::new(0.5, 0.25, 0.0), DVec3::new(0.0, 0.0, 0.05));
    let velocity = |x: DVec3| {
        let swing = 0.02 * (PI * x.x).cos();
        DVec3::new(0.01 + swing, 0.02, 0.0) + spin.cross(x - center)
    };
    let mut simulation = block(registry, across, "", |x| x, velocity)?;
    simulation.start()?;
    let (momentum, angular, size, spin_size) = momenta(&rows(&simulation)?);
    let energy = simulation.ledger().stored();
    let (mut drift, mut push, mut twist) = (0.0f64, 0.0f64, 0.0f64);
    while !simulation.is_finished() {
        simulation.step()?;
        drift = drift.max((simulation.ledger().stored() / energy - 1.0).abs());
        if simulation.clock().step % 100 == 0 {
            let (now, turning, ..) = momenta(&rows(&simulation)?);
            push = push.max(now.distance(momentum) / size);
            twist = twist.max(turning.distance(angular) / spin_size);
        }
    }
    Ok(vec![
        Check::below("change of momentum", push, 1e-12, "exact"),
        Check::below("change of angular momentum", twist, 1e-10, "exact"),
        Check::below("change of energy", drift, 5e-3, "conserved"),
    ])
}
