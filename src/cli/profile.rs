//! The table of `--profile`: the time of each system.

use meshless_engine::simulation::Summary;

use super::text::TextTable;

/// Time of every system, its share of the wall time, and its cost per particle and step.
pub fn text(summary: &Summary, steps: u64) -> String {
    let wall = summary.wall_seconds;
    let work = (steps as f64 * summary.particles as f64).max(1.0);
    let mut table = TextTable::new(&["stage", "system", "s", "share", "ns/particle-step"], 3);
    let mut row = |stage: &str, system: &str, seconds: f64| {
        table.row([
            stage.to_owned(),
            system.to_owned(),
            format!("{seconds:.3}"),
            format!("{:.1} %", 100.0 * seconds / wall),
            format!("{:.1}", 1e9 * seconds / work),
        ]);
    };
    for timing in &summary.timings {
        row(&timing.stage, &timing.system, timing.seconds);
    }
    let known: f64 = summary.timings.iter().map(|timing| timing.seconds).sum();
    row("", "between the systems", (wall - known).max(0.0));
    row("", "all", wall);
    table.render()
}
