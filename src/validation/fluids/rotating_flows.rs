//! F12: torques between cylinders of which one rotates, and the spin-down of a disc in oil.

use anyhow::{Context, Result};
use meshless_engine::formulations::fluid::FlowCloud;
use meshless_engine::plugin::Registry;
use meshless_engine::simulation::Simulation;
use meshless_engine::world::{BodyId, Mass, Position, Velocity};

use crate::case::Case;
use crate::check::{Check, Tolerance};
use crate::measure::{Kind, Record, body, run};
use crate::template::Template;

pub(crate) const CASE: Case = Case {
    id: "F12",
    title: "torque between cylinders, disc in oil",
    resolutions: &[10, 20, 40],
    ci_resolution: 10,
    run: rotating_flows,
};

const DISC: &str = include_str!("../../../tests/validation/spinning_disc/reference.csv");
/// Torque per length of both cylinders, N m: 4 pi mu omega / (1/a^2 - 1/b^2).
const TORQUE: f64 = 4.0 * std::f64::consts::PI * 25.0 / (1.0 / (0.5 * 0.5) - 1.0);

fn rotating_flows(registry: &Registry, across: usize) -> Result<Vec<Check>> {
    let mut checks = cylinders(registry, across)?;
    checks.extend(disc(registry, across)?);
    Ok(checks)
}

/// Torque of the fluids on a body about the origin, N m.
fn torque(simulation: &Simulation, body: BodyId) -> Result<f64> {
    let forces = simulation.resources().get::<FlowCloud>().forces_on(body).context("no fluid")?;
    let (view, rows) = simulation.world().body_view(body);
    let position = view.read::<Position>()?;
    Ok(forces.iter().zip(&position[rows]).map(|((force, _), x)| x.0.cross(*force).z).sum())
}

fn cylinders(registry: &Registry, across: usize) -> Result<Vec<Check>> {
    let spacing = 0.5 / across as f64;
    let path = "tests/validation/taylor_couette/scene.ron";
    let text = include_str!("../../../tests/validation/taylor_couette/scene.ron");
    let mut simulation = Template::new(path, text)
        .set("bodies.oil.spacing", spacing)?
        .set("bodies.inner.spacing", spacing)?
        .set("bodies.inner.shape.inner", 0.5 - 4.0 * spacing)?
        .set("bodies.outer.spacing", spacing)?
        .set("bodies.outer.shape.outer", 1.0 + 4.0 * spacing)?
        .build(registry)?;
    let (inner, outer) = (body(&simulation, "inner")?, body(&simulation, "outer")?);
    let (mut sums, mut samples) = ([0.0; 2], 0.0);
    run(&mut simulation, |simulation| {
        if simulation.clock().time >= 2.0 + 0.05 * samples {
            sums[0] -= torque(simulation, inner)?;
            sums[1] += torque(simulation, outer)?;
            samples += 1.0;
        }
        Ok(())
    })?;
    let viscosity = simulation.ledger().total_named("viscosity");
    // The work of the torque over four seconds.
    let work = TORQUE * 4.0;
    let source = "exact solution of Couette";
    let of = |name: &str, sum: f64| {
        let mean = sum / samples;
        Check::new(
            format!("torque on the {name} cylinder"),
            mean,
            TORQUE,
            Tolerance::Relative(0.03),
            "N m",
            source,
        )
        .converging()
    };
    Ok(vec![
        of("inner", sums[0]),
        of("outer", sums[1]),
        Check::new("heat of friction", viscosity, work, Tolerance::Relative(0.03), "J", "torque times angle")
            .converging(),
    ])
}

fn disc(registry: &Registry, across: usize) -> Result<Vec<Check>> {
    // Half as fine as the gap of the cylinders.
    let spacing = 0.3 / across as f64;
    let path = "tests/validation/spinning_disc/scene.ron";
    let text = include_str!("../../../tests/validation/spinning_disc/scene.ron");
    let mut simulation = Template::new(path, text)
        .set("bodies.oil.spacing", spacing)?
        .set("bodies.disc.spacing", spacing)?
        .set("bodies.outer.spacing", spacing)?
        .set("bodies.outer.shape.outer", 0.5 + 4.0 * spacing)?
        .build(registry)?;
    let disc = body(&simulation, "disc")?;
    let mut spin = Record::default();
    let balance = run(&mut simulation, |simulation| {
        let (view, rows) = simulation.world().body_view(disc);
        let (mass, x, v) = (view.read::<Mass>()?, view.read::<Position>()?, view.read::<Velocity>()?);
        let (mut momentum, mut inertia) = (0.0, 0.0);
        for row in rows {
            momentum += mass[row].0 * x[row].0.cross(v[row].0).z;
            inertia += mass[row].0 * x[row].0.length_squared();
        }
        spin.push(simulation.clock().time, momentum / inertia);
        Ok(())
    })?;
    let reference = Record::read(DISC, "t_s", "omega_rad_s")?;
    let mut checks = Vec::new();
    for time in [1.0, 2.0] {
        let exact = reference.0.iter().find(|row| (row.0 - time).abs() < 1e-9).context("no such time")?.1;
        let found = spin.0.iter().find(|row| row.0 >= time - 1e-9).context("no such time")?.1;
        let name = format!("rate of the disc after {time} s");
        checks.push(
            Check::new(
                name,
                found,
                exact,
                Tolerance::Relative(0.05),
                "rad/s",
                "finite volumes in r, reference.csv",
            )
            .converging(),
        );
    }
    checks.push(balance.check_of("disc", Kind::Smooth));
    Ok(checks)
}
