//! The system of the output, and the handle by which the simulation reaches what it writes.

use std::sync::{Arc, Mutex, MutexGuard, PoisonError};

use super::due::Output;
use crate::schedule::{Mode, Run, Stage, Step, StepError, System};

/// Label of the system that writes, at the end of every step.
pub const OUTPUT: &str = "output";

/// The output, shared by its system and the simulation; only one of them runs at a time.
#[derive(Clone)]
pub struct OutputHandle(Arc<Mutex<Output>>);

impl OutputHandle {
    pub(super) fn new(output: Output) -> Self {
        Self(Arc::new(Mutex::new(output)))
    }

    /// The output.
    pub fn lock(&self) -> MutexGuard<'_, Output> {
        self.0.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

struct OutputSystem(OutputHandle);

impl Run for OutputSystem {
    fn run(&mut self, step: &mut Step<'_>) -> Result<(), StepError> {
        self.0.lock().record(step)
    }

    fn save(&self) -> Vec<u8> {
        self.0.lock().save()
    }

    fn restore(&mut self, state: &[u8]) -> bool {
        self.0.lock().restore(state)
    }
}

/// The system, which reads the columns of that name.
pub(super) fn output_system(handle: &OutputHandle, columns: &[&'static str]) -> System {
    let system = System::new(Stage::Record, OUTPUT, OutputSystem(handle.clone()));
    columns.iter().fold(system, |system, column| system.touches(column, Mode::Reads))
}
