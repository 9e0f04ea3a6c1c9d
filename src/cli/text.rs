//! Text for people: numbers with prefixes, durations, aligned tables, and streams that may be closed.

use std::io::{ErrorKind, IsTerminal, Write};
use std::sync::Mutex;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::Duration;

/// First error of writing to the standard output.
static UNSAID: Mutex<Option<std::io::Error>> = Mutex::new(None);

/// Whether this process prints: of several ranks only one does.
static SPEAKS: AtomicBool = AtomicBool::new(true);

/// Sets whether this process prints.
pub fn speak(speaks: bool) {
    SPEAKS.store(speaks, Ordering::Relaxed);
}

/// Whether this process prints.
pub fn speaks() -> bool {
    SPEAKS.load(Ordering::Relaxed)
}

/// Prints lines for the user.
pub fn say(text: &str) {
    if !speaks() {
        return;
    }
    let mut out = std::io::stdout();
    if let Err(error) = writeln!(out, "{}", text.trim_end()).and_then(|()| out.flush())
        && let Ok(mut unsaid) = UNSAID.lock()
    {
        unsaid.get_or_insert(error);
    }
}

/// The error of the standard output, if there was one. A closed pipe, as after `| head`, is no error.
pub fn unsaid() -> Option<std::io::Error> {
    let error = UNSAID.lock().ok()?.take();
    error.filter(|error| error.kind() != ErrorKind::BrokenPipe)
}

/// Whether errors and progress may have colours: on a terminal, unless the user wants none
/// (<https://no-color.org>).
pub fn in_colour() -> bool {
    let unwanted = std::env::var_os("NO_COLOR").is_some_and(|value| !value.is_empty());
    std::io::stderr().is_terminal() && !unwanted
}

/// Prints an error or a warning.
pub fn complain(text: &str) {
    if !speaks() {
        return;
    }
    let _ = writeln!(std::io::stderr(), "{}", text.trim_end());
}

/// The command of this program, for hints that can be pasted: its path, or its name if the shell finds it by
/// that.
pub fn program() -> String {
    let called = std::env::args().next().filter(|called| called.contains(std::path::MAIN_SEPARATOR));
    called.map_or_else(|| "meshless".to_owned(), |path| quoted(&path))
}

/// An argument as a shell reads it.
pub fn quoted(argument: &str) -> String {
    let plain = |c: char| c.is_alphanumeric() || "/._-+=,:@%".contains(c);
    match argument.chars().all(plain) && !argument.is_empty() {
        true => argument.to_owned(),
        false => format!("'{}'", argument.replace('\'', r"'\''")),
    }
}

/// A number, with a decimal prefix where it is large, and its unit or noun: `1.23 M particles`.
pub fn counted(value: f64, what: &str) -> String {
    let prefixes = [(1e9, "G"), (1e6, "M"), (1e3, "k")];
    match prefixes.iter().find(|(scale, _)| value.abs() >= *scale) {
        Some((scale, prefix)) => format!("{:.2} {prefix} {what}", value / scale),
        None => format!("{value:.0} {what}"),
    }
}

/// An amount of memory: `1.5 MiB`.
pub fn bytes(count: usize) -> String {
    let count = count as f64;
    let units = [(1024.0 * 1024.0 * 1024.0, "GiB"), (1024.0 * 1024.0, "MiB"), (1024.0, "KiB")];
    match units.iter().find(|(scale, _)| count >= *scale) {
        Some((scale, unit)) => format!("{:.1} {unit}", count / scale),
        None => format!("{count} B"),
    }
}

/// A duration in its two largest units: `2 h 5 min`, `12 s`, `0.35 s`.
pub fn duration(seconds: f64) -> String {
    // Longer durations are meaningless.
    if seconds.is_nan() || seconds >= 3.6e9 {
        return "more than a hundred years".into();
    }
    let whole = Duration::from_secs_f64(seconds.max(0.0)).as_secs();
    match (whole / 86400, whole / 3600 % 24, whole / 60 % 60, whole % 60) {
        (0, 0, 0, _) if seconds < 0.01 => "less than 0.01 s".into(),
        (0, 0, 0, s) if s < 10 => format!("{seconds:.2} s"),
        (0, 0, 0, s) => format!("{s} s"),
        (0, 0, m, s) => format!("{m} min {s} s"),
        (0, h, m, _) => format!("{h} h {m} min"),
        (d, h, _, _) => format!("{d} d {h} h"),
    }
}

/// A table with aligned columns: the first ones to the left, `numbers` last ones to the right.
pub struct TextTable {
    rows: Vec<Vec<String>>,
    numbers: usize,
}

impl TextTable {
    /// A table with these headings.
    pub fn new(headings: &[&str], numbers: usize) -> Self {
        Self { rows: vec![headings.iter().map(|&heading| heading.to_owned()).collect()], numbers }
    }

    /// Adds a row, which must have as many cells as there are headings.
    pub fn row(&mut self, cells: impl IntoIterator<Item = String>) {
        self.rows.push(cells.into_iter().collect());
    }

    /// The table as lines, each indented by two spaces.
    pub fn render(&self) -> String {
        let columns = self.rows[0].len();
        let width = |k: usize| self.rows.iter().map(|row| row[k].chars().count()).max().unwrap_or(0);
        let widths: Vec<usize> = (0..columns).map(width).collect();
        let cell = |k: usize, text: &String| {
            let width = widths[k];
            if k + self.numbers >= columns { format!("{text:>width$}") } else { format!("{text:<width$}") }
        };
        let line = |row: &Vec<String>| {
            let cells: Vec<String> = row.iter().enumerate().map(|(k, text)| cell(k, text)).collect();
            format!("{}\n", format!("  {}", cells.join("  ")).trim_end())
        };
        self.rows.iter().map(line).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_are_short() {
        assert_eq!(counted(1_234_567.0, "steps"), "1.23 M steps");
        assert_eq!(counted(12.0, "steps"), "12 steps");
        assert_eq!(bytes(3 << 19), "1.5 MiB");
        assert_eq!(duration(0.354), "0.35 s");
        assert_eq!(duration(7505.0), "2 h 5 min");
        assert_eq!(duration(0.001), "less than 0.01 s");
        assert_eq!(duration(f64::INFINITY), "more than a hundred years");
        assert_eq!(duration(f64::NAN), "more than a hundred years");
    }

    #[test]
    fn arguments_can_be_pasted() {
        assert_eq!(quoted("out/beam"), "out/beam");
        assert_eq!(quoted("out/my run's"), r"'out/my run'\''s'");
    }

    #[test]
    fn columns_are_aligned() {
        let mut table = TextTable::new(&["name", "J"], 1);
        table.row(["kinetic".into(), "1.0".into()]);
        table.row(["st\u{e4}rke".into(), "12.0".into()]);
        assert_eq!(table.render(), "  name        J\n  kinetic   1.0\n  st\u{e4}rke   12.0\n");
    }
}
