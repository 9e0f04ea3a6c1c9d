//! Calls of recorders, and their order.

use std::sync::{Arc, Mutex};

use schemars::JsonSchema;
use serde::Deserialize;

use super::*;
use crate::plugin::{Plugin, SetupError, SimBuilder};
use crate::record::{Frame, RecordError, Recorder, RunInfo, Sample};

/// What a recorder was told.
static TOLD: Mutex<Vec<String>> = Mutex::new(Vec::new());

#[derive(Clone, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
struct Listener {
    field: String,
}

impl Plugin for Listener {
    const NAME: &'static str = "listener";
    const REFERENCE: &'static str = "";

    fn build(self, sim: &mut SimBuilder<'_>) -> Result<(), SetupError> {
        sim.add_recorder(Ear { field: self.field, told: Arc::default() });
        Ok(())
    }
}

struct Ear {
    field: String,
    told: Arc<Mutex<Vec<String>>>,
}

impl Ear {
    fn note(&self, text: String) -> Result<(), RecordError> {
        self.told.lock().unwrap().push(text);
        Ok(())
    }
}

impl Recorder for Ear {
    fn fields(&self) -> Vec<String> {
        vec![self.field.clone()]
    }

    fn files(&self, scene_name: &str) -> Vec<String> {
        vec![format!("{scene_name}.told")]
    }

    fn start(&mut self, run: &RunInfo<'_>) -> Result<(), RecordError> {
        let names = |list: &[crate::record::NamedUnit<'_>]| {
            list.iter().map(|n| format!("{}[{}]", n.name, n.unit)).collect::<Vec<_>>().join(" ")
        };
        self.note(format!("start {} {} {}", run.scene_name, run.resumed, run.start_time))?;
        self.note(format!("fields {}", names(run.fields)))?;
        self.note(format!("series {}", names(run.series)))
    }

    fn frame(&mut self, frame: &Frame<'_>) -> Result<(), RecordError> {
        let body = &frame.bodies[0];
        let speed = body.fields.iter().find(|field| field.name == "velocity").unwrap();
        let fastest = speed.values.iter().copied().fold(0.0, f64::max);
        assert!(body.fields.iter().all(|field| field.values.len() == body.positions.len()));
        assert!(fastest >= 0.0 && (fastest > 0.0) == (frame.step > 0));
        self.note(format!("frame {} {} {} {}", frame.step, body.name, body.positions.len(), body.radius))
    }

    fn samples(&mut self, step: u64, _: f64, samples: &[Sample<'_>]) -> Result<(), RecordError> {
        let names: Vec<&str> = samples.iter().map(|sample| sample.name).collect();
        self.note(format!("samples {step} {}", names.join(" ")))
    }

    fn flush(&mut self) -> Result<(), RecordError> {
        self.note("flush".into())
    }

    fn finish(&mut self, warnings: &[String]) -> Result<(), RecordError> {
        self.note(format!("finish {}", warnings.len()))?;
        TOLD.lock().unwrap().append(&mut self.told.lock().unwrap());
        Ok(())
    }
}

fn with_listener(field: &str) -> (Scene, Source) {
    cantilever(|t| t.replace("time: (", &format!("plugins: [listener(field: \"{field}\")],\n    time: (")))
}

fn registry() -> Registry {
    Registry::standard().with(|registry| {
        registry.plugin::<Listener>();
    })
}

#[test]
fn a_recorder_hears_all_in_order() {
    let folder = tempfile::tempdir().unwrap();
    let (scene, source) = with_listener("pressure");
    let built = build_with(&scene, &source, &registry(), &BuildOptions::into_folder(folder.path()));
    let sim = run(built.unwrap());
    // The beam has no hourglass control.
    let warnings = sim.warnings();
    assert!(matches!(warnings, [text] if text.contains("hourglass modes")), "{warnings:?}");
    let told = std::mem::take(&mut *TOLD.lock().unwrap());
    assert_eq!(told[0], "start cantilever false 0");
    assert_eq!(told[1], "fields von_mises[Pa] velocity[m/s] pressure[Pa]");
    let series = "series energy/strain[J] energy/kinetic[J] energy/constraints[J] energy/beam/strain[J]";
    assert!(told[2].starts_with(series), "{}", told[2]);
    assert!(told[2].contains("probe/tip/x[m] probe/tip/y[m] probe/support/x[N]"), "{}", told[2]);
    assert!(told[2].contains("probe/middle/stress.xx[Pa] probe/energies/strain[J]"), "{}", told[2]);
    let frames: Vec<&str> =
        told.iter().filter(|t| t.starts_with("frame")).map(|t| t.split(' ').nth(1).unwrap()).collect();
    assert_eq!(frames, ["0", "40", "80", "120", "160", "200"]);
    assert!(told.contains(&"frame 40 beam 24 0.005".to_owned()));
    // The tip alone has an interval of its own, 0.001 s; all others have 0.0004 s.
    assert!(told.iter().any(|t| t.starts_with("samples 10 probe/tip/x probe/tip/y")));
    let flushed = told.windows(2).filter(|w| w[0].starts_with("frame") && w[1] == "flush").count();
    assert_eq!(flushed, 6);
    assert_eq!(told.last().unwrap(), "finish 1");
}

#[test]
fn what_a_recorder_lacks_is_told_at_its_plugin() {
    let (scene, source) = with_listener("presure");
    let error = build_with(&scene, &source, &registry(), &BuildOptions::default()).map(|_| ()).unwrap_err();
    let text = error.to_string();
    assert!(text.contains("unknown field `presure`") && text.contains("did you mean `pressure`?"), "{text}");
    assert!(text.contains("plugins: [listener") && text.contains("^^^^^^^^"), "{text}");
}

#[test]
fn files_of_recorders_are_not_overwritten() {
    let folder = tempfile::tempdir().unwrap();
    fs::write(folder.path().join("cantilever.told"), "mine").unwrap();
    let (scene, source) = with_listener("pressure");
    let error = build_with(&scene, &source, &registry(), &BuildOptions::into_folder(folder.path()));
    let text = error.map(|_| ()).unwrap_err().to_string();
    assert!(text.contains("cantilever.told` already exists"), "{text}");
}
