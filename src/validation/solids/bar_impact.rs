//! S22: impact of two equal bars.

use anyhow::{Context, Result};
use meshless_engine::plugin::Registry;
use meshless_engine::simulation::Simulation;
use meshless_engine::world::{BodyId, Mass, PiolaStress, ReferencePosition, Velocity};

use crate::case::Case;
use crate::check::{Check, Tolerance};
use crate::measure::{Kind, Record, body, rows, run};
use crate::template::Template;

pub(crate) const CASE: Case = Case {
    id: "S22",
    title: "impact of two equal bars",
    resolutions: &[40, 80, 160],
    ci_resolution: 40,
    run: bar_impact,
};

const REFERENCE: &str = include_str!("../../../tests/validation/bar_impact/reference.csv");
const SOURCE: &str = "closed form, reference.csv";
/// Length of a bar, m.
const LENGTH: f64 = 0.1;

/// `along` is the number of particles along a bar.
fn bar_impact(registry: &Registry, along: usize) -> Result<Vec<Check>> {
    let row = rows(REFERENCE).find(|row| row[0] == "Al6061 paper").context("no row of aluminium")?;
    let speed_of_sound: f64 = row[5].parse()?;
    let stress_of_speed: f64 = row[9].parse()?;
    let relative = 0.002 * speed_of_sound;
    let spacing = LENGTH / along as f64;
    let mut simulation = Template::new(
        "tests/validation/bar_impact/scene.ron",
        include_str!("../../../tests/validation/bar_impact/scene.ron"),
    )
    .set("bodies.left.spacing", spacing)?
    .set("bodies.right.spacing", spacing)?
    .set("bodies.left.shape.max", format!("(0.0, {})", 4.0 * spacing))?
    .set("bodies.right.shape.max", format!("(0.1, {})", 4.0 * spacing))?
    .set("conditions[1].at", 4.0 * spacing)?
    .build(registry)?;
    let right = body(&simulation, "right")?;
    let passage = LENGTH / speed_of_sound;
    let mut velocity = Record::default();
    let mut stress = 0.0;
    let balance = run(&mut simulation, |simulation| {
        let time = simulation.clock().time;
        velocity.push(time, mean_velocity(simulation, right)?);
        if time < passage {
            stress = -mean_stress(simulation, right)?;
        }
        Ok(())
    })?;
    let middle = *velocity.upward_crossings(0.0).first().context("the bar was not turned")?;
    let left = body(&simulation, "left")?;
    let apart = mean_velocity(&simulation, right)? - mean_velocity(&simulation, left)?;
    Ok(vec![
        Check::new("stress", stress, stress_of_speed * relative, Tolerance::Relative(0.03), "Pa", SOURCE),
        Check::new("duration", 2.0 * middle, 2.0 * passage, Tolerance::Relative(0.03), "s", SOURCE)
            .converging(),
        Check::above("restitution", apart / relative, 0.97, "velocities are exchanged"),
        balance.check(Kind::Abrupt),
    ])
}

fn mean_velocity(simulation: &Simulation, body: BodyId) -> Result<f64> {
    let (view, rows) = simulation.world().body_view(body);
    let (mass, velocity) = (view.read::<Mass>()?, view.read::<Velocity>()?);
    let total: f64 = rows.clone().map(|row| mass[row].0).sum();
    Ok(rows.map(|row| mass[row].0 * velocity[row].0.x).sum::<f64>() / total)
}

/// Mean axial stress of the middle of a bar, Pa.
fn mean_stress(simulation: &Simulation, body: BodyId) -> Result<f64> {
    let (view, rows) = simulation.world().body_view(body);
    let (stress, reference) = (view.read::<PiolaStress>()?, view.read::<ReferencePosition>()?);
    let middle = rows.filter(|&row| (0.02..0.08).contains(&reference[row].0.x));
    let stresses: Vec<f64> = middle.map(|row| stress[row].0.x_axis.x).collect();
    Ok(stresses.iter().sum::<f64>() / stresses.len() as f64)
}
