//! Tabulated functions of a scene: `tables: { "pull": (file: "pull.csv") }`, used as `"1e5*pull(t)"`.

use std::path::Path;

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::Problem;

/// A tabulated function of one variable, interpolated linearly between its points and constant beyond the
/// first and the last. Expressions call it by its name: `"1e5*pull(t)"`.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Table {
    /// CSV file with a header; its path is relative to the scene. Either this or `points`.
    #[serde(default)]
    pub file: Option<String>,
    /// Column of the file with the variable; without it the first one.
    #[serde(default)]
    pub variable: Option<String>,
    /// Column of the file with the value; without it the second one.
    #[serde(default)]
    pub value: Option<String>,
    /// Points (variable, value), the variable increasing.
    #[serde(default)]
    pub points: Vec<(f64, f64)>,
}

impl Table {
    /// The function. The file is relative to `folder`, and `path` is the path of the table in the scene.
    ///
    /// # Errors
    /// The file cannot be read, or the points do not define a function.
    pub(super) fn interpolation(&self, folder: &Path, path: &str) -> Result<Interpolation, Problem> {
        let at = |field: &str| format!("{path}.{field}");
        let (points, at) = match (&self.file, self.points.is_empty()) {
            (Some(file), true) => {
                let points = self.read(&folder.join(file));
                (points.map_err(|message| Problem::at_path(at("file"), message))?, at("file"))
            }
            (None, false) => (self.points.clone(), at("points")),
            (Some(_), false) => {
                return Err(Problem::at_path(
                    at("points"),
                    "a table has either `file` or `points`, not both",
                ));
            }
            (None, true) => return Err(Problem::at_path(path, "a table needs `file` or `points`")),
        };
        if let Some(k) = points.iter().position(|(x, y)| !x.is_finite() || !y.is_finite()) {
            let message =
                format!("every value must be a finite number, found {:?} at point {}", points[k], k + 1);
            return Err(Problem::at_path(at, message));
        }
        if let Some(k) = (1..points.len()).find(|&k| points[k].0 <= points[k - 1].0) {
            let (before, here) = (points[k - 1].0, points[k].0);
            let message =
                format!("the variable must increase, found {here} after {before} at point {}", k + 1);
            return Err(Problem::at_path(at, message));
        }
        Ok(Interpolation { points })
    }

    fn read(&self, file: &Path) -> Result<Vec<(f64, f64)>, String> {
        let shown = file.display();
        let failed = |error: csv::Error| match error.kind() {
            csv::ErrorKind::UnequalLengths { expected_len, len, .. } => {
                let line = error.position().map_or(0, csv::Position::line);
                format!(
                    "`{shown}`, line {line}: expected {expected_len} values as in the header, found {len}"
                )
            }
            csv::ErrorKind::Utf8 { .. } => {
                let line = error.position().map_or(0, csv::Position::line);
                format!(
                    "`{shown}`, line {line}: expected text in UTF-8; save the table as CSV in this encoding"
                )
            }
            _ => format!("cannot read the table `{shown}`: {error}"),
        };
        let mut reader = csv::ReaderBuilder::new().trim(csv::Trim::All).from_path(file).map_err(failed)?;
        let headers = reader.headers().map_err(failed)?.clone();
        let names: Vec<&str> =
            headers.iter().map(|name| name.split('[').next().unwrap_or(name).trim()).collect();
        if names.is_empty() {
            return Err(format!("the table `{shown}` is empty: expected a header and rows of two numbers"));
        }
        if names.len() < 2 {
            return Err(format!("a table needs two columns, `{shown}` has {}", names.len()));
        }
        let column = |name: &Option<String>, k: usize| match name {
            Some(name) => names.iter().position(|other| other == name).ok_or_else(|| {
                format!("the table `{shown}` has no column `{name}`; its columns are {}", names.join(", "))
            }),
            None => Ok(k),
        };
        let columns = [column(&self.variable, 0)?, column(&self.value, 1)?];
        let mut points = Vec::new();
        for (record, line) in reader.records().zip(2..) {
            let record = record.map_err(failed)?;
            let [x, y] = columns.map(|k| record[k].parse::<f64>());
            let (Ok(x), Ok(y)) = (x, y) else {
                return Err(format!(
                    "`{shown}`, line {line}: expected numbers, found `{}`",
                    record.iter().collect::<Vec<_>>().join(",")
                ));
            };
            points.push((x, y));
        }
        if points.is_empty() {
            Err(format!("the table `{shown}` has a header but no rows"))
        } else {
            Ok(points)
        }
    }
}

/// Piecewise linear interpolation; at least one point, the variable increasing.
#[derive(Debug)]
pub(super) struct Interpolation {
    points: Vec<(f64, f64)>,
}

impl Interpolation {
    /// The value at `x`. NaN stays NaN, so that the watchdog sees it.
    pub fn at(&self, x: f64) -> f64 {
        let after = self.points.partition_point(|point| point.0 <= x);
        match (after.checked_sub(1).and_then(|k| self.points.get(k)), self.points.get(after)) {
            _ if x.is_nan() => x,
            (Some(&(x0, y0)), Some(&(x1, y1))) => y0 + (y1 - y0) * ((x - x0) / (x1 - x0)),
            (Some(&(_, y)), None) | (None, Some(&(_, y))) => y,
            (None, None) => f64::NAN,
        }
    }

    /// The values at the points between two places.
    pub fn values_between(&self, from: f64, to: f64) -> impl Iterator<Item = f64> {
        let first = self.points.partition_point(|point| point.0 <= from);
        self.points[first..].iter().take_while(move |point| point.0 < to).map(|point| point.1)
    }
}
