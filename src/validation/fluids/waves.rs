//! F4: a standing wave damped by viscosity, and the period of sloshing.

use anyhow::{Context, Result};
use meshless_engine::plugin::Registry;
use meshless_engine::world::{Mass, Velocity};

use crate::case::Case;
use crate::check::{Check, Tolerance};
use crate::measure::{Kind, Record, body, run};
use crate::template::Template;

pub(crate) const CASE: Case = Case {
    id: "F4",
    title: "standing wave, sloshing",
    resolutions: &[20, 40, 80],
    ci_resolution: 20,
    run: waves,
};

const WAVE: &str = include_str!("../../../tests/validation/standing_wave/reference.csv");
const RE: f64 = 250.0;

fn waves(registry: &Registry, across: usize) -> Result<Vec<Check>> {
    let mut checks = standing_wave(registry, across)?;
    checks.extend(sloshing(registry, across)?);
    Ok(checks)
}

fn standing_wave(registry: &Registry, across: usize) -> Result<Vec<Check>> {
    let spacing = 1.0 / across as f64;
    let path = "tests/validation/standing_wave/scene.ron";
    let text = include_str!("../../../tests/validation/standing_wave/scene.ron");
    let mut simulation = Template::new(path, text)
        .set("bodies.water.spacing", spacing)?
        .set("bodies.floor.spacing", spacing)?
        .set("bodies.floor.shape.min", format!("(0.0, {})", -4.0 * spacing))?
        .build(registry)?;
    let mut kinetic = Record::default();
    let balance = run(&mut simulation, |simulation| {
        kinetic.push(simulation.clock().time, simulation.ledger().total_named("kinetic"));
        Ok(())
    })?;
    let of_reference = |name| -> Result<f64> {
        let rows = Record::read(WAVE, "Re", name)?.0;
        let row = rows.iter().find(|row| (row.0 - RE).abs() < 1e-9);
        row.map(|row| row.1).context("the reference lacks this Reynolds number")
    };
    let period = of_reference("period_s")?;
    // Over a whole period the exchange with potential energy averages out.
    let mean = |from: f64| kinetic.mean(&(from * period..=(from + 1.0) * period));
    let rate = (mean(0.5)? / mean(1.5)?).ln() / period;
    Ok(vec![
        Check::new(
            "decay rate of the energy of the wave",
            rate,
            of_reference("energy_decay_rate_1_s")?,
            Tolerance::Relative(0.15),
            "1/s",
            "Lamb, viscous waves of small height",
        )
        .converging(),
        balance.check_of("wave", Kind::Smooth),
    ])
}

fn sloshing(registry: &Registry, across: usize) -> Result<Vec<Check>> {
    // Half as fine as the wave over its depth.
    let spacing = 0.8 / across as f64;
    let side = 4.0 * spacing;
    let path = "tests/validation/sloshing/scene.ron";
    let text = include_str!("../../../tests/validation/sloshing/scene.ron");
    let mut simulation = Template::new(path, text)
        .set("bodies.water.spacing", spacing)?
        .set("bodies.tank.spacing", spacing)?
        .set("bodies.tank.shape[0].min", format!("({}, {})", -side, -side))?
        .set("bodies.tank.shape[0].max", format!("({}, 0.8)", 1.0 + side))?
        .build(registry)?;
    let water = body(&simulation, "water")?;
    let mut momentum = Record::default();
    run(&mut simulation, |simulation| {
        let (view, rows) = simulation.world().body_view(water);
        let (mass, velocity) = (view.read::<Mass>()?, view.read::<Velocity>()?);
        momentum.push(simulation.clock().time, rows.map(|row| mass[row].0 * velocity[row].0.x).sum());
        Ok(())
    })?;
    let rises = momentum.upward_crossings(0.0);
    let (first, last) = (rises.first().context("no period")?, rises.last().context("no period")?);
    let k = std::f64::consts::PI;
    let exact = std::f64::consts::TAU / (9.81 * k * (0.4 * k).tanh()).sqrt();
    Ok(vec![Check::new(
        "period of sloshing",
        (last - first) / (rises.len() - 1) as f64,
        exact,
        Tolerance::Relative(0.015),
        "s",
        "2 pi / sqrt(g k tanh(k h)), potential flow",
    )])
}
