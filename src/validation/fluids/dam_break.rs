//! F5b: a dam break, its front, and the readings of sensors in the far wall.

use anyhow::{Context, Result};
use meshless_engine::formulations::fluid::FlowCloud;
use meshless_engine::glam::DVec3;
use meshless_engine::plugin::Registry;
use meshless_engine::record::probe::pressure_on_face;
use meshless_engine::world::Position;

use crate::case::Case;
use crate::check::{Check, Tolerance};
use crate::measure::{Kind, Record, body, run};
use crate::template::Template;

pub(crate) const CASE: Case =
    Case { id: "F5b", title: "dam break", resolutions: &[20, 40, 80], ci_resolution: 20, run: dam_break };

const FRONT: &str = include_str!("../../../tests/validation/dam_break/front.csv");
const REFERENCE: &str = include_str!("../../../tests/validation/dam_break/reference.csv");
const HEIGHTS: [f64; 4] = [0.01, 0.05, 0.1, 0.267];
/// Time at which the front is at the wall, over sqrt(H / g).
const ARRIVAL: f64 = 2.36;
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
    let water = body(&simulation, "water")?;
    let mut front = Record::default();
    let balance = run(&mut simulation, |simulation| {
        let (view, rows) = simulation.world().body_view(water);
        let position = view.read::<Position>()?;
        let toe = rows.map(|row| position[row].0.x).fold(0.0, f64::max) + 0.5 * spacing;
        front.push(simulation.clock().time * per_time, toe);
        let cloud = simulation.resources().get::<FlowCloud>();
        for (record, height) in pressure.iter_mut().zip(HEIGHTS) {
            let at = DVec3::new(5.366, height, 0.0);
            let p = pressure_on_face(&cloud, at, DVec3::NEG_X, gravity);
            record.push(simulation.clock().time * per_time, p / WEIGHT);
        }
        Ok(())
    })?;
    let [of_front, of_pressure] = match across {
        ..40 => [0.08, 0.12],
        40..80 => [0.035, 0.06],
        _ => [0.02, 0.04],
    };
    let exact = Record::read(FRONT, "t_sqrt(g/H)", "x_toe/H")?;
    let reached = |record: &Record, level| record.upward_crossings(level).first().copied();
    let mut checks = Vec::new();
    for place in [3.0, 4.0, 5.0] {
        let measured = reached(&front, place).context("the front does not come so far")?;
        let reference = reached(&exact, place).context("the reference does not come so far")?;
        let name = format!("t sqrt(g/H) at which the front is at {place} H");
        checks.push(
            Check::new(
                name,
                measured,
                reference,
                Tolerance::Relative(of_front),
                "1",
                "boundary elements, no friction",
            )
            .converging(),
        );
    }
    let arrival = reached(&pressure[0], 0.5).context("the water does not reach the wall")?;
    let name = "arrival at P1 (above 0.5 rho g H), t sqrt(g/H)";
    checks.push(Check::new(
        name,
        arrival,
        ARRIVAL,
        Tolerance::Relative(of_front),
        "1",
        "boundary elements, no friction",
    ));
    let column = |name| Record::read(REFERENCE, "sensor", name);
    for (k, (record, reference)) in pressure.iter().zip(column("plateau")?.0).enumerate() {
        checks.push(Check::new(
            format!("pressure at P{} from 3 to 5, over rho g H", k + 1),
            record.mean(&(3.0..=5.0))?,
            reference.1,
            Tolerance::Relative(of_pressure),
            "1",
            "delta-SPH, De Courcy et al. 2024",
        ));
    }
    checks.push(balance.check(Kind::Smooth));
    Ok(checks)
}
