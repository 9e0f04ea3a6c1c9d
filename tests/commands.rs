//! Signals, output that cannot be written, moved scenes and slips of units, as users meet them; without
//! recordings.

mod program;

use std::path::Path;
use std::process::{Command, Stdio};
use std::time::Duration;

use program::{assert_success, command, err, meshless, out};

/// A beam whose run takes minutes.
const SCENE: &str = r#"(
    dimension: Two,
    gravity: (0.0, -9.81),
    materials: {"rubber": NeoHookean(density: 1000.0, young: 1.0e5, poisson: 0.3)},
    bodies: [
        Body(name: "beam", material: "rubber", shape: Box(min: (0.0, 0.0), max: (0.1, 0.03)), spacing: 0.01,
             formulation: TotalLagrangian),
    ],
    conditions: [Fix(on: Select(face: MinX))],
    time: (end: 1000.0),
    probes: [Probe(name: "tip", on: Select(nearest: (0.1, 0.03)), quantity: Displacement, every: 0.001)],
    record: (every: 1.0),
)
"#;

fn folder() -> tempfile::TempDir {
    let folder = tempfile::tempdir().expect("a temporary folder");
    std::fs::write(folder.path().join("beam.ron"), SCENE).expect("a scene");
    folder
}

#[cfg(unix)]
fn send(signal: &str, id: u32) {
    let sent = Command::new("kill").args([format!("-{signal}"), id.to_string()]).status();
    assert!(sent.is_ok_and(|status| status.success()), "{signal} could not be sent");
}

/// Waits until the run has begun to write.
fn wait_for(file: &Path) {
    for _ in 0..600 {
        if std::fs::metadata(file).is_ok_and(|data| data.len() > 0) {
            return;
        }
        std::thread::sleep(Duration::from_millis(100));
    }
    panic!("the run has not begun");
}

#[test]
fn numbers_of_options_say_what_is_expected() {
    let folder = folder();
    for (option, value, expected) in [
        ("--threads", "9999", "expected a whole number from 1 to 1024"),
        ("--threads", "x", "expected a whole number from 1 to 1024"),
        ("--steps", "1.5", "expected a whole number from 0 to"),
    ] {
        let output = meshless(folder.path(), &["run", "beam.ron", option, value]);
        assert_eq!(output.status.code(), Some(2));
        assert!(err(&output).contains(expected), "{}", err(&output));
    }
}

#[test]
fn a_check_reviews_bodies_by_what_they_are() {
    let folder = folder();
    let check = |body: &str| {
        let text = SCENE
            .replace("formulation: TotalLagrangian", body)
            .replace("conditions: [Fix(on: Select(face: MinX))],", "");
        let text = text.replace("materials: {", "materials: {\"steel\": Steel, \"metal\": Al6061T6, ");
        std::fs::write(folder.path().join("body.ron"), text).expect("a scene");
        let output = meshless(folder.path(), &["check", "body.ron"]);
        assert!(output.status.success(), "{}", err(&output));
        String::from_utf8_lossy(&output.stdout).into_owned()
    };
    for formulation in ["TotalLagrangian", "UpdatedLagrangian()", "Eulerian()"] {
        let notes = check(&format!("formulation: {formulation}"));
        assert!(notes.contains("body `beam` has no `hourglass_control`"), "{formulation}: {notes}");
    }
    let rigid = "formulation: Rigid()), Body(name: \"block\", material: \"steel\", shape: Box(min: (0.5, 0.0), max: (0.6, 0.1)), spacing: 0.01, formulation: Rigid()";
    let notes = check(rigid);
    assert!(!notes.contains("hourglass_control") && !notes.contains("plastic flow"), "{notes}");
    let plastic = "formulation: TotalLagrangian), Body(name: \"bar\", material: \"metal\", shape: Box(min: (0.5, 0.0), max: (0.6, 0.1)), spacing: 0.01, formulation: TotalLagrangian";
    let notes = check(plastic);
    assert!(notes.contains("steps is a lower bound: plastic flow compresses particles"), "{notes}");
    let held = "formulation: TotalLagrangian)], conditions: [Fix(on: Select()";
    let notes = check(held);
    assert!(notes.contains("conditions move all of body `beam`"), "{notes}");
}

/// Notes and warnings of `check` on water in a tank, with another fluid beside it where `other` has the text
/// of one.
fn notes_on_water(axes: &str, water: &str, other: &str, set: &str) -> String {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let (dimension, gravity, [low, high, top, outer]) = match axes {
        "two" => ("Two", "(0, -9.81)", ["(-0.1, -0.1)", "(0.3, 0.3)", "(0.2, 1)", "(0, 0)"]),
        _ => (
            "Three",
            "(0, -9.81, 0)",
            ["(-0.1, -0.1, -0.1)", "(0.3, 0.3, 0.3)", "(0.2, 1, 0.2)", "(0, 0, 0)"],
        ),
    };
    let text = format!(
        r#"(dimension: {dimension}, gravity: {gravity}, materials: {{"water": Fluid(density: 1000.0), "oil": Fluid(density: 800.0)}},
            bodies: [
                (name: "water", material: "water", shape: {water}, spacing: 0.025, formulation: Fluid(), plugins: [density_diffusion()]),
                (name: "tank", material: "wall", spacing: 0.025, formulation: Wall(slip: Free),
                 shape: Difference(Box(min: {low}, max: {high}), Box(min: {outer}, max: {top}))), {other}
            ],
            time: (end: 1.0))"#
    );
    std::fs::write(folder.path().join("tank.ron"), text).expect("a scene");
    let output = meshless(folder.path(), &["check", "tank.ron", "--set", set]);
    assert!(output.status.success(), "{}", err(&output));
    format!("{}{}", String::from_utf8_lossy(&output.stdout), err(&output))
}

#[test]
fn a_check_proposes_a_wider_support_where_a_flow_needs_one() {
    let still = "is at rest: in three dimensions its particles rearrange";
    let cube = "Box(min: (0, 0, 0), max: (0.2, 0.2, 0.2))";
    let nothing = "time.end=1.0";
    assert!(notes_on_water("three", cube, "", nothing).contains(still));
    assert!(
        !notes_on_water("three", cube, "", "bodies.water.formulation=Fluid(support: 3.0)").contains(still)
    );
    assert!(!notes_on_water("three", cube, "", "materials.water.viscosity=10.0").contains(still));
    let irregular = "bodies.water.lattice=Relaxed(seed: 1, iterations: 30)";
    assert!(!notes_on_water("three", cube, "", irregular).contains(still));
    // A column that falls is not at rest.
    let column = "Box(min: (0, 0, 0), max: (0.1, 0.2, 0.2))";
    assert!(!notes_on_water("three", column, "", nothing).contains(still));

    let two = "waves on the interface of `water` and `oil`";
    let square = "Box(min: (0, 0), max: (0.2, 0.2))";
    let oil = |support: &str| {
        format!(
            r#"(name: "oil", material: "oil", shape: Box(min: (0, 0.2), max: (0.2, 0.25)), spacing: 0.025,
                formulation: Fluid({support}), plugins: [density_diffusion()])"#
        )
    };
    assert!(notes_on_water("two", square, &oil(""), nothing).contains(two));
    let wide = "bodies.water.formulation=Fluid(support: 3.3)";
    assert!(!notes_on_water("two", square, &oil("support: 3.3"), wide).contains(two));
    assert!(!notes_on_water("two", square, "", nothing).contains(two));
}

#[cfg(unix)]
#[test]
fn the_exit_code_tells_the_signal_and_the_run_can_go_on() {
    // Tests that run under `nohup` hand it on.
    let status = std::fs::read_to_string("/proc/self/status").unwrap_or_default();
    let ignored =
        status.lines().find_map(|line| line.strip_prefix("SigIgn:")?.trim().chars().last()?.to_digit(16));
    let deaf_to_hup = ignored.is_some_and(|signals| signals & 1 == 1);
    for (signal, code) in [("INT", 130), ("TERM", 143), ("HUP", 129)] {
        if signal == "HUP" && deaf_to_hup {
            continue;
        }
        let folder = folder();
        let child = command(folder.path(), &["run", "beam.ron", "--out", "o", "--threads", "1"]).spawn();
        let child = child.expect("the program starts");
        wait_for(&folder.path().join("o/tip.csv"));
        send(signal, child.id());
        let output = child.wait_with_output().expect("the program ends");
        assert_eq!(output.status.code(), Some(code), "{}", err(&output));
        let resumed = meshless(folder.path(), &["resume", "o", "--steps", "1", "--threads", "1"]);
        assert!(resumed.status.success(), "{}", err(&resumed));
    }
}

#[cfg(target_os = "linux")]
#[test]
fn a_run_under_nohup_outlives_its_terminal() {
    let folder = folder();
    let mut command = Command::new("nohup");
    command.args([env!("CARGO_BIN_EXE_meshless"), "run", "beam.ron", "--out", "o", "--threads", "1"]);
    command.current_dir(folder.path()).stdout(Stdio::piped()).stderr(Stdio::piped());
    let mut child = command.spawn().expect("the program starts");
    wait_for(&folder.path().join("o/tip.csv"));
    send("HUP", child.id());
    std::thread::sleep(Duration::from_millis(500));
    assert!(child.try_wait().expect("the program can be asked").is_none(), "SIGHUP has ended it");
    send("TERM", child.id());
    assert_eq!(child.wait().expect("the program ends").code(), Some(143));
}

#[cfg(target_os = "linux")]
#[test]
fn a_check_that_fails_tells_what_it_has_warned_of() {
    let folder = folder();
    // Steel in GPa.
    let text = r#"(
        dimension: Two,
        materials: {"m": Steel(young: 210.0)},
        bodies: [Body(name: "beam", material: "m", shape: Box(min: (-0.03, 0), max: (0.2, 0.02)), spacing: 0.0025, formulation: TotalLagrangian, plugins: [hourglass_control()])],
        conditions: [
            Fix(on: Select(body: "beam", within: Box(min: (-1, -1), max: (0, 1)))),
            Traction(on: Select(body: "beam", face: MaxX), value: (0, "-1e5*smoothstep(t/0.005)")),
        ],
        time: (end: 0.01),
    )"#;
    std::fs::write(folder.path().join("steel.ron"), text).expect("a scene");
    let output = meshless(folder.path(), &["check", "steel.ron"]);
    let text = err(&output);
    assert_eq!(output.status.code(), Some(1), "{text}");
    assert!(text.contains("negative volume") && text.contains("check the unit of its stiffness"), "{text}");
}

#[test]
fn a_quiet_run_shows_the_warnings_of_its_end() {
    let folder = folder();
    // A strip that its kernels let go of: its energy balance does not close.
    let scene = r#"(dimension: Two, materials: {"rubber": NeoHookean(density: 1000, young: 1e6, poisson: 0.3)},
        bodies: [(name: "strip", material: "rubber", shape: Box(min: (0, 0), max: (0.2, 0.1)), spacing: 0.0125,
                  formulation: Eulerian(), plugins: [hourglass_control()])],
        conditions: [Symmetry(plane: X, at: 0.0), Symmetry(plane: Y, at: 0.0), InitialVelocity(on: Select(), value: ("3*x", None)),
                     Velocity(on: Select(face: MaxX), value: ("0.6", None))],
        time: (end: 0.2))"#;
    std::fs::write(folder.path().join("drawn.ron"), scene).expect("a scene");
    let output = meshless(&folder, &["run", "drawn.ron", "--quiet"]);
    assert_success(&output);
    assert_eq!(out(&output), "");
    let said = err(&output);
    assert_eq!(said.matches("warning: energy balance error").count(), 1, "{said}");
}

#[test]
fn output_that_cannot_be_written_is_an_error() {
    let folder = folder();
    for arguments in [
        &["plugins"][..],
        &["schema"],
        &["check", "beam.ron"],
        &["check", "--json", "beam.ron"],
        &["--help"],
        &["--version"],
    ] {
        let full = std::fs::File::options().write(true).open("/dev/full").expect("a device that is full");
        let output = command(folder.path(), arguments).stdout(full).output().expect("the program starts");
        assert_eq!(output.status.code(), Some(1), "{arguments:?}: {}", err(&output));
        assert!(
            err(&output).contains("cannot be written") || err(&output).contains("cannot write"),
            "{}",
            err(&output)
        );
    }
}

#[test]
fn a_run_is_resumed_with_its_scene_elsewhere_and_with_other_values() {
    let folder = folder();
    let old = folder.path().join("old");
    std::fs::create_dir(&old).expect("a folder");
    let mesh = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/scenes/meshes/box.obj");
    std::fs::copy(&mesh, old.join("box.obj")).expect("a mesh");
    let scene = r#"(dimension: Three, materials: {"m": NeoHookean(density: 1000, young: 1e5, poisson: 0.3)},
        bodies: [Body(name: "b", material: "m", shape: Mesh(file: "box.obj"), spacing: 0.25, formulation: TotalLagrangian)],
        time: (end: 1.0), record: (every: 0.5))"#;
    std::fs::write(old.join("b.ron"), scene).expect("a scene");
    let run = meshless(folder.path(), &["run", "old/b.ron", "--out", "o", "--steps", "3", "--threads", "1"]);
    assert!(run.status.success(), "{}", err(&run));
    std::fs::rename(&old, folder.path().join("new")).expect("the folder is renamed");
    let lost = meshless(folder.path(), &["resume", "o", "--steps", "1"]);
    assert!(!lost.status.success() && err(&lost).contains("box.obj"), "{}", err(&lost));
    let found = meshless(folder.path(), &["resume", "o", "--steps", "1", "--scene", "new/b.ron"]);
    assert!(found.status.success(), "{}", err(&found));
    let is_another = "is not the scene file that the run began with";
    assert!(!err(&found).contains(is_another), "{}", err(&found));
    std::fs::write(folder.path().join("new/c.ron"), scene.replace("1e5", "1e4")).expect("a scene");
    for _ in 0..2 {
        let other = meshless(folder.path(), &["resume", "o", "--steps", "1", "--scene", "new/c.ron"]);
        assert!(other.status.success() && err(&other).contains(is_another), "{}", err(&other));
    }
    let set = ["resume", "o", "--scene", "new/b.ron", "--set", "time.end=1e-9"];
    let ended = meshless(folder.path(), &set);
    assert!(err(&ended).contains("extend it with `--until TIME`"), "{}", err(&ended));
}

#[test]
fn slips_of_units_are_warned_of() {
    let folder = folder();
    for (set, expected) in [
        ("materials.rubber.density=0.001", "outside 1 to 30000 kg/m3"),
        ("materials.rubber.density=1.0e6", "outside 1 to 30000 kg/m3"),
        ("materials.rubber.young=1.0e14", "check the units of its stiffness and density"),
        ("materials.rubber.young=1.0e-300", "check the units of its stiffness and density"),
        ("bodies.beam.velocity=(200.0, 0.0)", "times the speed of sound"),
    ] {
        let output = meshless(folder.path(), &["check", "beam.ron", "--set", set, "--set", "conditions=[]"]);
        let text = format!("{}{}", String::from_utf8_lossy(&output.stdout), err(&output));
        assert!(text.contains("warning") && text.contains(expected), "{set}: {text}");
    }
    // A motion that is given in mm/s: longitudinal waves in the beam run at 11.6 m/s.
    let fast = "conditions=[Velocity(on: Select(face: MinX), value: (\"200*smoothstep(t/10)\", None))]";
    let output = meshless(folder.path(), &["check", "beam.ron", "--set", fast]);
    assert!(err(&output).contains("17.2 times the speed of sound in body `beam`"), "{}", err(&output));
    let thrown = fast.replace("Velocity", "InitialVelocity").replace("200*smoothstep(t/10)", "2000*x");
    let output = meshless(
        folder.path(),
        &["check", "beam.ron", "--set", &thrown.replace("face: MinX", "body: \"beam\"")],
    );
    assert!(err(&output).contains("times the speed of sound in it"), "{}", err(&output));
    let plain = meshless(folder.path(), &["check", "beam.ron"]);
    assert!(!err(&plain).contains("warning"), "{}", err(&plain));
}

#[test]
fn a_far_end_is_allowed_and_the_number_of_steps_is_told() {
    let folder = folder();
    let far = ["--set", "time.end=1e9"];
    let check = meshless(folder.path(), &[&["check", "beam.ron"], &far[..]].concat());
    let text = String::from_utf8_lossy(&check.stdout).into_owned();
    assert!(text.contains("about 1.4e12 steps"), "{text}");
    let run = meshless(folder.path(), &[&["run", "beam.ron", "--steps", "2"], &far[..]].concat());
    assert!(run.status.success(), "{}", err(&run));
    for command in [&["check"][..], &["run", "--force"]] {
        let never = [command, &["beam.ron", "--set", "time.end=1e90"]].concat();
        let never = meshless(folder.path(), &never);
        let text = err(&never);
        assert!(text.contains("must take fewer than 1e15 steps, found 1.4"), "{text}");
        assert!(text.contains("beam.ron:") && text.contains("given by `--set time.end=1e90`"), "{text}");
        assert_eq!(never.status.code(), Some(2), "{text}");
    }
}

#[test]
fn a_time_to_resume_to_lies_after_the_checkpoint() {
    let folder = folder();
    let run = meshless(folder.path(), &["run", "beam.ron", "--out", "o", "--steps", "2"]);
    assert!(run.status.success(), "{}", err(&run));
    for (until, expected) in [
        ("1e-6", "`--until` must be later than the"),
        ("-1", "found -1 s"),
        ("nan", "expected a time in seconds"),
        ("soon", "expected a time in seconds"),
    ] {
        let output = meshless(folder.path(), &["resume", "o", "--until", until]);
        assert!(output.status.code() == Some(2) && err(&output).contains(expected), "{}", err(&output));
    }
}

#[cfg(feature = "rerun")]
#[test]
fn files_that_are_no_recording_are_not_shown() {
    let folder = folder();
    for command in ["view", "picture"] {
        let output = meshless(folder.path(), &[command, "beam.ron"]);
        assert_eq!(output.status.code(), Some(2));
        assert!(err(&output).contains("`beam.ron` is not a recording"), "{}", err(&output));
    }
}

#[test]
fn files_of_earlier_runs_are_told_apart() {
    let folder = folder();
    for name in ["beam", "other"] {
        let scene = format!("{name}.ron");
        std::fs::write(folder.path().join(&scene), SCENE.replace("\"tip\"", &format!("\"{name}\"")))
            .expect("a scene");
        let arguments = ["run", scene.as_str(), "--force", "--out", "o", "--steps", "1"];
        let output = meshless(folder.path(), &arguments);
        let text = String::from_utf8_lossy(&output.stdout).into_owned();
        assert!(text.contains(&format!("{name}.csv")), "{text}");
        let earlier = text.contains("and 1 file of earlier runs") && !text.contains("beam.csv");
        assert_eq!(earlier, name == "other", "{text}");
        std::thread::sleep(Duration::from_millis(60));
    }
}

#[test]
fn messages_stay_short() {
    let folder = folder();
    let long = SCENE.replace("material: \"rubber\"", &format!("material: {:?}", "x".repeat(100_000)));
    std::fs::write(folder.path().join("long.ron"), long).expect("a scene");
    let output = meshless(folder.path(), &["check", "long.ron"]);
    assert!(
        err(&output).contains("unknown material `xxx") && output.stderr.len() < 2000,
        "{}",
        output.stderr.len()
    );
    let output = meshless(folder.path(), &["plugins", "Wendland"]);
    assert!(
        err(&output).contains("did you mean `wendland_c2`?") && output.stderr.len() < 300,
        "{}",
        err(&output)
    );
    std::fs::write(folder.path().join("empty.ron"), "").expect("a scene");
    let output = meshless(folder.path(), &["check", "empty.ron"]);
    assert!(err(&output).contains("expected a value, found an empty text"), "{}", err(&output));
    let wide = meshless(folder.path(), &["check", "beam.ron", "--set", "bodies.beam.shape.max.x=0.2"]);
    assert!(String::from_utf8_lossy(&wide.stdout).contains(" 60 "), "{}", err(&wide));
}

#[cfg(target_os = "linux")]
#[test]
fn every_formulation_has_as_many_particles_as_fit_its_memory() {
    let folder = folder();
    // 100 000 particles: 0.16 GB in total-Lagrangian bodies, 0.62 GB in Eulerian ones.
    let cube = "(dimension: Three, materials: {\"steel\": Steel()}, time: (end: 1e-5), bodies: [Body(name: \"cube\", \
                material: \"steel\", shape: Box(min: (0, 0, 0), max: (1, 1, 1)), spacing: 0.0216, formulation: Eulerian())])";
    std::fs::write(folder.path().join("cube.ron"), cube).expect("a scene");
    for limit in ["-v 500000", "-d 400000"] {
        let limited =
            format!("ulimit {limit}; exec timeout -k 1 60 \"$0\" run --threads 1 --steps 1 cube.ron");
        let output = Command::new("bash")
            .args(["-c", &limited, env!("CARGO_BIN_EXE_meshless")])
            .current_dir(folder.path())
            .output()
            .expect("bash starts");
        assert_eq!(output.status.code(), Some(2), "{limit}: {}", err(&output));
        assert!(err(&output).contains("that fit into memory"), "{limit}: {}", err(&output));
    }
}
