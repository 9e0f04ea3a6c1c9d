//! S19: a quarter of a rubber block, compressed by a tool by 60 % of its height.

use anyhow::Result;
use meshless_engine::plugin::Registry;
use meshless_engine::simulation::Simulation;
use meshless_engine::world::{DeformationGradient, ReferenceVolume};

use crate::case::Case;
use crate::check::Check;
use crate::measure::{Balance, Disorder, Kind, body, run};
use crate::template::Template;

pub(crate) const CASE: Case = Case {
    id: "S19",
    title: "quarter punch to 60 %, reference updated every three steps",
    resolutions: &[10, 20],
    ci_resolution: 10,
    run: quarter_punch,
};

/// The coefficient of the paper for this punch, and twice the default of the control: the material under the
/// edge of the tool is compressed to a quarter of its volume.
const STABILIZERS: [(&str, &str); 2] =
    [("Hessian", "hessian_stabilization(eta: 1.4)"), ("hourglass", "hourglass_control(alpha: 10.0)")];

/// The block at the end.
struct PressedBlock {
    /// Whether the run has reached its end.
    completed: bool,
    /// Root mean square of |F X - x| / |X| of initial neighbours.
    disorder: f64,
    /// Energy balance.
    balance: Balance,
    /// Volume over its initial value.
    volume: f64,
}

fn press(registry: &Registry, across: usize, formulation: &str, plugin: &str) -> Result<PressedBlock> {
    let mut simulation = Template::new(
        "tests/validation/quarter_punch/scene.ron",
        include_str!("../../../tests/validation/quarter_punch/scene.ron"),
    )
    .set("bodies.block.spacing", 0.01 / across as f64)?
    .set("bodies.block.formulation", formulation)?
    .set("bodies.block.plugins", format!("[{plugin}]"))?
    .build(registry)?;
    let disorder = Disorder::new(&simulation, body(&simulation, "block")?)?;
    let balance = run(&mut simulation, |_| Ok(()));
    Ok(PressedBlock {
        completed: balance.is_ok(),
        disorder: disorder.measure(&simulation)?,
        balance: balance.unwrap_or(Balance::UNKNOWN),
        volume: volume(&simulation)?,
    })
}

fn volume(simulation: &Simulation) -> Result<f64> {
    let (view, rows) = simulation.world().body_view(body(simulation, "block")?);
    let (gradient, volume) = (view.read::<DeformationGradient>()?, view.read::<ReferenceVolume>()?);
    let start: f64 = rows.clone().map(|row| volume[row].0).sum();
    Ok(rows.map(|row| volume[row].0 * gradient[row].0.determinant()).sum::<f64>() / start)
}

fn quarter_punch(registry: &Registry, across: usize) -> Result<Vec<Check>> {
    let updated = "UpdatedLagrangian(update: Every(3))";
    let mut checks = Vec::new();
    let mut spoiled = 0.0;
    for (name, formulation) in [("TL", "TotalLagrangian"), ("UL", updated)] {
        spoiled = press(registry, across, formulation, "")?.disorder;
        let name = format!("{name} without stabilization: hourglass residual");
        checks.push(Check::above(name, spoiled, 0.3, "spoiled"));
    }
    for (stabilizer, plugin) in STABILIZERS {
        let PressedBlock { completed, disorder, balance, volume } = press(registry, across, updated, plugin)?;
        let name = |what: &str| format!("{stabilizer}: {what}");
        checks.push(Check::above(name("completed"), f64::from(completed), 0.5, "paper, 4.3"));
        let share = disorder / spoiled;
        checks.push(Check::below(
            name("hourglass residual over that without stabilization"),
            share,
            0.3,
            "paper, 4.3",
        ));
        checks.push(Check::below(name("hourglass residual"), disorder, 0.2, "in order"));
        checks.push(balance.check_of(stabilizer, Kind::Abrupt));
        checks.push(Check::above(name("volume"), volume, 0.9, "nearly incompressible"));
    }
    Ok(checks)
}
