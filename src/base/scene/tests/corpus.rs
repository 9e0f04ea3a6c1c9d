//! The bad scenes of `tests/scenes/bad`. The first lines of a file state the expected text of its error, `//
//! expect: text`, and its positions, `// at: line:column`. `// level: build` marks a scene whose error is
//! found only when it is built.

use super::super::load;
use super::folder;

fn marked<'a>(text: &'a str, mark: &'a str) -> impl Iterator<Item = &'a str> {
    text.lines().take_while(|line| line.starts_with("//")).filter_map(move |line| line.strip_prefix(mark))
}

#[test]
fn bad_scenes_are_refused_as_they_say() {
    let mut files: Vec<_> =
        std::fs::read_dir(folder("bad")).unwrap().map(|entry| entry.unwrap().path()).collect();
    files.sort();
    let mut checked = 0;
    let mut failures = String::new();
    for file in files.iter().filter(|file| file.extension().is_some_and(|extension| extension == "ron")) {
        let text = std::fs::read_to_string(file).unwrap();
        if marked(&text, "// level: ").any(|level| level == "build") {
            continue;
        }
        checked += 1;
        let Err(error) = load(file, &[]) else {
            failures += &format!("{}: no error\n", file.display());
            continue;
        };
        let shown = error.to_string();
        let places: Vec<_> =
            marked(&text, "// at: ").map(|at| format!("{}:{at}\n", file.display())).collect();
        let wanted: Vec<_> =
            marked(&text, "// expect: ").map(str::to_owned).chain(places.iter().cloned()).collect();
        for wanted in wanted.iter().filter(|wanted| !shown.contains(wanted.as_str())) {
            failures += &format!("lacks {wanted:?}:\n{shown}\n\n");
        }
        if error.problems.len() != places.len() {
            failures += &format!("more or fewer problems than places:\n{shown}\n\n");
        }
    }
    assert!(failures.is_empty(), "{failures}");
    assert!(checked >= 40, "only {checked} scenes");
}

#[test]
fn good_scenes_are_read() {
    for entry in std::fs::read_dir(folder("good")).unwrap() {
        if let Err(error) = load(&entry.unwrap().path(), &[]) {
            panic!("{error}");
        }
    }
}

#[test]
fn files_that_cannot_be_read() {
    let missing = load(&folder("bad").join("there_is_no_such_scene.ron"), &[]).unwrap_err().to_string();
    assert!(
        missing.contains("does not exist") && missing.contains("there_is_no_such_scene.ron"),
        "{missing}"
    );
    let directory = load(&folder("bad"), &[]).unwrap_err().to_string();
    assert!(directory.contains("folder, not a scene file"), "{directory}");
    let binary = tempfile::NamedTempFile::new().unwrap();
    std::fs::write(binary.path(), b"(\n  title: \"\xff\xfe\")").unwrap();
    let binary = load(binary.path(), &[]).unwrap_err().to_string();
    assert!(binary.contains("not UTF-8 text: line 2"), "{binary}");
}
