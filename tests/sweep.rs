//! A scene with parameters, run once for every combination of their values.

mod program;

use program::meshless;

const SCENE: &str = r#"(
    dimension: Two,
    parameters: {"dx": 0.01, "length": "8*dx", "pull": -9.81},
    gravity: (0.0, "pull"),
    materials: {"rubber": NeoHookean(density: 1000.0, young: 1.0e5, poisson: 0.3)},
    bodies: [
        Body(name: "beam", material: "rubber", shape: Box(min: (0.0, 0.0), max: ("length", 0.03)), spacing: "dx",
             formulation: TotalLagrangian),
    ],
    conditions: [Fix(on: Select(face: MinX))],
    time: (end: 0.004),
    probes: [Probe(name: "tip", on: Select(nearest: ("length", 0.03)), quantity: Displacement, every: 0.001)],
)
"#;

#[test]
fn a_sweep_is_a_run_for_every_combination_and_one_table() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    std::fs::write(folder.path().join("beam.ron"), SCENE).expect("a scene");
    let sweep = ["sweep", "beam.ron", "--set", "parameters.dx=0.01,0.0075", "--set", "parameters.pull=-1,-2"];
    let output = meshless(folder.path(), &sweep);
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    let table = std::fs::read_to_string(folder.path().join("out/beam/sweep.csv")).expect("a table");
    let mut rows = table.lines();
    let head: Vec<&str> = rows.next().expect("a header").split(',').collect();
    assert_eq!(head[..2], ["dx", "pull"]);
    let last = head.iter().position(|name| *name == "tip.y.last").expect("a column");
    let rows: Vec<Vec<&str>> = rows.map(|row| row.split(',').collect()).collect();
    let settings: Vec<[&str; 2]> = rows.iter().map(|row| [row[0], row[1]]).collect();
    assert_eq!(settings, [["0.01", "-1"], ["0.01", "-2"], ["0.0075", "-1"], ["0.0075", "-2"]]);
    // Each run is the run with these values.
    let single =
        ["run", "beam.ron", "--quiet", "--set", "parameters.dx=0.0075", "--set", "parameters.pull=-2"];
    let single = meshless(folder.path(), &[&single[..], &["--out", "single"]].concat());
    assert!(single.status.success());
    let read =
        |run: &str| std::fs::read_to_string(folder.path().join(run).join("tip.csv")).expect("a series");
    assert_eq!(read("single"), read("out/beam/dx=0.0075_pull=-2"));
    let of_probe = read("single").lines().last().and_then(|row| row.split(',').nth(2).map(str::to_owned));
    assert_eq!(of_probe.as_deref(), Some(rows[3][last]));
    // A second sweep does not overwrite the first one.
    let again = meshless(folder.path(), &sweep);
    assert_eq!(again.status.code(), Some(2));
}

#[test]
fn all_scenes_of_a_sweep_are_read_before_the_first_run() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    std::fs::write(folder.path().join("beam.ron"), SCENE).expect("a scene");
    let output = meshless(folder.path(), &["sweep", "beam.ron", "--set", "parameters.dx=0.01,-0.01"]);
    assert_eq!(output.status.code(), Some(2));
    let shown = String::from_utf8_lossy(&output.stderr).into_owned();
    assert!(shown.contains("`spacing` must be positive, found -0.01 m"), "{shown}");
    assert!(!folder.path().join("out").exists());
}

#[test]
fn a_sweep_without_probes_has_one_table() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    std::fs::write(folder.path().join("beam.ron"), SCENE).expect("a scene");
    let sweep = ["sweep", "beam.ron", "--set", "parameters.dx=0.01", "--set", "probes=[]"];
    let output = meshless(folder.path(), &sweep);
    let shown = String::from_utf8_lossy(&output.stdout).into_owned();
    assert!(shown.contains("outcome") && !shown.contains("minimum"), "{shown}");
}
