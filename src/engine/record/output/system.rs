//! The system of the output, which the simulation reaches by its place among what systems share.

use super::due::Output;
use crate::schedule::{Mode, Resources, Run, Shared, Stage, Step, StepError, System};

/// Label of the system that writes, at the end of every step.
pub const OUTPUT: &str = "output";

struct OutputSystem(Shared<Output>);

impl Run for OutputSystem {
    fn run(&mut self, step: &mut Step<'_>) -> Result<(), StepError> {
        let resources = step.resources;
        resources.of_mut(self.0).record(step)
    }

    fn save_with(&self, resources: &Resources) -> Vec<u8> {
        resources.of(self.0).save()
    }

    fn restore_with(&mut self, state: &[u8], resources: &Resources) -> bool {
        resources.of_mut(self.0).restore(state)
    }
}

/// The system, which reads the columns of that name.
pub(super) fn output_system(output: Shared<Output>, columns: &[&'static str]) -> System {
    let system = System::new(Stage::Record, OUTPUT, OutputSystem(output)).reads_all();
    columns.iter().fold(system, |system, column| system.touches(column, Mode::Reads))
}
