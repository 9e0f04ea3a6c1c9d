//! Recordings are written, and read back with rerun's own reader.

use std::collections::BTreeMap;
use std::fs::{self, File};
use std::path::Path;

use meshless_engine::record::{
    BodyFrame, BodyInfo, Existing, FieldValues, Frame, NamedUnit, RecordError, Recorder, RunInfo, Sample,
};
use meshless_engine::scene::Dimension;
use re_chunk_store::{ChunkStore, ChunkStoreConfig};
use rerun::{EntityPath, StoreKind};
use rerun_recorder::{RerunFile, RerunRecorder};
use tempfile::TempDir;

const SCENE: &str = "Scene(title: \"two particles\")";
const UP: [f64; 3] = [0.0, 1.0, 0.0];

fn recorder(settings: RerunRecorder) -> RerunFile {
    RerunFile::new(settings, vec!["von_mises".to_owned()], Vec::new(), UP)
}

fn start(recorder: &mut RerunFile, folder: &Path, resumed: bool) -> Result<(), RecordError> {
    recorder.start(&RunInfo {
        title: "Two particles",
        scene_name: "two",
        scene_text: SCENE,
        dimension: Dimension::Two,
        bodies: &[BodyInfo { name: "left plate/2", radius: 0.5, particles: 2 }],
        fields: &[NamedUnit { name: "von_mises", unit: "Pa" }, NamedUnit { name: "speed", unit: "m/s" }],
        series: &[NamedUnit { name: "energy/kinetic", unit: "J" }],
        references: &["a method: somebody (2001)".to_owned()],
        output: folder,
        existing: Existing::Refuse,
        resumed,
        start_time: if resumed { 0.25 } else { 0.0 },
        end_time: 1.0,
    })
}

fn frame(recorder: &mut RerunFile, step: u64) -> Result<(), RecordError> {
    let time = 0.25 * step as f64;
    let number = step as f64;
    recorder.samples(step, time, &[Sample { name: "energy/kinetic", unit: "J", value: number / 3.0 }])?;
    let fields = [
        FieldValues { name: "von_mises", unit: "Pa", values: &[number / 7.0, f64::NAN] },
        FieldValues { name: "speed", unit: "m/s", values: &[1.0, 2.0] },
    ];
    let positions = [[0.0, 0.0, 0.0], [1.0, number as f32, 0.0]];
    let body = BodyFrame { name: "left plate/2", positions: &positions, radius: 0.5, fields: &fields };
    recorder.frame(&Frame { step, time, bodies: &[body] })?;
    recorder.flush()
}

/// The recording in a file, and the number of layouts in it.
fn read(path: &Path) -> (ChunkStore, usize) {
    let mut file = File::open(path).expect("the file is there");
    let stores: BTreeMap<_, _> =
        ChunkStore::from_rrd_reader(&ChunkStoreConfig::COMPACTION_DISABLED, &mut file)
            .expect("it is readable");
    let (recordings, layouts): (Vec<_>, Vec<_>) =
        stores.into_values().partition(|store| store.id().kind() == StoreKind::Recording);
    (recordings.into_iter().next().expect("a recording"), layouts.len())
}

/// All numbers of a component of an entity in the order of time.
fn numbers(store: &ChunkStore, path: &EntityPath, component: &str) -> Vec<f64> {
    let mut rows = Vec::new();
    for chunk in store.iter_physical_chunks().filter(|chunk| chunk.entity_path() == path) {
        for identifier in chunk.components_identifiers().filter(|name| name.as_str() == component) {
            let steps = chunk.iter_indices(&"step".into()).map(|(time, _)| time.as_i64());
            let values = chunk.iter_slices::<f64>(identifier).map(<[f64]>::to_vec);
            rows.extend(steps.zip(values));
        }
    }
    rows.sort_by_key(|(step, _)| *step);
    rows.into_iter().flat_map(|(_, values)| values).collect()
}

fn entity(parts: &[&str]) -> EntityPath {
    EntityPath::new(parts.iter().map(|part| rerun::EntityPathPart::new(*part)).collect())
}

fn ends_with_footer(path: &Path) -> bool {
    let bytes = fs::read(path).expect("the file is there");
    assert_eq!(&bytes[..4], b"RRF2");
    bytes[bytes.len().saturating_sub(64)..].windows(4).any(|word| word == b"FOOT")
}

#[test]
fn what_is_recorded_can_be_read_back() {
    let folder = TempDir::new().expect("a temporary folder");
    let mut recorder = recorder(RerunRecorder::default());
    assert_eq!(recorder.files("two"), ["two.rrd"]);
    start(&mut recorder, folder.path(), false).expect("it starts");
    (0..4).for_each(|step| frame(&mut recorder, step).expect("it is written"));
    recorder.finish(&[]).expect("it ends");
    let path = folder.path().join("two.rrd");
    assert!(ends_with_footer(&path));
    let (store, layouts) = read(&path);
    assert!(layouts >= 1);
    let body = ["bodies", "left plate/2"];
    let points = store.iter_physical_chunks().filter(|chunk| *chunk.entity_path() == entity(&body));
    assert_eq!(points.map(|chunk| chunk.num_rows()).sum::<usize>(), 4);
    let kinetic = numbers(&store, &entity(&["energy", "kinetic"]), "Scalars:scalars");
    assert_eq!(kinetic, [0.0, 1.0 / 3.0, 2.0 / 3.0, 1.0]);
    let stress = numbers(&store, &entity(&[body[0], body[1], "von_mises"]), "Scalars:scalars");
    assert_eq!(stress.len(), 8);
    assert_eq!(stress[6].to_bits(), (3.0f64 / 7.0).to_bits());
    assert!(stress[7].is_nan());
    let speed = entity(&[body[0], body[1], "speed"]);
    assert!(store.iter_physical_chunks().all(|chunk| *chunk.entity_path() != speed), "nobody asked for it");
}

/// Number of colours of the particles in each frame.
fn colors(grey: Vec<String>) -> Vec<usize> {
    let folder = TempDir::new().expect("a temporary folder");
    let mut recorder = RerunFile::new(RerunRecorder::default(), vec!["von_mises".to_owned()], grey, UP);
    start(&mut recorder, folder.path(), false).expect("it starts");
    (0..2).for_each(|step| frame(&mut recorder, step).expect("it is written"));
    recorder.finish(&[]).expect("it ends");
    let (store, _) = read(&folder.path().join("two.rrd"));
    let body = entity(&["bodies", "left plate/2"]);
    let chunks = store.iter_physical_chunks().filter(|chunk| *chunk.entity_path() == body);
    chunks
        .flat_map(|chunk| {
            chunk.iter_slices::<u32>("Points3D:colors".into()).map(<[u32]>::len).collect::<Vec<_>>()
        })
        .collect()
}

#[test]
fn particles_have_a_colour_each_and_those_of_a_grey_body_have_one() {
    assert_eq!(colors(Vec::new()), [2, 2]);
    assert_eq!(colors(vec!["left plate/2".to_owned()]), [1, 1]);
}

#[test]
fn a_recording_that_is_cut_short_is_readable_and_one_that_is_dropped_is_complete() {
    let folder = TempDir::new().expect("a temporary folder");
    let path = folder.path().join("two.rrd");
    let mut recorder = recorder(RerunRecorder::default());
    start(&mut recorder, folder.path(), false).expect("it starts");
    (0..3).for_each(|step| frame(&mut recorder, step).expect("it is written"));
    // What a killed program leaves is what is in the file now.
    let cut = folder.path().join("cut.rrd");
    fs::copy(&path, &cut).expect("a copy");
    let kinetic = numbers(&read(&cut).0, &entity(&["energy", "kinetic"]), "Scalars:scalars");
    assert_eq!(kinetic, [0.0, 1.0 / 3.0, 2.0 / 3.0]);
    drop(recorder);
    assert!(ends_with_footer(&path));
}

#[test]
fn a_resumed_run_has_a_file_of_its_own() {
    let folder = TempDir::new().expect("a temporary folder");
    for _ in 0..2 {
        let mut recorder = recorder(RerunRecorder::default());
        start(&mut recorder, folder.path(), true).expect("it starts");
        frame(&mut recorder, 1).expect("it is written");
        recorder.finish(&[]).expect("it ends");
    }
    assert!(ends_with_footer(&folder.path().join("two-from-0.25s.rrd")));
    assert!(!folder.path().join("two.rrd").exists());
}

#[test]
fn what_cannot_be_written_is_an_error() {
    let folder = TempDir::new().expect("a temporary folder");
    let message = |result: Result<(), RecordError>| result.expect_err("it fails").to_string();
    assert!(message(frame(&mut recorder(RerunRecorder::default()), 0)).contains("not open"));
    let missing = folder.path().join("missing");
    assert!(message(start(&mut recorder(RerunRecorder::default()), &missing, false)).contains("missing"));
    fs::write(folder.path().join("two.rrd"), "precious").expect("a file");
    assert!(message(start(&mut recorder(RerunRecorder::default()), folder.path(), false)).contains("exists"));
    assert_eq!(fs::read(folder.path().join("two.rrd")).expect("it is there"), b"precious");
    let nobody = RerunRecorder { connect: Some("127.0.0.1:9".to_owned()), ..RerunRecorder::default() };
    let other = TempDir::new().expect("a temporary folder");
    assert!(message(start(&mut recorder(nobody), other.path(), false)).contains("no viewer answers"));
    assert!(!other.path().join("two.rrd").exists());
}
