//! The program as its users call it.

mod program;

use std::io::{BufRead, BufReader, Read, Write};
use std::net::TcpStream;
use std::path::{Path, PathBuf};
use std::process::{Command, Output, Stdio};

use program::{assert_success, command, err, meshless, out};
use tempfile::TempDir;

fn scene(name: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("assets/scenes").join(name)
}

fn cantilever() -> String {
    scene("cantilever.ron").display().to_string()
}

fn folder() -> TempDir {
    tempfile::tempdir().expect("a temporary folder")
}

/// The line of the summary that tells the state.
fn state_hash(output: &Output) -> String {
    let text = out(output);
    let line = text.lines().find(|line| line.starts_with("state hash")).expect("the summary tells the state");
    line.to_owned()
}

#[test]
fn a_run_ends_with_a_summary_and_leaves_a_checkpoint_if_it_is_cut_short() {
    let folder = folder();
    let output = meshless(&folder, &["run", &cantilever(), "--steps", "10", "--profile"]);
    assert_success(&output);
    let text = out(&output);
    for expected in
        ["10 steps", "particle-steps/s", "kinetic", "balance error", "Ganzenmueller", "meshless resume"]
    {
        assert!(text.contains(expected), "`{expected}` is missing in\n{text}");
    }
    assert!(text.contains("ns/particle-step"), "the table of --profile is missing in\n{text}");
    for file in ["checkpoint.mlc", "cantilever.rrd", "energy.csv", "tip.csv", "summary.json"] {
        assert!(folder.path().join("out/cantilever").join(file).is_file(), "{file} is not there");
        assert!(text.contains(file), "{file} is not named in\n{text}");
    }
    assert!(text.contains("meshless view out/cantilever"), "{text}");
}

/// AVX-512 lends its registers to the loops and changes no sum. Where a processor has one path only, there is
/// nothing to compare.
#[test]
fn an_instruction_path_can_be_taken_and_avx_512_has_the_bits_of_avx2() {
    let folder = folder();
    let refused = meshless(&folder, &["run", &cantilever(), "--instructions", "x86-64-v9"]);
    assert_eq!(refused.status.code(), Some(2));
    let message = err(&refused);
    assert!(message.contains("no instruction path `x86-64-v9`; it has "), "{message}");
    let flow = scene("dam_break.ron").display().to_string();
    for (scene, set) in
        [(cantilever(), "time.end=0.01"), (flow.clone(), "precision=Double"), (flow, "precision=Mixed")]
    {
        let run = |path| {
            let arguments = ["run", &scene, "--set", set, "--steps", "20", "--force", "--instructions", path];
            let output = meshless(&folder, &arguments);
            assert_success(&output);
            state_hash(&output)
        };
        if message.contains("x86-64-v4") {
            assert_eq!(run("x86-64-v4"), run("x86-64-v3"), "{scene} {set}");
        }
        if message.contains("x86-64-v3") {
            assert_ne!(run("x86-64"), run("x86-64-v3"), "{scene} {set}: no other path was taken");
        }
    }
}

#[test]
fn a_quiet_run_prints_nothing() {
    let folder = folder();
    let output = meshless(&folder, &["run", &cantilever(), "--steps", "2", "--quiet"]);
    assert_success(&output);
    assert_eq!(out(&output), "");
}

#[test]
fn resuming_gives_the_state_of_a_run_that_was_not_interrupted() {
    let folder = folder();
    let whole = meshless(
        &folder,
        &[
            "run",
            &cantilever(),
            "--steps",
            "25",
            "--out",
            "whole",
            "--threads",
            "2",
            "--set",
            "record.every=1e-5",
        ],
    );
    assert_success(&whole);
    assert_success(&meshless(
        &folder,
        &[
            "run",
            &cantilever(),
            "--steps",
            "9",
            "--out",
            "cut",
            "--threads",
            "1",
            "--set",
            "record.every=1e-5",
        ],
    ));
    let rest = meshless(&folder, &["resume", "cut", "--steps", "16"]);
    assert_success(&rest);
    assert_eq!(state_hash(&rest), state_hash(&whole));
    for file in ["tip.csv", "energy.csv"] {
        let read = |run: &str| std::fs::read_to_string(folder.path().join(run).join(file)).expect("a series");
        assert!(read("whole").lines().count() > 2, "{}", read("whole"));
        assert_eq!(read("cut"), read("whole"), "{file}");
    }
}

#[test]
fn nothing_is_overwritten_unless_it_is_asked_for() {
    let folder = folder();
    let scene = cantilever();
    let run = |more: &[&str]| {
        let arguments = [&["run", &scene, "--out", "o", "--set", "time.end=1e-5"], more].concat();
        meshless(&folder, &arguments)
    };
    assert_success(&run(&[]));
    let summary = folder.path().join("o/summary.json");
    let written = std::fs::read_to_string(&summary).expect("a summary");
    assert!(written.contains("\"finished\""), "{written}");
    let refused = run(&[]);
    assert_eq!(refused.status.code(), Some(2));
    assert!(
        err(&refused).contains("already exists") && err(&refused).contains("--force"),
        "{}",
        err(&refused)
    );
    assert_eq!(std::fs::read_to_string(&summary).expect("a summary"), written);
    assert_success(&run(&["--force", "--steps", "3"]));
    assert!(std::fs::read_to_string(&summary).expect("a summary").contains("\"interrupted\""));
}

#[test]
fn a_complete_run_can_be_prolonged_only_by_a_later_end() {
    let folder = folder();
    assert_success(&meshless(&folder, &["run", &cantilever(), "--steps", "5", "--out", "o"]));
    let checkpoint = folder.path().join("o/checkpoint.mlc");
    let checkpoint = checkpoint.to_str().expect("a path in UTF-8");
    let early = meshless(&folder, &["resume", checkpoint, "--until", "1e-9"]);
    assert_eq!(early.status.code(), Some(2));
    assert!(err(&early).contains("--until"), "{}", err(&early));
    let prolonged = meshless(&folder, &["resume", checkpoint, "--until", "2e-5"]);
    assert_success(&prolonged);
    assert!(out(&prolonged).contains("finished: t = 20 µs"), "{}", out(&prolonged));
}

#[test]
fn a_value_can_be_replaced() {
    let folder = folder();
    let arguments = ["run", &cantilever(), "--set", "time.end=1e-6", "--set", "bodies.strip.spacing=0.0125"];
    let output = meshless(&folder, &arguments);
    assert_success(&output);
    assert!(out(&output).contains("finished: t = 1 µs"), "{}", out(&output));
    assert!(out(&output).contains("of 208 particles"), "{}", out(&output));
}

#[test]
fn faults_of_a_scene_are_shown_at_their_place_and_nothing_is_written() {
    let folder = folder();
    let text = std::fs::read_to_string(scene("cantilever.ron")).expect("the scene");
    let line = 1 + text.lines().position(|line| line.contains("spacing:")).expect("a spacing");
    let wrong = folder.path().join("wrong.ron");
    std::fs::write(&wrong, text.replace("spacing:", "spacin:")).expect("a scene is written");
    let output = meshless(&folder, &["run", "wrong.ron"]);
    assert_eq!(output.status.code(), Some(2));
    let shown = err(&output);
    assert!(shown.contains(&format!("wrong.ron:{line}:")), "{shown}");
    assert!(shown.contains("`spacing`") && shown.contains('^'), "{shown}");
    assert!(!folder.path().join("out").exists());

    let unknown = text.replace("hourglass_control()", "hourglas_control()");
    std::fs::write(&wrong, unknown).expect("a scene is written");
    let output = meshless(&folder, &["run", "wrong.ron"]);
    assert_eq!(output.status.code(), Some(2));
    assert!(err(&output).contains("did you mean `hourglass_control`"), "{}", err(&output));
}

#[test]
fn wrong_calls_are_told_apart_from_failed_runs() {
    let folder = folder();
    assert_eq!(meshless(&folder, &["run"]).status.code(), Some(2));
    assert_eq!(meshless(&folder, &["run", "nowhere.ron"]).status.code(), Some(2));
    assert_eq!(meshless(&folder, &["run", &cantilever(), "--threads", "0"]).status.code(), Some(2));
    assert_eq!(meshless(&folder, &["run", &cantilever(), "--set", "time.end"]).status.code(), Some(2));
    assert_eq!(meshless(&folder, &["resume", "nowhere"]).status.code(), Some(2));
    std::fs::write(folder.path().join("broken.mlc"), "no checkpoint").expect("a file is written");
    let broken = meshless(&folder, &["resume", "broken.mlc"]);
    assert_eq!(broken.status.code(), Some(1));
    assert!(err(&broken).contains("not a checkpoint"), "{}", err(&broken));
}

#[test]
fn an_unstable_run_fails_and_keeps_its_last_state() {
    let folder = folder();
    let output = meshless(&folder, &["run", &cantilever(), "--set", "time.step=Fixed(1e-5)", "--out", "o"]);
    assert_eq!(output.status.code(), Some(1), "{}", out(&output));
    assert!(err(&output).contains("error: "), "{}", err(&output));
    assert!(err(&output).contains("`strip`"), "{}", err(&output));
    assert!(
        err(&output).contains("damping may help; the fixed time step of 10 µs exceeds"),
        "{}",
        err(&output)
    );
    assert!(folder.path().join("o/failed.mlc").is_file());
}

#[test]
fn a_check_tells_the_cost_and_touches_nothing() {
    let folder = folder();
    let output = meshless(&folder, &["check", &cantilever(), "--schedule"]);
    assert_success(&output);
    let text = out(&output);
    for expected in ["1300", "neighbours", "time step", "limited by", "run time", "total_lagrangian_force"] {
        assert!(text.contains(expected), "`{expected}` is missing in\n{text}");
    }
    // Between the two passes over bonds every particle gets a new stress, and positions stay.
    let force = text.lines().find(|line| line.trim_start().starts_with("total_lagrangian_force;"));
    let stale = "rows of neighbours changed since they were last read: corrected_stress";
    assert!(force.is_some_and(|line| line.ends_with(stale)), "{text}");
    assert_eq!(std::fs::read_dir(folder.path()).expect("the folder").count(), 0);
}

#[test]
fn every_template_is_listed_written_once_and_checks() {
    let folder = folder();
    let list = out(&meshless(&folder, &["new"]));
    for entry in std::fs::read_dir(scene("")).expect("the scenes") {
        let path = entry.expect("a scene").path();
        let Some(name) = path.file_stem().and_then(|stem| stem.to_str()) else { continue };
        if std::fs::read_to_string(&path).expect("a scene").contains("file: \"") {
            continue;
        }
        assert!(list.contains(name), "{name} is not a template of\n{list}");
        assert_success(&meshless(&folder, &["new", name]));
        let file = format!("{name}.ron");
        assert_success(&meshless(&folder, &["run", &file, "--steps", "1", "--quiet"]));
        let again = meshless(&folder, &["new", name]);
        assert_eq!(again.status.code(), Some(1));
        assert!(err(&again).contains("already exists"), "{}", err(&again));
    }
    let unknown = meshless(&folder, &["new", "cantilver"]);
    assert_eq!(unknown.status.code(), Some(2));
    assert!(err(&unknown).contains("did you mean `cantilever`"), "{}", err(&unknown));
}

#[test]
fn everything_that_is_registered_is_listed_and_described() {
    use meshless::plugin::EntryKind;
    let folder = folder();
    let list = out(&meshless(&folder, &["plugins"]));
    let registry = meshless::standard_plugins();
    for kind in [EntryKind::Material, EntryKind::Formulation, EntryKind::Condition, EntryKind::Plugin] {
        for entry in registry.entries(kind) {
            assert!(list.contains(entry.name), "{} is missing in\n{list}", entry.name);
            let description = meshless(&folder, &["plugins", entry.name]);
            assert_success(&description);
            for parameter in entry.parameters() {
                assert!(out(&description).contains(&parameter.doc), "{} of {}", parameter.name, entry.name);
            }
        }
    }
    assert_eq!(meshless(&folder, &["plugins", "hourglas"]).status.code(), Some(2));
    // Fields, of materials and fluids too, each with what it is.
    for expected in [
        "plastic strain, the integral of sqrt(2/3 D_p : D_p) [-]",
        "Vorticity of the flow [1/s]",
        "Temperature [K]",
    ] {
        assert!(list.contains(expected), "`{expected}` is missing in\n{list}");
    }
    let fields = list.lines().skip_while(|line| line.trim() != "fields").skip(1);
    for line in fields.take_while(|line| line.trim() != "expressions") {
        assert!(line.split_whitespace().count() > 2, "`{}` is not described", line.trim());
    }
}

#[test]
fn the_scene_reference_is_what_the_program_prints() {
    let page = Path::new(env!("CARGO_MANIFEST_DIR")).join("docs/scene.md");
    let page = std::fs::read_to_string(page).expect("the scene reference");
    let folder = folder();
    let printed = out(&meshless(&folder, &["schema"]));
    assert!(
        printed == page,
        "docs/scene.md is not up to date; write it with `meshless schema > docs/scene.md`"
    );
}

#[cfg(unix)]
#[test]
fn an_interrupted_run_can_go_on() {
    let folder = folder();
    let arguments = ["run", &cantilever(), "--set", "time.end=10.0", "--out", "o"];
    let mut child = command(&folder, &arguments).spawn().expect("the program starts");
    std::thread::sleep(std::time::Duration::from_secs(2));
    let signal = Command::new("kill").args(["-INT", &child.id().to_string()]).status();
    if !signal.is_ok_and(|status| status.success()) {
        let _ = child.kill();
        panic!("the signal could not be sent");
    }
    let output = child.wait_with_output().expect("the program ends");
    assert_eq!(output.status.code(), Some(130), "{}{}", out(&output), err(&output));
    assert!(out(&output).contains("meshless resume o"), "{}", out(&output));
    assert_success(&meshless(&folder, &["resume", "o", "--steps", "1", "--threads", "2"]));
}

#[test]
fn a_benchmark_measures_a_case_and_names_the_cases_there_are() {
    let folder = folder();
    let list = meshless(&folder, &["bench", "--list"]);
    assert_success(&list);
    let cases: Vec<String> =
        out(&list).lines().filter_map(|line| Some(line.split_whitespace().next()?.to_owned())).collect();
    assert!(cases.len() > 4, "{cases:?}");
    for case in &cases {
        let output = meshless(&folder, &["bench", case, "--particles", "1k", "--seconds", "0", "--json"]);
        assert_success(&output);
        let record: serde_json::Value = serde_json::from_str(&out(&output)).expect("a record in JSON");
        let number = |name: &str| record[name].as_f64().expect("a number");
        // Grains of abrasive flow need eight spacings.
        let most = if case.starts_with("abrasive") { 8000.0 } else { 2000.0 };
        assert!((500.0..most).contains(&number("particles")), "{record}");
        assert!(number("particle_steps_per_second") > 0.0, "{record}");
        // In a sheet of two layers they are nine.
        assert!(case == "abrasive-grains" || number("neighbors") > 8.0, "{record}");
        assert_eq!(case == "abrasive" || case == "dam-plate", record["sub_steps"].is_number(), "{record}");
    }
    let unknown = meshless(&folder, &["bench", "solid"]);
    assert_eq!(unknown.status.code(), Some(2));
    assert!(err(&unknown).contains("unknown benchmark `solid`") && err(&unknown).contains("solid-31"));
}

#[test]
fn a_recording_is_shown_in_a_browser_with_nothing_else_installed() {
    let folder = folder();
    assert_success(&meshless(&folder, &["run", &cantilever(), "--steps", "2", "--quiet"]));
    let view = command(&folder, &["view", "out/cantilever", "--web", "--no-browser"])
        .stderr(Stdio::inherit())
        .spawn();
    let mut view = view.expect("the program starts");
    let mut lines = BufReader::new(view.stdout.take().expect("its output")).lines();
    let url =
        lines.by_ref().map_while(Result::ok).find_map(|line| Some(line[line.find("http://")?..].to_owned()));
    let recording = url.as_deref().and_then(|url| url.split_once("?url=http://")?.1.split_once('/'));
    let answer = recording.and_then(|(address, path)| {
        let mut stream = TcpStream::connect(address).ok()?;
        write!(stream, "GET /{path} HTTP/1.0\r\nHost: {address}\r\n\r\n").ok()?;
        let mut answer = Vec::new();
        stream.read_to_end(&mut answer).ok()?;
        Some(answer)
    });
    view.kill().expect("it is running");
    view.wait().expect("it ends");
    let answer = answer.unwrap_or_else(|| panic!("no answer at {url:?}"));
    let file = std::fs::read(folder.path().join("out/cantilever/cantilever.rrd")).expect("a recording");
    assert!(
        answer.starts_with(b"HTTP/1.0 200") && answer.ends_with(&file),
        "{}",
        String::from_utf8_lossy(&answer[..answer.len().min(400)])
    );
}

/// A beam with a frame for every millisecond of its recording.
const RECORDED: &str = r#"(
    dimension: Two,
    gravity: (0.0, -9.81),
    materials: {"rubber": NeoHookean(density: 1000.0, young: 1.0e5, poisson: 0.3)},
    bodies: [
        Body(name: "beam", material: "rubber", shape: Box(min: (0.0, 0.0), max: (0.1, 0.03)), spacing: 0.01,
             formulation: TotalLagrangian),
    ],
    conditions: [Fix(on: Select(face: MinX))],
    plugins: [rerun_recorder()],
    time: (end: 1.0),
    record: (every: 0.001),
)"#;

#[cfg(unix)]
#[test]
fn a_recording_that_cannot_be_written_ends_the_run_and_leaves_the_state() {
    let folder = folder();
    std::fs::write(folder.path().join("beam.ron"), RECORDED).expect("a scene");
    // A disk that is full after so many bytes; a program that waits for ever is ended.
    let limited = "trap '' XFSZ; ulimit -f 128; exec timeout -k 1 60 \"$0\" run --out o beam.ron";
    let output = Command::new("bash")
        .args(["-c", limited, env!("CARGO_BIN_EXE_meshless")])
        .current_dir(folder.path())
        .output()
        .expect("bash starts");
    assert_eq!(output.status.code(), Some(1), "{}{}", out(&output), err(&output));
    assert!(err(&output).contains("cannot write `o/beam.rrd`"), "{}", err(&output));
    assert!(folder.path().join("o/failed.mlc").is_file() && folder.path().join("o/summary.json").is_file());
    // What the recording has can be looked at.
    assert_success(&meshless(&folder, &["picture", "o"]));
    let again = meshless(&folder, &["picture", "o"]);
    assert!(err(&again).contains("already exists; `--force` replaces it"), "{}", err(&again));
}

#[test]
fn an_output_folder_that_cannot_be_written_is_told_before_any_work() {
    let folder = folder();
    std::fs::write(folder.path().join("file"), "text").expect("a file is written");
    let output = meshless(&folder, &["run", &cantilever(), "--out", "file/below"]);
    assert_eq!(output.status.code(), Some(2));
    let expected = format!(
        "error: cannot make the output folder `file/below`: `file` is a file\n--> {}\n \
         = help: choose a folder in which you may write\n",
        cantilever()
    );
    assert_eq!(err(&output), expected);
    assert_eq!(out(&output), "");
}

#[test]
fn a_complete_run_can_be_prolonged_unless_its_scene_wants_no_checkpoint() {
    let folder = folder();
    let short = |out: &str, more: &[&str]| {
        let scene = cantilever();
        let mut arguments = vec!["run", scene.as_str(), "--out", out, "--quiet", "--set", "time.end=1e-5"];
        arguments.extend(more);
        assert_success(&meshless(&folder, &arguments));
    };
    short("one", &[]);
    let further = meshless(&folder, &["resume", "one", "--until", "2e-5"]);
    assert_success(&further);
    assert!(out(&further).contains("finished: t = 20 µs"), "{}", out(&further));
    assert!(out(&further).contains("meshless resume one --until TIME"), "{}", out(&further));
    short("two", &["--set", "record.checkpoint_at_end=false"]);
    let none = meshless(&folder, &["resume", "two", "--until", "2e-5"]);
    assert_eq!(none.status.code(), Some(2));
    assert!(err(&none).contains("checkpoint_at_end: false"), "{}", err(&none));
}
