//! What a run tells at its end: times, energies, warnings, sources of the methods.

use std::fmt::Write;

use meshless_engine::record::StateHash;
use meshless_engine::schedule::{AccountKind, Ledger};
use meshless_engine::simulation::{Outcome, Summary};

use super::text::{Table, counted, duration};

/// The summary; `steps` are those done since the run was started or taken up.
pub fn text(summary: &Summary, ledger: &Ledger, steps: u64, state: &StateHash) -> String {
    let mut text = String::new();
    let how = match &summary.outcome {
        Outcome::Finished => "complete".to_owned(),
        Outcome::Stopped(why) => format!("stopped ({why})"),
        Outcome::Interrupted => "stopped before its end".to_owned(),
        Outcome::Failed(_) => "failed".to_owned(),
    };
    // Writing to a String cannot fail.
    let _ = writeln!(
        text,
        "{how} at {:.6e} s of {:.6e} s, step {}",
        summary.time, summary.end_time, summary.steps
    );
    let _ = writeln!(
        text,
        "{steps} steps of {} particles in {}: {} on {} threads",
        summary.particles,
        duration(summary.wall_seconds),
        counted(summary.particle_steps_per_second, "particle-steps/s"),
        summary.threads
    );
    if let Some(short) = summary.short_steps {
        let per_step = short as f64 / summary.steps.max(1) as f64;
        let _ = writeln!(
            text,
            "solids and rigid bodies: {short} short steps, {per_step:.1} in a step of the fluid"
        );
    }
    for (body, count) in &summary.removed_of {
        let of = summary.particles_of.get(body).copied().unwrap_or_default();
        let _ = writeln!(text, "{count} of {of} particles of `{body}` have been removed");
    }
    let _ = write!(text, "\n{}", energies(ledger));
    extremes(&mut text, summary);
    list(&mut text, "warnings", &summary.warnings);
    list(&mut text, "methods", &summary.references);
    let _ = writeln!(text, "\nstate hash {state}");
    text
}

fn energies(ledger: &Ledger) -> String {
    let mut table = Table::new(&["energy", "", "J"], 1);
    for account in ledger.accounts() {
        let kind = match account.kind {
            AccountKind::Stored => "stored",
            AccountKind::Supplied => "supplied",
            AccountKind::Dissipated => "dissipated",
        };
        table.row([account.name.clone(), kind.into(), format!("{:.6e}", account.total())]);
    }
    table.row(["balance error".into(), String::new(), format!("{:.2e}", ledger.balance_error())]);
    table.row(["over the largest energy".into(), String::new(), format!("{:.1e}", ledger.relative_error())]);
    table.render()
}

fn extremes(text: &mut String, summary: &Summary) {
    if summary.probes.values().all(Vec::is_empty) {
        return;
    }
    let mut table = Table::new(&["probe", "", "", "least", "at s", "most", "at s", "last"], 5);
    for (probe, columns) in &summary.probes {
        for column in columns {
            let number = |value: f64| format!("{value:.5e}");
            table.row([
                probe.clone(),
                column.name.clone(),
                column.unit.clone(),
                number(column.min),
                format!("{:.4e}", column.min_time),
                number(column.max),
                format!("{:.4e}", column.max_time),
                number(column.last),
            ]);
        }
    }
    let _ = write!(text, "\n{}", table.render());
}

fn list(text: &mut String, heading: &str, lines: &[String]) {
    if !lines.is_empty() {
        let _ = writeln!(text, "\n{heading}");
        lines.iter().for_each(|line| _ = writeln!(text, "  {line}"));
    }
}
