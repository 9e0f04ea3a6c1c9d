//! The summary of a run: times, energies, warnings, sources of the methods.

use std::fmt::Write;

use meshless_engine::notation::{count, number, quantity, quantity_to};
use meshless_engine::record::StateHash;
use meshless_engine::scene::Precision;
use meshless_engine::schedule::{AccountKind, Ledger};
use meshless_engine::simulation::{Outcome, Summary};

use super::text::{TextTable, counted, duration};

/// The summary; `steps` are those since the run was started or resumed.
pub fn text(summary: &Summary, ledger: &Ledger, steps: u64, state: &StateHash) -> String {
    let mut text = String::new();
    let (time, end) = (quantity(summary.time, "s"), quantity(summary.end_time, "s"));
    // Writing to a String cannot fail.
    let _ = match &summary.outcome {
        Outcome::Finished => write!(text, "finished: t = {time}"),
        Outcome::Stopped(why) => write!(text, "stopped: {why}; t = {time} of {end}"),
        Outcome::Interrupted => write!(text, "stopped early: t = {time} of {end}"),
        Outcome::Failed(_) => write!(text, "failed: t = {time} of {end}"),
    };
    let _ = writeln!(text, ", {}", count(summary.steps, "step"));
    if !summary.parameters.is_empty() {
        let values = summary.parameters.iter().map(|(name, value)| format!("{name} = {}", number(*value)));
        let _ = writeln!(text, "parameters: {}", values.collect::<Vec<_>>().join(", "));
    }
    let _ = writeln!(
        text,
        "{} of {} in {}: {} on {}",
        count(steps, "step"),
        count(summary.particles as u64, "particle"),
        duration(summary.wall_seconds),
        counted(summary.particle_steps_per_second, "particle-steps/s"),
        count(summary.threads as u64, "thread")
    );
    if summary.precision == Some(Precision::Mixed) {
        let _ = writeln!(text, "sums over neighbours of fluids in single precision");
    }
    if let Some(short) = summary.short_steps {
        let per_step = short as f64 / summary.steps.max(1) as f64;
        let _ = writeln!(
            text,
            "solids and rigid bodies: {}, {per_step:.1} in each step of the fluid",
            count(short, "sub-step")
        );
    }
    for (body, removed) in &summary.removed_of {
        let of = summary.particles_of.get(body).copied().unwrap_or_default();
        let _ = writeln!(text, "{removed} of {of} particles of `{body}` were removed");
    }
    let _ = write!(text, "\n{}", energies(ledger));
    extremes(&mut text, summary);
    list(&mut text, "warnings", &summary.warnings);
    list(&mut text, "methods", &summary.references);
    let _ = writeln!(text, "\nstate hash {state}");
    text
}

fn energies(ledger: &Ledger) -> String {
    let joule = |energy: f64| quantity_to(energy, "J", 4);
    let mut table = TextTable::new(&["energy", "", ""], 1);
    for account in ledger.accounts() {
        let kind = match account.kind {
            AccountKind::Stored => "stored",
            AccountKind::Supplied => "supplied",
            AccountKind::Dissipated => "dissipated",
        };
        table.row([account.name.clone(), kind.into(), joule(account.total())]);
    }
    table.row(["balance error".into(), String::new(), joule(ledger.balance_error())]);
    table.row([
        "relative to the peak energy".into(),
        String::new(),
        format!("{:.1e}", ledger.relative_error()),
    ]);
    table.render() + &negative(ledger)
}

/// Minimum of a negative account that the summary explains, over the largest one.
const NOTABLE: f64 = 1e-3;

/// Explains negative accounts of dissipation.
fn negative(ledger: &Ledger) -> String {
    let accounts = ledger.accounts().iter();
    let peak = accounts.clone().map(|account| account.total().abs()).fold(0.0, f64::max);
    let below = accounts
        .filter(|account| account.kind == AccountKind::Dissipated && account.total() < -NOTABLE * peak);
    let names: Vec<String> = below.map(|account| format!("`{}`", account.name)).collect();
    match names.is_empty() {
        true => String::new(),
        false => format!("  negative dissipation is energy supplied on balance: {}\n", names.join(", ")),
    }
}

fn extremes(text: &mut String, summary: &Summary) {
    if summary.probes.values().all(Vec::is_empty) {
        return;
    }
    let mut table = TextTable::new(&["probe", "", "", "minimum", "at", "maximum", "at", "last"], 5);
    for (probe, columns) in &summary.probes {
        for column in columns {
            table.row([
                probe.clone(),
                column.name.clone(),
                column.unit.clone(),
                number(column.min),
                quantity(column.min_time, "s"),
                number(column.max),
                quantity(column.max_time, "s"),
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
