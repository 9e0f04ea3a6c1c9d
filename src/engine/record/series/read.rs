//! Reading series back: those of a run and reference data.

use std::fs;
use std::path::{Path, PathBuf};

use csv::StringRecord;

use super::SeriesError;

/// A column of a series.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct SeriesColumn {
    /// Its name, without the unit.
    pub name: String,
    /// Its unit, where the header ends in one in brackets: `x[m]`.
    pub unit: Option<String>,
}

impl SeriesColumn {
    pub(super) fn new(header: &str) -> Self {
        match header.strip_suffix(']').and_then(|text| text.rsplit_once('[')) {
            Some((name, unit)) => Self { name: name.to_owned(), unit: Some(unit.to_owned()) },
            None => Self { name: header.to_owned(), unit: None },
        }
    }

    fn header(&self) -> String {
        match &self.unit {
            Some(unit) => format!("{}[{unit}]", self.name),
            None => self.name.clone(),
        }
    }
}

/// A table of named columns, read from a CSV file.
#[derive(Debug)]
pub struct Series {
    path: PathBuf,
    columns: Vec<SeriesColumn>,
    rows: Vec<SeriesRow>,
}

#[derive(Debug)]
struct SeriesRow {
    line: u64,
    cells: StringRecord,
}

impl Series {
    /// The columns, from left to right.
    pub fn columns(&self) -> &[SeriesColumn] {
        &self.columns
    }

    /// Number of rows.
    pub fn len(&self) -> usize {
        self.rows.len()
    }

    /// Whether there are no rows.
    pub fn is_empty(&self) -> bool {
        self.rows.is_empty()
    }

    /// The column `name` as numbers; an empty cell is NaN, a text is an error. The name may carry its unit.
    pub fn numbers(&self, name: &str) -> Result<Vec<f64>, SeriesError> {
        let column = self.find(name)?;
        self.rows
            .iter()
            .map(|row| match &row.cells[column] {
                "" => Ok(f64::NAN),
                cell => cell.parse().map_err(|_| SeriesError::NotANumber {
                    path: self.path.clone(),
                    line: row.line,
                    column: name.to_owned(),
                    found: cell.to_owned(),
                }),
            })
            .collect()
    }

    /// The column `name` as it stands in the file, without the blanks around it.
    pub fn texts(&self, name: &str) -> Result<Vec<&str>, SeriesError> {
        let column = self.find(name)?;
        Ok(self.rows.iter().map(|row| &row.cells[column]).collect())
    }

    fn find(&self, name: &str) -> Result<usize, SeriesError> {
        self.columns.iter().position(|column| column.name == name || column.header() == name).ok_or_else(
            || SeriesError::NoColumn {
                path: self.path.clone(),
                name: name.to_owned(),
                known: self
                    .columns
                    .iter()
                    .map(|column| format!("`{}`", column.header()))
                    .collect::<Vec<_>>()
                    .join(", "),
            },
        )
    }
}

/// Reads the CSV file `path`.
///
/// Lines that begin with `#` are comments. The first other line names the columns; if it holds nothing but
/// numbers, it is the first row and the columns are named `0`, `1`, ...
pub fn read_series(path: &Path) -> Result<Series, SeriesError> {
    let text = fs::read(path).map_err(|source| SeriesError::Read { path: path.to_path_buf(), source })?;
    let mut lines = LineCounter { text: &text, at: 0, line: 1 };
    let mut reader = csv::ReaderBuilder::new()
        .has_headers(false)
        .comment(Some(b'#'))
        .trim(csv::Trim::All)
        .from_reader(text.as_slice());
    let mut rows = Vec::new();
    loop {
        let line = lines.of_next(reader.position());
        let mut cells = StringRecord::new();
        match reader.read_record(&mut cells).map_err(csv::Error::into_kind) {
            Ok(true) => rows.push(SeriesRow { line, cells }),
            Ok(false) => break,
            Err(csv::ErrorKind::UnequalLengths { expected_len, len, .. }) => {
                let what = format!("line {line} has {len} cells, expected {expected_len}");
                return Err(malformed(path, what));
            }
            Err(_) => return Err(malformed(path, format!("line {line} is not text in UTF-8"))),
        }
    }
    let first = rows
        .first()
        .ok_or_else(|| malformed(path, "it is empty, expected a line of column names".to_owned()))?;
    let columns = if first.cells.iter().all(|cell| cell.parse::<f64>().is_ok()) {
        (0..first.cells.len()).map(|index| SeriesColumn { name: index.to_string(), unit: None }).collect()
    } else {
        rows.remove(0).cells.iter().map(SeriesColumn::new).collect::<Vec<_>>()
    };
    check_names(path, &columns)?;
    Ok(Series { path: path.to_path_buf(), columns, rows })
}

/// Counts lines up to the record that a reader will read next.
///
/// The reader's own count is that of where the record before ended, which is short of line feeds after
/// carriage returns, of empty lines and of comments.
struct LineCounter<'a> {
    text: &'a [u8],
    at: usize,
    line: u64,
}

impl LineCounter<'_> {
    /// The line on which the record after `position` begins; positions must not decrease.
    fn of_next(&mut self, position: &csv::Position) -> u64 {
        let end = usize::try_from(position.byte()).unwrap_or(usize::MAX);
        let mut in_comment = false;
        while let Some(&byte) = self.text.get(self.at) {
            if self.at >= end {
                in_comment = byte != b'\n' && (in_comment || byte == b'#');
                if !in_comment && !matches!(byte, b'\n' | b'\r') {
                    break;
                }
            }
            self.line += u64::from(byte == b'\n');
            self.at += 1;
        }
        self.line
    }
}

/// Every column must be found by its name.
pub(super) fn check_names(path: &Path, columns: &[SeriesColumn]) -> Result<(), SeriesError> {
    for (index, column) in columns.iter().enumerate() {
        let SeriesColumn { name, .. } = column;
        if name.is_empty() {
            return Err(malformed(path, format!("column {} has no name", index + 1)));
        }
        if columns[..index].iter().any(|earlier| earlier.name == *name) {
            return Err(malformed(path, format!("two columns are named `{name}`, names must differ")));
        }
    }
    Ok(())
}

fn malformed(path: &Path, what: String) -> SeriesError {
    SeriesError::Malformed { path: path.to_path_buf(), what }
}
