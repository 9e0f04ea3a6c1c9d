//! The bad scenes of `tests/scenes/bad` that need the standard plugins to be found bad: `// level: build`,
//! `// needs: plugins`.

use std::path::Path;

use meshless::assembly::{build, name_problems};
use meshless::scene::{Scene, Source, load, parse_checked};

fn marked<'a>(text: &'a str, mark: &'a str) -> impl Iterator<Item = &'a str> {
    text.lines().take_while(|line| line.starts_with("//")).filter_map(move |line| line.strip_prefix(mark))
}

#[test]
fn scenes_with_bad_plugins_are_refused_as_they_say() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/scenes/bad");
    let registry = meshless::standard_plugins();
    let mut checked = 0;
    for entry in std::fs::read_dir(folder).expect("a folder") {
        let file = entry.expect("a file").path();
        let text = std::fs::read_to_string(&file).expect("a scene");
        if !marked(&text, "// needs: ").any(|need| need == "plugins") {
            continue;
        }
        checked += 1;
        let (scene, source) = load(&file, &[]).unwrap_or_else(|error| panic!("not even read:\n{error}"));
        let Err(error) = build(&scene, &source, &registry) else { panic!("{}: no error", file.display()) };
        let shown = error.to_string();
        let places = marked(&text, "// at: ").map(|at| format!("{}:{at}\n", file.display()));
        for wanted in marked(&text, "// expect: ").map(str::to_owned).chain(places) {
            assert!(shown.contains(&wanted), "lacks {wanted:?}:\n{shown}");
        }
    }
    assert!(checked >= 3, "only {checked} scenes");
}

/// Values are checked by the scene alone, names by the plugins that there are.
#[test]
fn wrong_names_and_wrong_values_are_told_at_once() {
    let text = r#"Scene(
    dimension: Two,
    materials: {"steel": NeoHookean(density: 7850.0, young: 2.0e11, poisson: 0.3)},
    bodies: [Body(name: "plate", material: "stel", shape: Box(min: (0, 0), max: (1, 1)), spacing: -0.1, formulation: TotalLagrangien)],
    time: (end: -1.0),
)"#;
    let registry = meshless::standard_plugins();
    let names = |scene: &Scene| name_problems(scene, &registry);
    let Err(error) = parse_checked(Source::new("plate.ron", text), &[], &names) else { panic!("no error") };
    let shown = error.to_string();
    for wanted in [
        "unknown material `stel`",
        "`spacing` must be positive, found -0.1 m",
        "unknown formulation `TotalLagrangien`",
        "`end` must be greater than 0",
    ] {
        assert!(shown.contains(wanted), "lacks {wanted:?}:\n{shown}");
    }
}
