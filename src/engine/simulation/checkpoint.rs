//! Saving and restoring the whole state, bit for bit.
//!
//! Every column has a section of its own; clock, ledger, next limit, states of systems and the scene are in
//! one header section. Lists and packed rows are not saved: they are rebuilt from the columns.

use std::path::{Path, PathBuf};

use serde::{Deserialize, Serialize};
use thiserror::Error;

use super::Simulation;
use super::inputs::Inputs;
use super::sub_steps::SubStepState;
use crate::parallel::{have_same_bits, instruction_path};
use crate::ranks;
use crate::record::output::OUTPUT;
use crate::record::{
    Container, ContainerError, ContainerWriter, Existing, RecordError, StateHash, StateHasher,
};
use crate::scene::Source;
use crate::schedule::{Clock, Ledger, Limit, TimeStepLimits};
use crate::world::{ColumnInfo, PhaseView};

const STATE: &str = "state";
/// Section of the inputs; checkpoints of earlier versions have none.
const INPUTS: &str = "inputs";

/// Everything that is not in a column.
#[derive(Serialize, Deserialize)]
struct CheckpointHeader {
    scene_name: String,
    scene_text: String,
    instruction_path: String,
    clock: Clock,
    ledger: Ledger,
    next_limit: Option<Limit>,
    limits: TimeStepLimits,
    sub_steps: SubStepState,
    warnings: Vec<String>,
    systems: Vec<(String, Vec<u8>)>,
}

/// Error of restoring a checkpoint.
#[derive(Debug, Error)]
pub enum RestoreError {
    /// The file is missing, damaged, or of another version.
    #[error(transparent)]
    Container(#[from] ContainerError),
    /// The files of the interrupted run cannot be continued.
    #[error(transparent)]
    Record(#[from] RecordError),
    /// The file is whole, but it is not the checkpoint of a simulation.
    #[error("{0}")]
    Content(String),
}

/// Why a checkpoint cannot be written.
#[derive(Debug, Error)]
pub enum SaveError {
    /// The file cannot be written.
    #[error(transparent)]
    Container(#[from] ContainerError),
    /// The other files of the run, which the checkpoint speaks of, cannot be written.
    #[error(transparent)]
    Record(#[from] RecordError),
}

/// A checkpoint that has been read and checked.
pub struct Checkpoint {
    container: Container,
    header: CheckpointHeader,
    inputs: Inputs,
    path: PathBuf,
}

impl Checkpoint {
    /// Reads a checkpoint.
    pub fn read(path: &Path) -> Result<Self, RestoreError> {
        let container = Container::read(path)?;
        let section = container.section(STATE).ok_or_else(|| content("it holds no simulation state"))?;
        let header = postcard::from_bytes(&section.bytes).map_err(|error| content(error.to_string()))?;
        let inputs = container.section(INPUTS).map(|section| postcard::from_bytes(&section.bytes));
        let inputs = inputs.transpose().map_err(|error| content(error.to_string()))?.unwrap_or_default();
        Ok(Self { container, header, inputs, path: path.to_path_buf() })
    }

    /// The scene that the run was started with. Files that it names are relative to where the scene lies now:
    /// seen from the checkpoint as before, or else at its former place.
    pub fn source(&self) -> Source {
        let folder = self.path.parent().unwrap_or(Path::new(""));
        let moved = self.inputs.scene_in(folder).and_then(|path| std::path::absolute(path).ok());
        let name = moved.map_or_else(|| self.header.scene_name.clone(), |path| path.display().to_string());
        Source::new(name, self.header.scene_text.clone())
    }

    /// Time and step of the checkpoint.
    pub fn clock(&self) -> Clock {
        self.header.clock
    }

    /// A warning where the scene file, which now lies at `path`, is not the one that the run began with.
    pub fn scene_warning(&self, path: &Path) -> Option<String> {
        self.inputs.is_another_scene(path).then(|| {
            format!(
                "`{}` is not the scene file that the run began with: the run goes on with the scene in the checkpoint; replace values with `--set`",
                path.display()
            )
        })
    }

    /// A warning where the run was carried out on another instruction path, so that the last bits will
    /// differ.
    pub fn path_warning(&self) -> Option<String> {
        let (then, now) = (self.header.instruction_path.as_str(), instruction_path());
        (!have_same_bits(then, now)).then(|| {
            format!("the checkpoint was written on the instruction path {then}, this machine uses {now}: the last bits will differ")
        })
    }
}

fn content(message: impl Into<String>) -> RestoreError {
    RestoreError::Content(message.into())
}

impl Simulation {
    /// Writes a checkpoint, in one piece or not at all; `source` is the scene that the simulation was built
    /// from.
    pub fn save(&self, path: &Path, source: &Source) -> Result<(), SaveError> {
        // The state of the output speaks of bytes that must be there.
        if let Some(mut output) = self.output() {
            output.sync()?;
        }
        let header = CheckpointHeader {
            scene_name: source.name.clone(),
            scene_text: source.text.clone(),
            instruction_path: instruction_path().to_owned(),
            clock: self.clock,
            ledger: self.ledger.clone(),
            next_limit: self.next_limit.clone(),
            limits: self.limits.clone(),
            sub_steps: self.sub_steps.state.clone(),
            warnings: self.warnings.clone(),
            systems: self.schedule.save(&self.resources),
        };
        let bytes = postcard::to_stdvec(&header).unwrap_or_default();
        let inputs = postcard::to_stdvec(&self.inputs.beside(path, &source.name)).unwrap_or_default();
        let columns = all_columns(self);
        with_columns(&columns, None, &|last| -> Result<(), ContainerError> {
            // Every rank has taken part in the exchange of the columns; one writes them.
            if !ranks::is_first() {
                return Ok(());
            }
            let mut writer = ContainerWriter::new();
            writer.section(STATE, "header", 1, &bytes)?;
            writer.section(INPUTS, "inputs", 1, &inputs)?;
            let mut next = last;
            while let Some(Held { column, bytes, before }) = next {
                writer.section(&column.path, column.info.unit, column.info.element_size, bytes)?;
                next = *before;
            }
            writer.write(path, Existing::Replace)
        })?;
        Ok(())
    }

    /// Restores the state of a checkpoint of the same scene, and continues the files of the run, if it writes
    /// any. An error if scene or columns differ, or if a file cannot be continued.
    pub fn restore(&mut self, checkpoint: &Checkpoint) -> Result<(), RestoreError> {
        let CheckpointHeader { clock, ledger, next_limit, limits, sub_steps, warnings, systems, .. } =
            &checkpoint.header;
        if let Some(file) = self.inputs.changed_since(&checkpoint.inputs) {
            return Err(content(format!(
                "`{file}` has changed since the run began: the rest would have other physics; put the former file back"
            )));
        }
        for phase in self.world.phases() {
            let view = self.world.phase(phase);
            for column in view.columns().iter() {
                let name = format!("{}/{}", view.name(), column.name);
                let section = checkpoint.container.section(&name);
                let section = section.ok_or_else(|| content(format!("column `{name}` is missing")))?;
                let mut fits = false;
                view.write_bytes(column, &mut |bytes| {
                    fits = bytes.len() == section.bytes.len();
                    if fits {
                        bytes.copy_from_slice(&section.bytes);
                    }
                });
                if !fits {
                    let message =
                        "has a different number of particles; has the scene or one of its files changed?";
                    return Err(content(format!("column `{name}` {message}")));
                }
            }
        }
        for (label, state) in systems {
            let writes_nothing = label == OUTPUT && self.output.is_none();
            if !writes_nothing && !self.schedule.restore(label, state, &self.resources) {
                return Err(content(format!("the state of system `{label}` does not fit")));
            }
        }
        self.inputs.begin_like(&checkpoint.inputs);
        self.clock = *clock;
        self.ledger = ledger.clone();
        self.next_limit = next_limit.clone();
        self.limits = limits.clone();
        self.sub_steps.state = sub_steps.clone();
        self.warnings = warnings.clone();
        self.started = true;
        self.pace.begin(self.clock.step);
        if let Some(mut output) = self.output() {
            output.open(&self.world, &self.ledger, self.clock)?;
        }
        Ok(())
    }
}

/// A column of a phase.
struct PhaseColumn<'a> {
    /// `phase/column`.
    path: String,
    view: PhaseView<'a>,
    info: &'a ColumnInfo,
}

/// A column that is borrowed, and those borrowed before it.
struct Held<'h> {
    column: &'h PhaseColumn<'h>,
    bytes: &'h [u8],
    before: Option<&'h Held<'h>>,
}

fn all_columns(sim: &Simulation) -> Vec<PhaseColumn<'_>> {
    let views = sim.world.phases().map(|phase| sim.world.phase(phase));
    let columns = views.flat_map(|view| view.columns().iter().map(move |info| (view, info)));
    columns
        .map(|(view, info)| PhaseColumn { path: format!("{}/{}", view.name(), info.name), view, info })
        .collect()
}

/// Borrows all columns at once, and calls `f` with the last of the chain.
fn with_columns<R>(
    columns: &[PhaseColumn<'_>],
    before: Option<&Held<'_>>,
    f: &dyn Fn(Option<&Held<'_>>) -> R,
) -> R {
    let Some((column, rest)) = columns.split_first() else { return f(before) };
    let mut result = None;
    column.view.read_bytes(column.info, &mut |bytes| {
        result = Some(with_columns(rest, Some(&Held { column, bytes, before }), f));
    });
    result.unwrap_or_else(|| f(before))
}

/// Hash of all columns and of the clock.
pub(super) fn state_hash(sim: &Simulation) -> StateHash {
    let mut hasher = StateHasher::new();
    for column in all_columns(sim) {
        column.view.read_bytes(column.info, &mut |bytes| {
            hasher.section(&column.path, bytes);
        });
    }
    hasher.section("clock", &[sim.clock.time.to_bits(), sim.clock.dt.to_bits(), sim.clock.step]);
    hasher.finish()
}
