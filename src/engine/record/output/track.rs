//! A probe during a run: when it is due, its value, its file.

use std::sync::Arc;

use serde::{Deserialize, Serialize};

use super::folder::OutputFolder;
use super::mean::TimeMean;
use super::table::{SeriesFile, TableState};
use crate::record::RecordError;
use crate::record::probe::{EnergyColumns, Gauge, ResolvedProbe};
use crate::schedule::Trigger;
use crate::schedule::{Ledger, Step, StepError};
use crate::world::BodyId;

/// A number for recorders: path of the series, unit, value.
pub(super) type OwnedSample = (String, &'static str, f64);

/// A probe, or the energy ledger, with its file.
pub(super) struct Track {
    /// Path of its series for recorders: `energy`, `probe/tip`.
    pub path: String,
    /// Name of the probe.
    pub name: String,
    may_be_empty: bool,
    gauge: Arc<Gauge>,
    trigger: Trigger,
    /// The mean over time of its samples, if they are means.
    mean: Option<TimeMean>,
    pub table: SeriesFile,
    /// Time of the last sample, s.
    last: Option<f64>,
    /// Accounts that the file has columns for; none before all systems have run.
    accounts: Option<Vec<String>>,
    /// The sample of the start, until the accounts are known.
    held: Option<(f64, Ledger)>,
}

/// State of a track in a checkpoint.
#[derive(Serialize, Deserialize)]
pub(super) struct TrackState {
    trigger: Trigger,
    mean: Option<TimeMean>,
    last: Option<f64>,
    accounts: Option<Vec<String>>,
    held: Option<(f64, Ledger)>,
    table: TableState,
}

impl Track {
    /// The track of a probe.
    pub fn of_probe(probe: ResolvedProbe, folder: &OutputFolder) -> Self {
        let file = folder.file(&format!("{}.csv", probe.name));
        Self::new(format!("probe/{}", probe.name), probe, file)
    }

    /// A track whose series have the path `path` and whose file is `file`.
    pub fn new(path: String, probe: ResolvedProbe, file: std::path::PathBuf) -> Self {
        Self {
            path,
            name: probe.name,
            may_be_empty: probe.may_be_empty,
            gauge: probe.gauge,
            trigger: Trigger::new(probe.interval),
            mean: probe.mean.then(TimeMean::default),
            table: SeriesFile::new(file),
            last: None,
            accounts: None,
            held: None,
        }
    }

    /// Whether it has measured, and found nothing in any sample, which the user does not expect.
    pub fn has_found_nothing(&self) -> bool {
        let extremes = &self.table.extremes;
        let mut ends = extremes.iter().flat_map(|extreme| [extreme.min, extreme.max]);
        let is_empty = !extremes.is_empty() && ends.all(|end| self.gauge.is_of_nothing(end));
        !self.may_be_empty && self.last.is_some() && is_empty
    }

    /// The wall or body in which its gauge lay and which has moved away from it.
    pub fn left_by(&self) -> Option<BodyId> {
        self.gauge.left_by()
    }

    /// Names of the particle columns that it reads.
    pub fn needs(&self) -> Vec<&'static str> {
        self.gauge.needs()
    }

    /// Begins the file, or continues it; files of energies begin after the first step.
    pub fn open(&mut self, folder: &OutputFolder, state: Option<TrackState>) -> Result<(), RecordError> {
        let Some(state) = state else {
            return if matches!(*self.gauge, Gauge::Energies(_)) { Ok(()) } else { self.create(folder) };
        };
        self.trigger.resume(state.trigger);
        if self.mean.is_some() {
            self.mean = state.mean;
        }
        self.last = state.last;
        self.accounts = state.accounts;
        self.held = state.held;
        let columns = self.columns();
        Ok(self.table.resume(&columns, state.table)?)
    }

    fn create(&mut self, folder: &OutputFolder) -> Result<(), RecordError> {
        let columns = self.columns();
        Ok(self.table.create(&columns, folder)?)
    }

    pub fn state(&self) -> TrackState {
        TrackState {
            trigger: self.trigger,
            mean: self.mean.clone(),
            last: self.last,
            accounts: self.accounts.clone(),
            held: self.held.clone(),
            table: self.table.state(),
        }
    }

    /// Name and unit of the columns of the file.
    fn columns(&self) -> Vec<(String, &'static str)> {
        match &*self.gauge {
            Gauge::Energies(energies) => energies.names(self.accounts.as_deref().unwrap_or_default()),
            gauge => gauge.columns(),
        }
    }

    /// Path and unit of the series, as far as they are known now.
    pub fn series(&self, ledger: &Ledger) -> Vec<(String, &'static str)> {
        let columns = match &*self.gauge {
            Gauge::Energies(energies) => energies.names(&EnergyColumns::accounts(ledger)),
            gauge => gauge.columns(),
        };
        columns.into_iter().map(|(name, unit)| (self.series_path(&name), unit)).collect()
    }

    /// A column `plate.kinetic` of the ledger is the series `energy/plate/kinetic`.
    fn series_path(&self, column: &str) -> String {
        match &*self.gauge {
            Gauge::Energies(_) => format!("{}/{}", self.path, column.replacen('.', "/", 1)),
            _ => format!("{}/{column}", self.path),
        }
    }

    /// Measures if it is due, or if this is the end, and adds to `samples` what recorders get.
    pub fn record(
        &mut self,
        step: &Step<'_>,
        at_end: bool,
        folder: &OutputFolder,
        samples: &mut Vec<OwnedSample>,
    ) -> Result<(), StepError> {
        let time = step.clock.time;
        let started = step.clock.step > 0 || at_end;
        if started && self.accounts.is_none() && matches!(*self.gauge, Gauge::Energies(_)) {
            self.open_accounts(step.ledger, folder)?;
        }
        let due = self.trigger.is_due(time) || (at_end && self.last != Some(time));
        if let Some(mean) = &mut self.mean {
            mean.add(time, &self.gauge.read(step.world, step.resources)?);
        }
        if !due {
            return Ok(());
        }
        self.last = Some(time);
        let values = match &*self.gauge {
            Gauge::Energies(energies) => {
                let now = EnergyColumns::accounts(step.ledger);
                let values = energies.values(&now, step.ledger);
                let series = self.series(step.ledger).into_iter().zip(values);
                samples.extend(series.map(|((path, unit), value)| (path, unit, value)));
                let Some(accounts) = &self.accounts else {
                    self.held = Some((time, step.ledger.clone()));
                    return Ok(());
                };
                energies.values(accounts, step.ledger)
            }
            gauge => {
                let values = match &mut self.mean {
                    Some(mean) => mean.take(),
                    None => gauge.read(step.world, step.resources)?,
                };
                let series = self.series(step.ledger).into_iter().zip(&values);
                samples.extend(series.map(|((path, unit), value)| (path, unit, *value)));
                values
            }
        };
        self.table.push(time, &values).map_err(failed)
    }

    /// Every system has run: the accounts of the ledger are the columns. Begins the file with what was held
    /// back.
    fn open_accounts(&mut self, ledger: &Ledger, folder: &OutputFolder) -> Result<(), StepError> {
        self.accounts = Some(EnergyColumns::accounts(ledger));
        self.create(folder).map_err(failed)?;
        if let (Some((time, ledger)), Gauge::Energies(energies)) = (self.held.take(), &*self.gauge) {
            let values = energies.values(self.accounts.as_deref().unwrap_or_default(), &ledger);
            self.table.push(time, &values).map_err(failed)?;
        }
        Ok(())
    }

    /// Accounts of the ledger that have no column, because they were opened too late.
    pub fn lacking<'l>(&self, ledger: &'l Ledger) -> Vec<&'l str> {
        let Some(known) = &self.accounts else { return Vec::new() };
        let names = ledger.accounts().iter().map(|account| account.name.as_str());
        names.filter(|name| !known.iter().any(|other| other == name)).collect()
    }
}

/// An error of writing, which ends the run.
pub(super) fn failed(error: impl Into<RecordError>) -> StepError {
    StepError::Output(error.into().to_string())
}
