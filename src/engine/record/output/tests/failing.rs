//! Recorders that can no longer write.

use schemars::JsonSchema;
use serde::Deserialize;

use super::*;
use crate::plugin::{Plugin, SetupError, SimBuilder};
use crate::record::{Frame, RecordError, Recorder, RunInfo, Sample};
use crate::simulation::Checkpoint;

/// Adds a recorder whose disk is full from the second flush on.
#[derive(Clone, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
struct FullDisk {}

impl Plugin for FullDisk {
    const NAME: &'static str = "full_disk";
    const REFERENCE: &'static str = "";

    fn build(self, sim: &mut SimBuilder<'_>) -> Result<(), SetupError> {
        sim.add_recorder(Full { flushes: 0 });
        Ok(())
    }
}

struct Full {
    flushes: usize,
}

impl Recorder for Full {
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
        self.flushes += 1;
        match self.flushes {
            1 => Ok(()),
            _ => Err(RecordError::Recorder { recorder: "full_disk".into(), message: "no space left".into() }),
        }
    }

    fn finish(&mut self, _: &[String]) -> Result<(), RecordError> {
        self.flush()
    }
}

#[test]
fn a_recorder_that_fails_does_not_take_the_state_along() {
    let folder = tempfile::tempdir().unwrap();
    let (scene, source) = cantilever(|t| t.replace("time: (", "plugins: [full_disk()],\n    time: ("));
    let registry = Registry::standard().with(|registry| {
        registry.plugin::<FullDisk>();
    });
    let mut sim = build_with(&scene, &source, &registry, &BuildOptions::into_folder(folder.path())).unwrap();
    sim.run(|sim| sim.clock().step < 20).unwrap();
    let error = sim.finish().unwrap_err().to_string();
    assert!(error.contains("no space left"), "{error}");
    let checkpoint = Checkpoint::read(&folder.path().join("checkpoint.mlc")).unwrap();
    assert_eq!(checkpoint.clock().step, 20);
    assert!(folder.path().join("summary.json").is_file());
    // A state that is saved beside the recording asks no recorder at all.
    sim.save(&folder.path().join("failed.mlc"), &source).unwrap();
}
