//! What a run tells at its end: times, energies, warnings, sources of the methods, files.

use std::fmt::Write;

use meshless_engine::schedule::{AccountKind, Ledger};

use super::progress::Progress;
use super::session::{Ending, Session};
use super::text::{Table, counted, duration};

/// The summary.
pub fn text(session: &Session, ending: &Ending, progress: &Progress) -> String {
    let sim = &session.sim;
    let clock = sim.clock();
    let mut text = String::new();
    let how = match ending {
        Ending::Complete => "complete".to_owned(),
        Ending::Stopped(reason) => format!("stopped: {reason}"),
        Ending::StepLimit => "stopped after the steps asked for".to_owned(),
        Ending::Interrupted => "interrupted".to_owned(),
        Ending::Failed(_) => "failed".to_owned(),
    };
    // Writing to a String cannot fail.
    let _ = writeln!(text, "{how} at {:.6e} s of {:.6e} s, step {}", clock.time, sim.end(), clock.step);
    let _ = writeln!(
        text,
        "{} steps of {} particles in {}: {} on {} threads",
        progress.steps(sim),
        sim.world().len(),
        duration(progress.elapsed()),
        counted(progress.rate(sim), "particle-steps/s"),
        rayon::current_num_threads()
    );
    let _ = write!(text, "\n{}", energies(sim.ledger()));
    list(&mut text, "warnings", sim.warnings());
    list(&mut text, "methods", sim.references());
    let _ = writeln!(text, "\nstate hash {}", sim.state_hash());
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

fn list(text: &mut String, heading: &str, lines: &[String]) {
    if !lines.is_empty() {
        let _ = writeln!(text, "\n{heading}");
        lines.iter().for_each(|line| _ = writeln!(text, "  {line}"));
    }
}
