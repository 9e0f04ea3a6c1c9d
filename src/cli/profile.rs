//! The table of `--profile`: the time of each system.

use meshless_engine::simulation::Simulation;

use super::progress::Progress;
use super::text::Table;

/// Time of every system, its share of the wall time, and what it costs for a particle and a step.
pub fn text(sim: &Simulation, progress: &Progress) -> String {
    let wall = progress.elapsed();
    let work = (progress.steps(sim) as f64 * sim.world().len() as f64).max(1.0);
    let mut table = Table::new(&["stage", "system", "s", "share", "ns/particle-step"], 3);
    let mut row = |stage: &str, system: &str, seconds: f64| {
        table.row([
            stage.to_owned(),
            system.to_owned(),
            format!("{seconds:.3}"),
            format!("{:.1} %", 100.0 * seconds / wall),
            format!("{:.1}", 1e9 * seconds / work),
        ]);
    };
    let mut known = 0.0;
    for (system, stage, time) in sim.schedule().timers() {
        known += time.as_secs_f64();
        row(&format!("{stage:?}"), system, time.as_secs_f64());
    }
    row("", "between the systems", (wall - known).max(0.0));
    row("", "all", wall);
    table.render()
}
