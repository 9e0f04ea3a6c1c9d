//! Writes what is due: samples, frames, and the notice that a checkpoint is due.

use std::path::PathBuf;

use serde::{Deserialize, Serialize};

use super::folder::{CHECKPOINT, OutputFolder, SUMMARY};
use super::frames::{Frames, FramesState};
use super::table::Extreme;
use super::track::{OwnedSample, Track, TrackState, failed};
use crate::record::{BodyInfo, NamedUnit, RecordError, Recorder, RunInfo, Sample, WriteError};
use crate::scene::Problem;
use crate::schedule::Trigger;
use crate::schedule::{Clock, Ledger, Step, StepError};
use crate::world::{BodyId, World};

/// Facts of the scene for recordings.
pub(super) struct SceneInfo {
    pub title: String,
    pub name: String,
    pub text: String,
}

/// Progress of the output.
enum Progress {
    /// No file is open.
    Closed,
    /// The run goes on from this state, and no file is open yet.
    Resuming(Box<OutputState>),
    /// Files are open.
    Open,
    /// Everything is written.
    Finished,
}

/// Everything that a run writes.
pub struct Output {
    scene: SceneInfo,
    folder: OutputFolder,
    references: Vec<String>,
    tracks: Vec<Track>,
    frames: Frames,
    recorders: Vec<Box<dyn Recorder>>,
    end: f64,
    checkpoint: Option<Trigger>,
    checkpoint_due: bool,
    progress: Progress,
}

/// Parts of an output.
pub(super) struct OutputParts {
    pub scene: SceneInfo,
    pub folder: OutputFolder,
    pub tracks: Vec<Track>,
    pub frames: Frames,
    pub recorders: Vec<Box<dyn Recorder>>,
    /// End of the run, s.
    pub end: f64,
    /// Interval of checkpoints, s.
    pub checkpoint_every: Option<f64>,
}

/// State of the output in a checkpoint.
#[derive(Serialize, Deserialize)]
struct OutputState {
    tracks: Vec<(String, TrackState)>,
    frames: FramesState,
    checkpoint: Option<Trigger>,
}

impl Output {
    pub(super) fn new(parts: OutputParts) -> Self {
        let OutputParts { scene, folder, tracks, frames, recorders, end, checkpoint_every } = parts;
        Self {
            scene,
            folder,
            references: Vec::new(),
            tracks,
            frames,
            recorders,
            end,
            checkpoint: checkpoint_every.map(Trigger::after_interval),
            checkpoint_due: false,
            progress: Progress::Closed,
        }
    }

    /// Makes the folder, before any work, and makes sure that the run can write there; `references` are the
    /// sources of the methods in use.
    ///
    /// # Errors
    /// A file of an earlier run is there and may not be replaced, or nothing can be written.
    pub fn prepare(&mut self, references: &[String]) -> Result<(), Box<Problem>> {
        self.references = references.to_vec();
        let mut names: Vec<String> = self.tracks.iter().map(|track| file_name(&track.table.path)).collect();
        for recorder in &self.recorders {
            names.extend(recorder.files(&self.scene.name));
        }
        self.folder.prepare(&names)
    }

    /// Opens all files, new ones or those of the resumed run; does nothing if they are open.
    ///
    /// # Errors
    /// A file cannot be written or continued.
    pub fn open(&mut self, world: &World, ledger: &Ledger, clock: Clock) -> Result<(), RecordError> {
        let state = match std::mem::replace(&mut self.progress, Progress::Open) {
            Progress::Closed => None,
            Progress::Resuming(state) => Some(*state),
            done @ (Progress::Open | Progress::Finished) => {
                self.progress = done;
                return Ok(());
            }
        };
        let path = &self.folder.path;
        let cleared = match state.is_none() && !self.folder.resume {
            true => self.folder.clear(),
            false => self.folder.clear_temporaries(),
        };
        cleared.map_err(|error| WriteError::new(path, error))?;
        let resumed = state.is_some();
        let (mut tracks, frames) = match state {
            Some(state) => {
                if let (Some(trigger), Some(saved)) = (&mut self.checkpoint, state.checkpoint) {
                    trigger.resume(saved);
                }
                (state.tracks, Some(state.frames))
            }
            None => (Vec::new(), None),
        };
        for track in &mut self.tracks {
            let found = tracks.iter().position(|(name, _)| *name == track.path);
            track.open(&self.folder, found.map(|k| tracks.swap_remove(k).1))?;
        }
        self.frames.open(&self.folder, frames)?;
        self.start_recorders(world, ledger, clock, resumed)
    }

    fn start_recorders(
        &mut self,
        world: &World,
        ledger: &Ledger,
        clock: Clock,
        resumed: bool,
    ) -> Result<(), RecordError> {
        let bodies = world.bodies().iter().map(|body| BodyInfo {
            name: &body.name,
            radius: (0.5 * body.spacing) as f32,
            particles: body.rows.len(),
        });
        let bodies: Vec<BodyInfo<'_>> = bodies.collect();
        let series: Vec<_> = self.tracks.iter().flat_map(|track| track.series(ledger)).collect();
        let series: Vec<NamedUnit<'_>> = series.iter().map(|(name, unit)| NamedUnit { name, unit }).collect();
        let run = RunInfo {
            title: &self.scene.title,
            scene_name: &self.scene.name,
            scene_text: &self.scene.text,
            dimension: world.dimension(),
            bodies: &bodies,
            fields: &self.frames.named(),
            series: &series,
            references: &self.references,
            output: &self.folder.path,
            existing: self.folder.existing,
            resumed,
            start_time: clock.time,
            end_time: self.end,
        };
        self.recorders.iter_mut().try_for_each(|recorder| recorder.start(&run))
    }

    /// Writes the output that is due after a step.
    ///
    /// # Errors
    /// Something cannot be written.
    pub(super) fn record(&mut self, step: &mut Step<'_>) -> Result<(), StepError> {
        self.open(step.world, step.ledger, step.clock).map_err(failed)?;
        let at_end = step.clock.time >= self.end || step.stop.is_some();
        let mut samples: Vec<OwnedSample> = Vec::new();
        for track in &mut self.tracks {
            track.record(step, at_end, &self.folder, &mut samples)?;
        }
        self.warn_of_late_accounts(step);
        if !samples.is_empty() {
            let samples = samples.iter().map(|(name, unit, value)| Sample { name, unit, value: *value });
            let samples: Vec<Sample<'_>> = samples.collect();
            let Clock { time, step, .. } = step.clock;
            let mut recorders = self.recorders.iter_mut();
            recorders.try_for_each(|recorder| recorder.samples(step, time, &samples)).map_err(failed)?;
        }
        if self.frames.record(step, at_end, &mut self.recorders)? {
            self.flush().map_err(failed)?;
        }
        if let Some(trigger) = &mut self.checkpoint {
            self.checkpoint_due |= trigger.is_due(step.clock.time);
        }
        Ok(())
    }

    fn warn_of_late_accounts(&self, step: &mut Step<'_>) {
        for account in self.tracks.iter().take(1).flat_map(|track| track.lacking(step.ledger)) {
            let text = format!(
                "the energy account `{account}` was opened after the first step and has no column in `energy.csv`"
            );
            if !step.warnings.contains(&text) {
                step.warnings.push(text);
            }
        }
    }

    /// Makes all that is written readable even if the program is killed now.
    ///
    /// # Errors
    /// Something cannot be written.
    pub fn flush(&mut self) -> Result<(), RecordError> {
        for track in &mut self.tracks {
            track.table.flush()?;
        }
        self.recorders.iter_mut().try_for_each(|recorder| recorder.flush())
    }

    /// Forces all series to the disk: a checkpoint speaks of their lengths. Recorders have no part in that,
    /// so that one which fails does not take the checkpoint with it.
    ///
    /// # Errors
    /// A series cannot be written.
    pub fn sync(&mut self) -> Result<(), RecordError> {
        if matches!(self.progress, Progress::Open) {
            for track in &mut self.tracks {
                track.table.sync()?;
            }
        }
        Ok(())
    }

    /// Makes readable what recorders have written.
    ///
    /// # Errors
    /// A recorder failed.
    pub fn flush_recorders(&mut self) -> Result<(), RecordError> {
        if matches!(self.progress, Progress::Open) {
            self.recorders.iter_mut().try_for_each(|recorder| recorder.flush())?;
        }
        Ok(())
    }

    /// Whether a checkpoint has fallen due since this was asked last.
    pub fn take_checkpoint_due(&mut self) -> bool {
        std::mem::take(&mut self.checkpoint_due)
    }

    /// Closes everything. A second call does nothing.
    ///
    /// # Errors
    /// Something cannot be written.
    pub fn finish(&mut self, warnings: &[String]) -> Result<(), RecordError> {
        if !matches!(self.progress, Progress::Open) {
            return Ok(());
        }
        self.progress = Progress::Finished;
        let flushed = self.flush();
        // A recorder that fails does not keep the others from their end.
        let ends: Vec<_> = self.recorders.iter_mut().map(|recorder| recorder.finish(warnings)).collect();
        flushed.and(ends.into_iter().collect())
    }

    /// File of the last checkpoint.
    pub fn checkpoint_file(&self) -> PathBuf {
        self.folder.file(CHECKPOINT)
    }

    /// File of the summary.
    pub fn summary_file(&self) -> PathBuf {
        self.folder.file(SUMMARY)
    }

    /// Minimum, maximum and last values of every probe, by the names of the probes.
    pub fn extremes(&self) -> impl Iterator<Item = (&str, &[Extreme])> {
        self.tracks.iter().skip(1).map(|track| (track.name.as_str(), track.table.extremes.as_slice()))
    }

    /// Names of the probes that have found nothing in any sample, though the scene does not say that they
    /// may.
    pub fn empty_probes(&self) -> impl Iterator<Item = &str> {
        self.tracks.iter().skip(1).filter(|track| track.has_found_nothing()).map(|track| track.name.as_str())
    }

    /// Names of the probes that lay in a wall or body which has moved away from them, and these bodies.
    pub fn left_probes(&self) -> impl Iterator<Item = (&str, BodyId)> {
        self.tracks.iter().skip(1).filter_map(|track| Some((track.name.as_str(), track.left_by()?)))
    }

    /// Whether files are open or have been.
    pub fn has_begun(&self) -> bool {
        matches!(self.progress, Progress::Open | Progress::Finished)
    }

    pub(super) fn save(&self) -> Vec<u8> {
        if !self.has_begun() {
            return Vec::new();
        }
        let tracks = self.tracks.iter().map(|track| (track.path.clone(), track.state())).collect();
        let state = OutputState { tracks, frames: self.frames.state(), checkpoint: self.checkpoint };
        postcard::to_stdvec(&state).unwrap_or_default()
    }

    pub(super) fn restore(&mut self, bytes: &[u8]) -> bool {
        let state = postcard::from_bytes(bytes);
        let fits = state.is_ok();
        if let Ok(state) = state {
            self.progress = Progress::Resuming(Box::new(state));
        }
        fits
    }
}

fn file_name(path: &std::path::Path) -> String {
    path.file_name().unwrap_or_default().to_string_lossy().into_owned()
}
