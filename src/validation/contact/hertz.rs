//! C1: Hertz contact: impact of rigid spheres, and a deformable cylinder between planes.

use std::f64::consts::PI;

use anyhow::{Context, Result};
use meshless_engine::glam::DVec3;
use meshless_engine::plugin::Registry;
use meshless_engine::simulation::Simulation;

use crate::case::Case;
use crate::check::{Check, Tolerance};
use crate::measure::{MaterialPoint, body, rows, run, state};
use crate::template::Template;

pub(crate) const CASE: Case = Case {
    id: "C1",
    title: "Hertz: sphere impact, cylinder on a plane",
    resolutions: &[24, 48, 96],
    ci_resolution: 24,
    run: hertz,
};

const SPHERES: &str = include_str!("../../../tests/validation/hertz/reference.csv");
const SOURCE: &str = "closed form, reference.csv";
const CYLINDER: &str = "closed form (Johnson 1985), cylinder.csv";

/// `across` is the number of rings of particles of the cylinder.
fn hertz(registry: &Registry, across: usize) -> Result<Vec<Check>> {
    let mut checks = Vec::new();
    for (radius, density, young, poisson, speed, case) in [
        (0.01, 7850.0, 2.1e11, 0.3, 1.0, "steel sphere on rigid plane (rigid plane)"),
        (0.05, 1100.0, 1.0e7, 0.45, 1.0, "rubber sphere E=10MPa (rigid plane)"),
        (0.005, 2700.0, 7.0e10, 0.3, 0.1, "Al sphere (rigid plane)"),
    ] {
        let row = rows(SPHERES).find(|row| row[0] == case).with_context(|| format!("no row {case}"))?;
        let number = |k: usize| row[k].parse::<f64>().context("a number");
        let (mass, deepest, force, time) = (number(3)?, number(5)?, number(6)?, number(7)?);
        let mut simulation = Template::new(
            "tests/validation/hertz/scene.ron",
            include_str!("../../../tests/validation/hertz/scene.ron"),
        )
        .set("materials.ball.density", density)?
        .set("materials.ball.young", young)?
        .set("materials.ball.poisson", poisson)?
        .set("bodies.ball.shape.radius", radius)?
        .set("bodies.ball.shape.center", format!("(0.0, 0.0, {})", radius + 1e-6 * radius))?
        .set("bodies.ball.spacing", 0.25 * radius)?
        .set("bodies.ball.formulation", format!("Rigid(mass: {mass})"))?
        .set("bodies.ball.velocity", format!("(0.0, 0.0, {})", -speed))?
        .set("time.end", 1.5 * time)?
        .build(registry)?;
        let found = impact(&mut simulation, radius)?;
        let name = |what| format!("{}: {what}", case.split(' ').next().unwrap_or(case));
        let near = |name, measured, reference, unit| {
            Check::new(name, measured, reference, Tolerance::Relative(0.01), unit, SOURCE)
        };
        checks.push(near(name("approach"), found.deepest, deepest, "m"));
        checks.push(near(name("force"), found.force, force, "N"));
        checks.push(near(name("time of contact"), found.time, time, "s"));
        checks.push(near(name("rebound"), found.rebound, speed, "m/s"));
    }
    checks.extend(cylinder(registry, across)?);
    Ok(checks)
}

struct Impact {
    deepest: f64,
    force: f64,
    time: f64,
    rebound: f64,
}

fn impact(simulation: &mut Simulation, radius: f64) -> Result<Impact> {
    let (mut deepest, mut force, mut begin, mut end) = (0.0f64, 0.0f64, None, 0.0);
    let mut last = (0.0, -1.0);
    run(simulation, |simulation| {
        let ball = state(simulation, "ball")?;
        let (time, overlap) = (simulation.clock().time, radius - ball.center.z);
        deepest = deepest.max(overlap);
        force = force.max(ball.force.z);
        // Where the overlap passes zero, between two samples.
        if (last.1 < 0.0) != (overlap < 0.0) && time > 0.0 {
            let crossing = last.0 + (time - last.0) * last.1 / (last.1 - overlap);
            begin.get_or_insert(crossing);
            end = crossing;
        }
        last = (time, overlap);
        Ok(())
    })?;
    let rebound = state(simulation, "ball")?.velocity.z;
    Ok(Impact { deepest, force, time: end - begin.context("no contact")?, rebound })
}

/// Radius, m, and modulus E*, Pa, of the cylinder.
const RADIUS: f64 = 0.05;
const MODULUS: f64 = 1.0e7 / (1.0 - 0.45 * 0.45);

/// Number of points of the surface on either side of the lowest one at which the overlap is evaluated, up to
/// an angle of ARC.
const POINTS: i32 = 400;
const ARC: f64 = 0.3;

fn cylinder(registry: &Registry, rings: usize) -> Result<Vec<Check>> {
    let spacing = RADIUS / rings as f64;
    let mut simulation = Template::new(
        "tests/validation/hertz/cylinder.ron",
        include_str!("../../../tests/validation/hertz/cylinder.ron"),
    )
    .set("bodies.cylinder.spacing", spacing)?
    .build(registry)?;
    run(&mut simulation, |_| Ok(()))?;
    let (upper, lower) = (state(&simulation, "upper")?, state(&simulation, "lower")?);
    let force = 0.5 * (upper.force.y - lower.force.y);
    // The half width follows from the second moment of the pressure, a^2/4 in the theory of Hertz: no single
    // particle determines it.
    let plane = lower.center.y + 0.005;
    let cylinder = body(&simulation, "cylinder")?;
    let (mut total, mut moment) = (0.0, 0.0);
    for k in -POINTS..=POINTS {
        let angle = ARC * f64::from(k) / f64::from(POINTS);
        let place = RADIUS * DVec3::new(angle.sin(), -angle.cos(), 0.0);
        let x = MaterialPoint::new(&simulation, cylinder, place)?.position(&simulation)?;
        let push = (plane - x.y).max(0.0);
        total += push;
        moment += push * x.x * x.x;
    }
    let half_width = 2.0 * (moment / total).sqrt();
    let expected = (4.0 * force * RADIUS / (PI * MODULUS)).sqrt();
    // Approach of the plane to the centre, for the load and its half width.
    let approach = 0.5 * ((lower.center.y - upper.center.y) + 0.11);
    let line = force / (PI * MODULUS) * (2.0 * (4.0 * RADIUS / expected).ln() - 1.0);
    Ok(vec![
        Check::new("cylinder: half width", half_width, expected, Tolerance::Relative(0.05), "m", CYLINDER)
            .converging(),
        Check::new(
            "cylinder: approach at this force",
            approach,
            line,
            Tolerance::Relative(0.05),
            "m",
            CYLINDER,
        ),
        Check::new("cylinder: force", force, 1.0e4, Tolerance::Relative(0.05), "N/m", CYLINDER),
    ])
}
