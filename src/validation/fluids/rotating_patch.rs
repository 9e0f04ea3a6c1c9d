//! F9: a rotating square patch of fluid, without walls.

use anyhow::{Context, Result};
use meshless_engine::formulations::fluid::FlowCloud;
use meshless_engine::glam::DVec3;
use meshless_engine::plugin::Registry;
use meshless_engine::simulation::Simulation;
use meshless_engine::world::{BodyId, Position, Pressure};

use crate::case::Case;
use crate::check::{Check, Tolerance};
use crate::measure::{Balance, Kind, Record, body};
use crate::template::Template;

pub(crate) const CASE: Case = Case {
    id: "F9",
    title: "rotating square patch",
    resolutions: &[25, 50, 100],
    ci_resolution: 25,
    run: rotating_patch,
};

const REFERENCE: &str = include_str!("../../../tests/validation/rotating_patch/reference.csv");
const SOURCE: &str = "boundary elements, reference.csv";
/// Tolerances at 50 across, proportional to the spacing.
const SIDE: f64 = 0.02;
const PRESSURE: f64 = 0.1;
/// Resolution from which the patch must stay in one piece, and until which time, s.
const FINE: usize = 50;
const LAST: f64 = 4.0;
/// Averaging time of the pressure before the stated time, s: three periods of the sound that the patch
/// breathes with; and radius about the centre, m.
const WINDOW: f64 = 0.4;
const MIDDLE: f64 = 0.06;

fn rotating_patch(registry: &Registry, across: usize) -> Result<Vec<Check>> {
    let spacing = 1.0 / across as f64;
    let path = "tests/validation/rotating_patch/scene.ron";
    let text = include_str!("../../../tests/validation/rotating_patch/scene.ron");
    let mut simulation = Template::new(path, text).set("bodies.patch.spacing", spacing)?.build(registry)?;
    let patch = body(&simulation, "patch")?;
    let coarse = 50.0 * spacing;
    let (mut checks, mut balance) = (Vec::new(), Balance::default());
    let sides = Record::read(REFERENCE, "omega_t", "r_min/L")?;
    let pressures = Record::read(REFERENCE, "omega_t", "p_centre/(rho omega^2 L^2)")?;
    for time in [1.0, 2.0] {
        let mut pressure = Record::default();
        while simulation.clock().time < time {
            simulation.step()?;
            balance.see(&simulation);
            pressure.push(simulation.clock().time, pressure_in_the_middle(&simulation, patch)?);
        }
        let side = nearest_side(&simulation, patch)?;
        let tolerance = Tolerance::Relative(SIDE * coarse);
        let name = format!("nearest side at omega t = {time}, over L");
        let found = sides.0.iter().find(|sample| (sample.0 - time).abs() < 1e-9);
        let exact = found.context("the reference has no such time")?.1;
        checks.push(Check::new(name, side, exact, tolerance, "1", SOURCE).converging());
        // The pressure rises by rho omega^2 r^2 / 2 from the centre, so that its mean over the disc is larger
        // than that at the centre by half of the rise at the radius.
        let window = time - WINDOW..=time;
        let centre = pressure.mean(&window)? - 0.25 * MIDDLE * MIDDLE;
        let tolerance = Tolerance::Relative(PRESSURE * coarse);
        let name = format!("pressure in the middle, mean until omega t = {time}, over rho omega^2 L^2");
        let exact = pressures.mean(&window)?;
        checks.push(Check::new(name, centre, exact, tolerance, "1", SOURCE).converging());
    }
    if across >= FINE {
        let support = simulation.resources().get::<FlowCloud>().kernel.support;
        for time in [2.0, LAST] {
            while simulation.clock().time < time {
                simulation.step()?;
                balance.see(&simulation);
            }
            let share = largest_piece(&simulation, patch, support)?;
            let name = format!("share of the largest piece at omega t = {time:.0}");
            checks.push(Check::above(name, share, 0.98, "one piece"));
        }
    }
    checks.push(balance.check(Kind::Smooth));
    Ok(checks)
}

fn positions(simulation: &Simulation, patch: BodyId) -> Result<Vec<DVec3>> {
    let (view, rows) = simulation.world().body_view(patch);
    let position = view.read::<Position>()?;
    Ok(rows.map(|row| position[row].0).collect())
}

/// Mean pressure within a distance of the centre, Pa.
fn pressure_in_the_middle(simulation: &Simulation, patch: BodyId) -> Result<f64> {
    let (view, rows) = simulation.world().body_view(patch);
    let (position, pressure) = (view.read::<Position>()?, view.read::<Pressure>()?);
    let inside: Vec<f64> =
        rows.filter(|&row| position[row].0.length() < MIDDLE).map(|row| pressure[row].0).collect();
    Ok(inside.iter().sum::<f64>() / inside.len() as f64)
}

/// Minimum distance of the surface from the centre, m, averaged over the four sides: at the surface the
/// volume of particles over that of space falls to a half.
fn nearest_side(simulation: &Simulation, patch: BodyId) -> Result<f64> {
    let positions = positions(simulation, patch)?;
    let cloud = simulation.resources().get::<FlowCloud>();
    let filled = |at: DVec3| -> f64 {
        positions.iter().enumerate().map(|(i, x)| cloud.volume(i) * cloud.kernel.value(x.distance(at))).sum()
    };
    let surface = |degrees: u32| {
        let (y, x) = f64::from(degrees).to_radians().sin_cos();
        let (mut inside, mut outside) = (0.15, 0.8);
        for _ in 0..12 {
            let middle = 0.5 * (inside + outside);
            if filled(middle * DVec3::new(x, y, 0.0)) > 0.5 { inside = middle } else { outside = middle }
        }
        0.5 * (inside + outside)
    };
    let mean = |k: u32| (0..4).map(|side| surface(3 * k + 90 * side)).sum::<f64>() / 4.0;
    Ok((0..30).map(mean).fold(f64::INFINITY, f64::min))
}

/// Fraction of the particles in the largest group of particles that act on each other: nearer than the
/// support radius `gap`, m.
fn largest_piece(simulation: &Simulation, patch: BodyId, gap: f64) -> Result<f64> {
    let positions = positions(simulation, patch)?;
    let mut waiting: Vec<usize> = (0..positions.len()).collect();
    let mut largest = 0;
    while let Some(start) = waiting.pop() {
        let (mut piece, mut done) = (vec![start], 0);
        while done < piece.len() {
            let at = positions[piece[done]];
            waiting.retain(|&k| {
                let near = positions[k].distance(at) < gap;
                if near {
                    piece.push(k);
                }
                !near
            });
            done += 1;
        }
        largest = largest.max(piece.len());
    }
    Ok(largest as f64 / positions.len() as f64)
}
