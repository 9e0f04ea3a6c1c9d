//! F5: a dam break, and what sensors in the far wall show.

use anyhow::{Context, Result};
use meshless_engine::formulations::fluid::FlowCloud;
use meshless_engine::glam::DVec3;
use meshless_engine::plugin::Registry;
use meshless_engine::record::probe::pressure_on_face;

use super::case::Case;
use super::check::{Check, Tolerance};
use super::measure::{Record, run};
use super::template::Template;

pub(super) const CASE: Case =
    Case { id: "F5", title: "dam break", resolutions: &[20, 40, 80], ci_resolution: 20, run: dam_break };

const REFERENCE: &str = include_str!("../../../tests/validation/dam_break/reference.csv");
const HEIGHTS: [f64; 4] = [0.01, 0.05, 0.1, 0.267];
/// Weight of the column of water per area, Pa: rho g H with H = 1 m.
const WEIGHT: f64 = 9810.0;

fn dam_break(registry: &Registry, across: usize) -> Result<Vec<Check>> {
    let spacing = 1.0 / across as f64;
    let side = 4.0 * spacing;
    let path = "tests/validation/dam_break/scene.ron";
    let text = include_str!("../../../tests/validation/dam_break/scene.ron");
    let mut simulation = Template::new(path, text)
        .set("bodies.water.spacing", spacing)?
        .set("bodies.tank.spacing", spacing)?
        .set("bodies.tank.shape[0].min", format!("({}, {})", -side, -side))?
        .set("bodies.tank.shape[0].max", format!("({}, 3.0)", 5.366 + side))?
        .build(registry)?;
    let per_time = 9.81f64.sqrt();
    let mut pressure = [const { Record(Vec::new()) }; 4];
    let gravity = DVec3::new(0.0, -9.81, 0.0);
    run(&mut simulation, |simulation| {
        let cloud = simulation.resources().get::<FlowCloud>();
        for (record, height) in pressure.iter_mut().zip(HEIGHTS) {
            let at = DVec3::new(5.366, height, 0.0);
            let p = pressure_on_face(&cloud, at, DVec3::NEG_X, gravity);
            record.push(simulation.clock().time * per_time, p / WEIGHT);
        }
        Ok(())
    })?;
    let column = |name| Record::read(REFERENCE, "sensor", name);
    let arrival = column("arrival_t_sqrt_g_over_H")?.0[0].1;
    let found = *pressure[0].upward_crossings(0.1).first().context("the water does not reach the wall")?;
    let mut checks = vec![Check::new(
        "arrival at P1, t sqrt(g/H)",
        found,
        arrival,
        Tolerance::Relative(0.03),
        "1",
        "experiment, Lobovsky et al. 2014",
    )];
    for (k, (record, reference)) in pressure.iter().zip(column("plateau")?.0).enumerate() {
        checks.push(Check::new(
            format!("pressure at P{} from 3 to 5, over rho g H", k + 1),
            mean(record, 3.0, 5.0),
            reference.1,
            Tolerance::Relative(0.2),
            "1",
            "delta-SPH, De Courcy et al. 2024",
        ));
    }
    let balance = simulation.ledger().relative_error().abs();
    checks.push(Check::below("energy balance error", balance, 2e-3, "energy is conserved"));
    Ok(checks)
}

/// Mean over time, by the trapezoidal rule.
fn mean(record: &Record, from: f64, to: f64) -> f64 {
    let (mut sum, mut time) = (0.0, 0.0);
    for pair in record.0.windows(2).filter(|pair| pair[0].0 >= from && pair[1].0 <= to) {
        let dt = pair[1].0 - pair[0].0;
        sum += 0.5 * dt * (pair[0].1 + pair[1].1);
        time += dt;
    }
    sum / time
}
