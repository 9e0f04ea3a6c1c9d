//! Checkpoints during a run, and its end: files closed, summary written.

use std::cell::RefMut;
use std::path::{Path, PathBuf};

use super::{RunError, SaveError, Simulation, Summary};
use crate::notation::quantity;
use crate::record::{Existing, Output, RecordError, write_atomically};
use crate::scene::Source;
use crate::world::BodyId;

/// Relative balance error of the energy ledger at the end that is worth a warning.
const BALANCE_WARNING: f64 = 1e-2;

impl Simulation {
    /// The output, if there is one.
    pub(super) fn output(&self) -> Option<RefMut<'_, Output>> {
        self.output.map(|place| self.resources.of_mut(place))
    }

    /// Writes a checkpoint into the output folder, in place of the last one; returns its file, or none if the
    /// run writes nothing.
    ///
    /// # Errors
    /// It cannot be written.
    pub fn checkpoint(&mut self) -> Result<Option<PathBuf>, SaveError> {
        let Some(file) = self.output().map(|output| output.checkpoint_file()) else { return Ok(None) };
        // Files that a scene names are relative to its folder, also for a run that goes on from elsewhere.
        let name = std::path::absolute(&self.source.name)
            .map_or_else(|_| self.source.name.clone(), |path| path.display().to_string());
        self.save(&file, &Source::new(name, self.source.text.clone()))?;
        // The state is safe: a recorder that fails can no longer take it along.
        if let Some(mut output) = self.output() {
            output.flush_recorders()?;
        }
        Ok(Some(file))
    }

    pub(super) fn checkpoint_if_due(&mut self) -> Result<(), RunError> {
        let due = self.output().is_some_and(|mut output| output.take_checkpoint_due());
        if due {
            self.checkpoint()?;
        }
        Ok(())
    }

    /// Notes why the run cannot go on, and makes readable what was recorded.
    pub(super) fn fail(&mut self, error: &RunError) {
        self.failure = Some(error.to_string());
        if let Some(mut output) = self.output() {
            // The failure of the run is reported; one of this attempt would hide it.
            let _ = output.flush();
        }
    }

    /// Ends the run, wherever it is: writes a checkpoint unless it has failed (or is complete and the
    /// scene wants none then), closes all files and
    /// writes the summary. A second call writes nothing new.
    ///
    /// # Errors
    /// Something cannot be written.
    pub fn finish(&mut self) -> Result<Summary, RunError> {
        self.warn_of_balance();
        self.warn_of_empty_probes();
        self.warn_of_left_probes();
        if !self.output().is_some_and(|output| output.has_begun()) {
            return Ok(self.summary());
        }
        // Each part is tried, whatever has become of the others; the first fault is reported.
        let kept = match self.failure.is_none() && (self.clock.time < self.end || self.checkpoint_at_end) {
            true => self.checkpoint().map(drop),
            false => Ok(()),
        };
        let recorded = self.output().map_or(Ok(()), |mut output| output.finish(&self.warnings));
        let summary = self.summary();
        let file = self.output().map(|output| output.summary_file());
        let written = file.map_or(Ok(()), |file| write_summary(&file, &summary));
        kept?;
        recorded?;
        written?;
        Ok(summary)
    }

    /// The run has used more energy than it can account for, and more than round-off.
    fn warn_of_balance(&mut self) {
        let error = self.ledger.relative_error();
        let is_round_off = self.ledger.balance_error().abs() <= self.ledger.resolution();
        if error.abs() > BALANCE_WARNING && !is_round_off && self.failure.is_none() {
            let text = format!(
                "energy balance error: {:.2} % of the peak energy ({})",
                100.0 * error,
                quantity(self.ledger.balance_error(), "J")
            );
            if !self.warnings.contains(&text) {
                self.warnings.push(text);
            }
        }
    }

    /// Probes have found nothing from the start to the end.
    fn warn_of_empty_probes(&mut self) {
        if self.failure.is_some() || self.clock.time < self.end {
            return;
        }
        let of = |name: &str| {
            format!(
                "probe `{name}` has found nothing in any sample: is it where no particle comes, or does a sensor face into its wall? `may_be_empty: true` if that is meant"
            )
        };
        let texts: Vec<String> =
            self.output().map_or_else(Vec::new, |output| output.empty_probes().map(of).collect());
        self.warn_once(texts);
    }

    /// Sensors stay where their walls have been.
    fn warn_of_left_probes(&mut self) {
        let of = |(name, body): (&str, BodyId)| {
            let body = &self.world.body(body).name;
            format!(
                "probe `{name}` stays where it is in space, and `{body}` has moved over it or away from it: it no longer shows what a gauge at `{body}` would; `follows: \"{body}\"` takes it along"
            )
        };
        let texts: Vec<String> =
            self.output().map_or_else(Vec::new, |output| output.left_probes().map(of).collect());
        self.warn_once(texts);
    }

    fn warn_once(&mut self, texts: Vec<String>) {
        for text in texts {
            if !self.warnings.contains(&text) {
                self.warnings.push(text);
            }
        }
    }
}

fn write_summary(file: &Path, summary: &Summary) -> Result<(), RecordError> {
    let write = |w: &mut dyn std::io::Write| {
        serde_json::to_writer_pretty(&mut *w, summary).map_err(std::io::Error::other)?;
        w.write_all(b"\n")
    };
    Ok(write_atomically(file, Existing::Replace, write)?)
}
