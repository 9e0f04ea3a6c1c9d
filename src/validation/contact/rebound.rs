//! C4: bodies on triangulated surfaces.

use anyhow::Result;
use meshless_engine::glam::DVec3;
use meshless_engine::plugin::Registry;
use meshless_engine::rigid::RigidBodies;
use meshless_engine::simulation::Simulation;
use meshless_engine::world::{Mass, Position, Velocity};

use crate::case::Case;
use crate::check::{Check, Tolerance};
use crate::measure::{Kind, body, run, state};
use crate::template::Template;

pub(crate) const CASE: Case = Case {
    id: "C4",
    title: "rebound from triangulated surfaces",
    resolutions: &[5, 8],
    ci_resolution: 5,
    run: rebound,
};

const BALANCE: &str = "momentum balance";
/// Number of bounces at the resolution of the tests, and at others.
const BOUNCES: [usize; 2] = [100, 1000];

/// `across` is the number of particles over the side of the block.
fn rebound(registry: &Registry, across: usize) -> Result<Vec<Check>> {
    let mut checks = Vec::new();
    // Initial centre of the block, and the point that it flies to, at 0.3 of the speed of sound.
    for (name, start) in [
        ("face", DVec3::new(0.45, 0.55, 1.4)),
        ("edge", DVec3::new(1.3, 0.45, 1.35)),
        ("corner", DVec3::new(1.35, 1.3, 1.32)),
    ] {
        let target = start.clamp(DVec3::ZERO, DVec3::ONE);
        let velocity = 11.0 * (target - start).normalize();
        let (low, high) = (start - 0.25, start + 0.25);
        let mut simulation = Template::new(
            concat!(env!("CARGO_MANIFEST_DIR"), "/../../tests/validation/rebound/scene.ron"),
            include_str!("../../../tests/validation/rebound/scene.ron"),
        )
        .set("bodies.block.shape", format!("Box(min: {}, max: {})", tuple(low), tuple(high)))?
        .set("bodies.block.velocity", tuple(velocity))?
        .set("bodies.block.spacing", 0.5 / across as f64)?
        .build(registry)?;
        simulation.start()?;
        let (momentum, angular) = momenta(&simulation)?;
        let mut deepest = f64::INFINITY;
        let balance = run(&mut simulation, |simulation| {
            deepest = deepest.min(min_distance(simulation)?);
            Ok(())
        })?;
        let (after, turning) = momenta(&simulation)?;
        let error = (after - momentum).length() / momentum.length();
        let angular_error = (turning - angular).length() / angular.length();
        checks.push(Check::below(format!("{name}: momentum error"), error, 1e-10, BALANCE));
        checks.push(Check::below(format!("{name}: angular momentum error"), angular_error, 1e-10, BALANCE));
        // At this speed an edge penetrates between the particles; a layer that passed through would stay
        // inside.
        let inside = "no layer passes the surface";
        checks.push(Check::above(
            format!("{name}: least distance over spacing"),
            deepest * across as f64 / 0.5,
            -1.0,
            inside,
        ));
        let away =
            (mean_velocity(&simulation)? - state(&simulation, "cube")?.velocity).dot(velocity.normalize());
        checks.push(Check::below(
            format!("{name}: velocity of separation, m/s"),
            away,
            -0.5,
            "it flies away",
        ));
        checks.push(balance.check_of(name, Kind::Abrupt));
    }
    checks.extend(bounces(registry, BOUNCES[usize::from(across != CASE.ci_resolution)])?);
    Ok(checks)
}

fn tuple(v: DVec3) -> String {
    format!("({:?}, {:?}, {:?})", v.x, v.y, v.z)
}

/// Momentum and angular momentum about the origin of both bodies.
fn momenta(simulation: &Simulation) -> Result<(DVec3, DVec3)> {
    let (view, rows) = simulation.world().body_view(body(simulation, "block")?);
    let (m, x, v) = (view.read::<Mass>()?, view.read::<Position>()?, view.read::<Velocity>()?);
    let mut linear: DVec3 = rows.clone().map(|row| m[row].0 * v[row].0).sum();
    let mut angular: DVec3 = rows.map(|row| x[row].0.cross(m[row].0 * v[row].0)).sum();
    let cube = state(simulation, "cube")?;
    let bodies = simulation.resources().get::<RigidBodies>();
    let mass = bodies[0].mass;
    linear += mass * cube.velocity;
    angular += cube.center.cross(mass * cube.velocity) + cube.angular_momentum;
    Ok((linear, angular))
}

fn mean_velocity(simulation: &Simulation) -> Result<DVec3> {
    let (view, rows) = simulation.world().body_view(body(simulation, "block")?);
    let velocity = view.read::<Velocity>()?;
    let count = rows.len() as f64;
    Ok(rows.map(|row| velocity[row].0).sum::<DVec3>() / count)
}

/// Minimum distance of a particle of the block from the surface, negative inside, m.
fn min_distance(simulation: &Simulation) -> Result<f64> {
    let (view, rows) = simulation.world().body_view(body(simulation, "block")?);
    let position = view.read::<Position>()?;
    let bodies = simulation.resources().get::<RigidBodies>();
    let cube = &bodies[0];
    let distance = |row: usize| cube.surface.closest(cube.reference(position[row].0)).signed_distance;
    Ok(rows.map(distance).fold(f64::INFINITY, f64::min))
}

/// A rigid block that bounces and tumbles on the cube without friction or loss of energy; it does not drift
/// sideways.
fn bounces(registry: &Registry, wanted: usize) -> Result<Vec<Check>> {
    let mut simulation = Template::new(
        concat!(env!("CARGO_MANIFEST_DIR"), "/../../tests/validation/rebound/bounces.ron"),
        include_str!("../../../tests/validation/rebound/bounces.ron"),
    )
    .build(registry)?;
    simulation.start()?;
    let energy = |simulation: &Simulation| -> Result<f64> {
        let height = state(simulation, "block")?.center.z - 1.0;
        let bodies = simulation.resources().get::<RigidBodies>();
        let mass = bodies[1].mass;
        Ok(simulation.ledger().stored() + mass * 9.81 * height)
    };
    let before = energy(&simulation)?;
    let (mut count, mut touching, mut lowest, mut most) = (0, false, f64::INFINITY, 0.0f64);
    while count < wanted && !simulation.is_finished() {
        simulation.step()?;
        let block = state(&simulation, "block")?;
        let pushed = simulation.ledger().total_named("contact") > 0.0;
        count += usize::from(pushed && !touching);
        touching = pushed;
        lowest = lowest.min(block.center.z - 1.0);
        most = most.max(energy(&simulation)? / before - 1.0);
    }
    Ok(vec![
        Check::new(
            "bounces",
            count as f64,
            wanted as f64,
            Tolerance::Absolute(0.5),
            "1",
            "as many as wanted",
        ),
        Check::above("lowest place of the centre over half a side", lowest / 0.05, 0.9, "no tunnelling"),
        Check::below("largest gain of energy", most, 0.05, "no energy from nothing"),
    ])
}
