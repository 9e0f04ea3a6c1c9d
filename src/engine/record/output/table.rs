//! A series file and the extremes of its columns.

use std::path::PathBuf;

use serde::{Deserialize, Serialize};

use super::folder::OutputFolder;
use crate::record::{Existing, SeriesError, SeriesWriter};

/// Minimum, maximum and last value of a column, with their times.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Extreme {
    /// Name of the column.
    pub name: String,
    /// Unit, SI.
    pub unit: String,
    /// Minimum value; NaN if there has been none.
    pub min: f64,
    /// Time of the minimum value, s.
    pub min_time: f64,
    /// Largest value.
    pub max: f64,
    /// Time of the largest value, s.
    pub max_time: f64,
    /// Last value.
    pub last: f64,
}

impl Extreme {
    fn new(name: &str, unit: &str) -> Self {
        let nan = f64::NAN;
        let (name, unit) = (name.to_owned(), unit.to_owned());
        Self { name, unit, min: nan, min_time: nan, max: nan, max_time: nan, last: nan }
    }

    /// Of equal values the first counts; NaN is not a value.
    fn take(&mut self, time: f64, value: f64) {
        self.last = value;
        if value < self.min || (self.min.is_nan() && !value.is_nan()) {
            (self.min, self.min_time) = (value, time);
        }
        if value > self.max || (self.max.is_nan() && !value.is_nan()) {
            (self.max, self.max_time) = (value, time);
        }
    }
}

/// A series file, once it is open.
pub(super) struct SeriesFile {
    pub path: PathBuf,
    writer: Option<SeriesWriter>,
    pub extremes: Vec<Extreme>,
}

/// State of a table in a checkpoint.
#[derive(Serialize, Deserialize)]
pub(super) struct TableState {
    /// Length of the file, B; none if it was not open yet.
    position: Option<u64>,
    extremes: Vec<Extreme>,
}

impl SeriesFile {
    pub fn new(path: PathBuf) -> Self {
        Self { path, writer: None, extremes: Vec::new() }
    }

    /// Begins the file.
    pub fn create(&mut self, columns: &[(String, &str)], folder: &OutputFolder) -> Result<(), SeriesError> {
        // What a resumed run finds here is its own, from after the checkpoint.
        let existing = if folder.resume { Existing::Replace } else { folder.existing };
        self.writer = Some(SeriesWriter::create(&self.path, &borrowed(columns), existing)?);
        self.extremes = columns.iter().map(|(name, unit)| Extreme::new(name, unit)).collect();
        Ok(())
    }

    /// Continues the file from where the checkpoint was; a file that was not open then begins when its turn
    /// comes.
    pub fn resume(&mut self, columns: &[(String, &str)], state: TableState) -> Result<(), SeriesError> {
        if let Some(position) = state.position {
            self.writer = Some(SeriesWriter::resume(&self.path, &borrowed(columns), position)?);
            self.extremes = state.extremes;
        }
        Ok(())
    }

    pub fn push(&mut self, time: f64, values: &[f64]) -> Result<(), SeriesError> {
        for (extreme, value) in self.extremes.iter_mut().zip(values) {
            extreme.take(time, *value);
        }
        self.writer.as_mut().map_or(Ok(()), |writer| writer.push(time, values))
    }

    /// Hands all rows to the operating system.
    pub fn flush(&mut self) -> Result<(), SeriesError> {
        self.writer.as_mut().map_or(Ok(()), SeriesWriter::flush)
    }

    /// Forces all rows to the disk.
    pub fn sync(&mut self) -> Result<(), SeriesError> {
        self.writer.as_mut().map_or(Ok(()), |writer| writer.sync().map(|_| ()))
    }

    /// The state as of the last [`SeriesFile::sync`].
    pub fn state(&self) -> TableState {
        let position = self.writer.as_ref().map(SeriesWriter::position);
        TableState { position, extremes: self.extremes.clone() }
    }
}

fn borrowed<'a>(columns: &'a [(String, &'a str)]) -> Vec<(&'a str, &'a str)> {
    columns.iter().map(|(name, unit)| (name.as_str(), *unit)).collect()
}
