//! Time series as CSV: output of probes and of the energy ledger, and reference data.
//!
//! A header `t[s],x[m],...` of names and units, then one row per record. Numbers are written with the fewest
//! digits that read back to the same bits. Rows reach the file whole, so that a killed run leaves a file that
//! is readable up to its last flush.

use std::fs::{File, OpenOptions};
use std::io::{self, Read, Seek, SeekFrom, Write};
use std::path::{Path, PathBuf};

use super::atomic::{Existing, WriteError};
use crate::ranks;

mod read;
#[cfg(test)]
mod tests;

pub use read::{Series, SeriesColumn, read_series};

/// Bytes that are collected before they go to the file.
const BUFFER: usize = 1 << 16;

/// Why a series could not be written, continued or read.
#[derive(Debug, thiserror::Error)]
pub enum SeriesError {
    /// The operating system could not read the file.
    #[error("cannot read the series `{}`: {source}", path.display())]
    Read {
        /// The file.
        path: PathBuf,
        /// Error of the operating system.
        source: io::Error,
    },
    /// The file is no table.
    #[error("`{}` is not a series: {what}", path.display())]
    Malformed {
        /// The file.
        path: PathBuf,
        /// The finding, its place, and the correction.
        what: String,
    },
    /// There is no such column.
    #[error("the series `{}` has no column `{name}`; its columns are {known}", path.display())]
    NoColumn {
        /// The file.
        path: PathBuf,
        /// The column asked for.
        name: String,
        /// The columns there are.
        known: String,
    },
    /// A cell that should be a number is something else.
    #[error("`{}`, line {line}, column `{column}`: found `{found}`, expected a number", path.display())]
    NotANumber {
        /// The file.
        path: PathBuf,
        /// The line, from 1.
        line: u64,
        /// The column.
        column: String,
        /// The cell.
        found: String,
    },
    /// A row of another length than the header.
    #[error("a row of {found} values for the series `{}`, expected {expected}", path.display())]
    Width {
        /// The file.
        path: PathBuf,
        /// Values given, without the time.
        found: usize,
        /// Columns of the series, without the time.
        expected: usize,
    },
    /// The file is not the one that a checkpoint speaks of.
    #[error(
        "cannot continue the series `{}`: {what}; put the file of the interrupted run back or run anew",
        path.display()
    )]
    Resume {
        /// The file.
        path: PathBuf,
        /// The value found and the expected one.
        what: String,
    },
    /// The file could not be written.
    #[error(transparent)]
    Write(#[from] WriteError),
}

/// Writes a time series, row by row; of several ranks the first one alone.
#[derive(Debug)]
pub struct SeriesWriter {
    path: PathBuf,
    /// None on a rank that writes no files.
    file: Option<File>,
    /// Whole rows that the file does not have yet.
    pending: String,
    /// Bytes that the file has.
    position: u64,
    width: usize,
}

impl SeriesWriter {
    /// Begins the file `path` with a column `t[s]` and then `columns`, each a name and a unit (empty for
    /// none). An error if the file cannot be written.
    pub fn create(path: &Path, columns: &[(&str, &str)], existing: Existing) -> Result<Self, SeriesError> {
        let header = header(path, columns)?;
        let mut options = OpenOptions::new();
        options.write(true);
        match existing {
            Existing::Refuse => options.create_new(true),
            Existing::Replace => options.create(true).truncate(true),
        };
        let open = || options.open(path).map_err(|source| WriteError::new(path, source));
        let file = ranks::is_first().then(open).transpose()?;
        let mut writer =
            Self { path: path.to_path_buf(), file, pending: header, position: 0, width: columns.len() };
        writer.flush()?;
        Ok(writer)
    }

    /// Continues the file `path` of an interrupted run from its first `position` bytes, as [`Self::sync`]
    /// gave them at the checkpoint; later rows are cut off. An error if the file is not that of the
    /// interrupted run, or cannot be read or written.
    pub fn resume(path: &Path, columns: &[(&str, &str)], position: u64) -> Result<Self, SeriesError> {
        let expected = header(path, columns)?;
        let open = || Self::reopen(path, &expected, position);
        let file = ranks::is_first().then(open).transpose()?;
        Ok(Self { path: path.to_path_buf(), file, pending: String::new(), position, width: columns.len() })
    }

    fn reopen(path: &Path, expected: &str, position: u64) -> Result<File, SeriesError> {
        let mut file = OpenOptions::new()
            .read(true)
            .write(true)
            .open(path)
            .map_err(|source| SeriesError::Read { path: path.to_path_buf(), source })?;
        check_resumable(&mut file, expected, position)
            .map_err(|source| SeriesError::Read { path: path.to_path_buf(), source })?
            .map_or(Ok(()), |what| Err(SeriesError::Resume { path: path.to_path_buf(), what }))?;
        file.set_len(position)
            .and_then(|()| file.seek(SeekFrom::Start(position)))
            .map_err(|source| WriteError::new(path, source))?;
        Ok(file)
    }

    /// Adds the row of the time `t` \[s\]. An error if the number of values is not that of the columns, or
    /// the file cannot be written.
    pub fn push(&mut self, t: f64, values: &[f64]) -> Result<(), SeriesError> {
        if values.len() != self.width {
            let path = self.path.clone();
            return Err(SeriesError::Width { path, found: values.len(), expected: self.width });
        }
        self.pending.push_str(&number(t));
        for &value in values {
            self.pending.push(',');
            self.pending.push_str(&number(value));
        }
        self.pending.push('\n');
        if self.pending.len() >= BUFFER { self.flush() } else { Ok(()) }
    }

    /// Hands all rows to the operating system, so that they survive any end of the program. An error if the
    /// file cannot be written.
    pub fn flush(&mut self) -> Result<(), SeriesError> {
        let pending = std::mem::take(&mut self.pending);
        if let Some(file) = &mut self.file
            && let Err(source) = file.write_all(pending.as_bytes())
        {
            // A full disk takes part of a row: the file is cut back to what it had, as far as that is
            // possible.
            let back = SeekFrom::Start(self.position);
            let _ = file.set_len(self.position).and_then(|()| file.seek(back));
            return Err(WriteError::new(&self.path, source).into());
        }
        self.position += pending.len() as u64;
        Ok(())
    }

    /// Forces all rows to the disk and returns the length of the file in bytes, to be kept in a checkpoint.
    /// An error if the file cannot be written.
    pub fn sync(&mut self) -> Result<u64, SeriesError> {
        self.flush()?;
        let synced = self.file.as_ref().map_or(Ok(()), File::sync_data);
        synced.map_err(|source| WriteError::new(&self.path, source))?;
        Ok(self.position)
    }

    /// Bytes that the file has: all rows up to the last flush.
    pub fn position(&self) -> u64 {
        self.position
    }
}

impl Drop for SeriesWriter {
    fn drop(&mut self) {
        // Nobody is left to tell; a caller who has to know flushes.
        let _ = self.flush();
    }
}

/// The shortest text that reads back to the same bits.
fn number(value: f64) -> String {
    format!("{value:?}")
}

/// The header line.
fn header(path: &Path, columns: &[(&str, &str)]) -> Result<String, SeriesError> {
    let names: Vec<String> = [("t", "s")]
        .iter()
        .chain(columns)
        .map(|(name, unit)| if unit.is_empty() { (*name).to_owned() } else { format!("{name}[{unit}]") })
        .collect();
    let as_read: Vec<SeriesColumn> = names.iter().map(|name| SeriesColumn::new(name)).collect();
    read::check_names(path, &as_read)?;

    let malformed = |what: String| SeriesError::Malformed { path: path.to_path_buf(), what };
    let mut csv = csv::Writer::from_writer(Vec::new());
    csv.write_record(&names).map_err(|error| malformed(error.to_string()))?;
    let bytes = csv.into_inner().map_err(|error| malformed(error.to_string()))?;
    String::from_utf8(bytes).map_err(|error| malformed(error.to_string()))
}

/// Reason why the file cannot be continued, if there is one.
fn check_resumable(file: &mut File, header: &str, position: u64) -> io::Result<Option<String>> {
    let len = file.metadata()?.len();
    let mut found = Vec::new();
    Read::by_ref(file).take(header.len() as u64).read_to_end(&mut found)?;
    if found != header.as_bytes() {
        let found = String::from_utf8_lossy(&found);
        let found = found.lines().next().unwrap_or_default();
        return Ok(Some(format!("it begins with `{found}`, expected `{}`", header.trim_end())));
    }
    if len < position || position < header.len() as u64 {
        return Ok(Some(format!("it has {len} bytes, expected {position} at the checkpoint")));
    }
    file.seek(SeekFrom::Start(position - 1))?;
    let mut last = [0];
    file.read_exact(&mut last)?;
    Ok((last != [b'\n']).then(|| format!("no row ends at byte {position}, where the checkpoint was")))
}
