//! Recorders of several ranks: the first one writes, the others compute with it what is recorded.

use crate::ranks;
use crate::record::{Frame, RecordError, Recorder, RunInfo, Sample};

/// The recorder on the first rank; on the others one that asks for the same fields and writes nothing.
pub(super) fn of_this_rank(recorder: Box<dyn Recorder>) -> Box<dyn Recorder> {
    if ranks::is_first() { recorder } else { Box::new(Silent(recorder.fields())) }
}

/// A recorder that asks for these fields.
struct Silent(Vec<String>);

impl Recorder for Silent {
    fn fields(&self) -> Vec<String> {
        self.0.clone()
    }

    fn start(&mut self, _: &RunInfo<'_>) -> Result<(), RecordError> {
        Ok(())
    }

    fn frame(&mut self, _: &Frame<'_>) -> Result<(), RecordError> {
        Ok(())
    }

    fn samples(&mut self, _: u64, _: f64, _: &[Sample<'_>]) -> Result<(), RecordError> {
        Ok(())
    }

    fn flush(&mut self) -> Result<(), RecordError> {
        Ok(())
    }

    fn finish(&mut self, _: &[String]) -> Result<(), RecordError> {
        Ok(())
    }
}
