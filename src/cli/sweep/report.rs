//! Results of the runs of a sweep, side by side.

use std::path::{Path, PathBuf};

use meshless_engine::notation::{number, quantity};
use meshless_engine::record::{Existing, write_atomically};
use meshless_engine::simulation::{Outcome, Summary};

use super::cases::{SweepCase, short};
use crate::cli::failure::CommandFailure;
use crate::cli::text::TextTable;

/// A run: its settings and its summary.
pub struct SweepRow {
    settings: Vec<(String, String)>,
    summary: Summary,
}

impl SweepRow {
    /// The row of a case.
    pub fn new(case: &SweepCase, summary: Summary) -> Self {
        Self { settings: case.settings.clone(), summary }
    }

    /// Whether the run failed.
    pub fn is_failed(&self) -> bool {
        matches!(self.summary.outcome, Outcome::Failed(_))
    }

    fn outcome(&self) -> &'static str {
        match self.summary.outcome {
            Outcome::Finished => "finished",
            Outcome::Stopped(_) => "stopped",
            Outcome::Interrupted => "interrupted",
            Outcome::Failed(_) => "failed",
        }
    }
}

/// The runs with their cost, then every column of every probe for all runs.
pub fn text(rows: &[SweepRow]) -> String {
    let Some(first) = rows.first() else { return String::new() };
    let names: Vec<&str> = first.settings.iter().map(|(path, _)| short(path)).collect();
    let mut headings = names.clone();
    headings.extend(["outcome", "time", "steps", "particles", "balance error"]);
    let mut runs = TextTable::new(&headings, 4);
    for row in rows {
        let Summary { time, steps, particles, relative_error, .. } = row.summary;
        let mut cells: Vec<String> = row.settings.iter().map(|(_, value)| value.clone()).collect();
        cells.extend([
            row.outcome().to_owned(),
            quantity(time, "s"),
            steps.to_string(),
            particles.to_string(),
        ]);
        cells.push(format!("{relative_error:.1e}"));
        runs.row(cells);
    }
    let series = columns(rows);
    if series.is_empty() {
        return runs.render();
    }
    let mut headings = vec!["probe", "unit"];
    headings.extend(names);
    headings.extend(["minimum", "maximum", "last"]);
    let mut probes = TextTable::new(&headings, 3);
    for (probe, column) in series {
        for row in rows {
            let found =
                row.summary.probes.get(&probe).and_then(|columns| columns.iter().find(|c| c.name == column));
            let Some(extreme) = found else { continue };
            let mut cells = vec![format!("{probe}.{column}"), extreme.unit.clone()];
            cells.extend(row.settings.iter().map(|(_, value)| value.clone()));
            cells.extend([extreme.min, extreme.max, extreme.last].map(number));
            probes.row(cells);
        }
    }
    format!("{}\n{}", runs.render(), probes.render())
}

/// Probe and column of all series, in the order of their first occurrence.
fn columns(rows: &[SweepRow]) -> Vec<(String, String)> {
    let mut columns = Vec::new();
    for row in rows {
        for (probe, extremes) in &row.summary.probes {
            for extreme in extremes {
                let column = (probe.clone(), extreme.name.clone());
                if !columns.contains(&column) {
                    columns.push(column);
                }
            }
        }
    }
    columns
}

/// Writes `sweep.csv`: a row for every run.
///
/// # Errors
/// The file exists and may not be replaced, or cannot be written.
pub fn write(folder: &Path, existing: Existing, rows: &[SweepRow]) -> Result<PathBuf, CommandFailure> {
    let file = folder.join("sweep.csv");
    let columns = columns(rows);
    let mut lines = Vec::new();
    for row in rows {
        if lines.is_empty() {
            let mut head: Vec<String> = row.settings.iter().map(|(path, _)| quoted(short(path))).collect();
            head.extend(
                ["outcome", "time[s]", "steps", "particles", "relative_balance_error"].map(str::to_owned),
            );
            for (probe, column) in &columns {
                head.extend(["min", "max", "last"].map(|which| format!("{probe}.{column}.{which}")));
            }
            lines.push(head.join(","));
        }
        let Summary { time, steps, particles, relative_error, .. } = row.summary;
        let mut cells: Vec<String> = row.settings.iter().map(|(_, value)| quoted(value)).collect();
        cells.extend([
            row.outcome().to_owned(),
            format!("{time:?}"),
            steps.to_string(),
            particles.to_string(),
        ]);
        cells.push(format!("{relative_error:?}"));
        for (probe, column) in &columns {
            let extremes =
                row.summary.probes.get(probe).and_then(|all| all.iter().find(|e| e.name == *column));
            let values = extremes.map_or([f64::NAN; 3], |e| [e.min, e.max, e.last]);
            cells.extend(
                values.map(|value| if value.is_nan() { String::new() } else { format!("{value:?}") }),
            );
        }
        lines.push(cells.join(","));
    }
    let text = lines.join("\n") + "\n";
    std::fs::create_dir_all(folder).map_err(|error| {
        CommandFailure::Run(format!("cannot make the folder `{}`: {error}", folder.display()))
    })?;
    write_atomically(&file, existing, |to| to.write_all(text.as_bytes()))
        .map_err(|error| CommandFailure::Run(error.to_string()))?;
    Ok(file)
}

/// A cell of a CSV file.
fn quoted(value: &str) -> String {
    if value.contains([',', '"', '\n']) {
        format!("\"{}\"", value.replace('"', "\"\""))
    } else {
        value.to_owned()
    }
}
