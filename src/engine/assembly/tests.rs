//! The bad scenes of `tests/scenes/bad` that only building finds bad, marked `// level: build`. `// expect:
//! text` is in their error, `// at: line:column` are the places it names. Those that need plugins are marked
//! `// needs: plugins` and are left to the tests of the whole program.

use std::path::PathBuf;

use super::build;
use crate::plugin::Registry;
use crate::scene::load;

fn marked<'a>(text: &'a str, mark: &'a str) -> impl Iterator<Item = &'a str> {
    text.lines().take_while(|line| line.starts_with("//")).filter_map(move |line| line.strip_prefix(mark))
}

#[test]
fn scenes_that_cannot_be_built_are_refused_as_they_say() {
    let folder = PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("../../tests/scenes/bad");
    let mut files: Vec<_> =
        std::fs::read_dir(folder).expect("a folder").map(|entry| entry.expect("a file").path()).collect();
    files.sort();
    let registry = Registry::standard();
    let mut checked = 0;
    let mut failures = String::new();
    for file in files.iter().filter(|file| file.extension().is_some_and(|extension| extension == "ron")) {
        let text = std::fs::read_to_string(file).expect("a scene");
        if !marked(&text, "// level: ").any(|level| level == "build")
            || marked(&text, "// needs: ").any(|need| need == "plugins")
        {
            continue;
        }
        checked += 1;
        let (scene, source) = match load(file, &[]) {
            Ok(loaded) => loaded,
            Err(error) => {
                failures += &format!("not even read:\n{error}\n\n");
                continue;
            }
        };
        let Err(error) = build(&scene, &source, &registry) else {
            failures += &format!("{}: no error\n", file.display());
            continue;
        };
        let shown = error.to_string();
        let places = marked(&text, "// at: ").map(|at| format!("{}:{at}\n", file.display()));
        let wanted = marked(&text, "// expect: ").map(str::to_owned).chain(places);
        for wanted in wanted.filter(|wanted| !shown.contains(wanted.as_str())) {
            failures += &format!("lacks {wanted:?}:\n{shown}\n\n");
        }
    }
    assert!(failures.is_empty(), "{failures}");
    assert!(checked >= 15, "only {checked} scenes");
}
