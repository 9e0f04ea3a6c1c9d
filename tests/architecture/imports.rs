//! Who imports whom: modules go down a list, and files of a folder make no circles.

use std::path::Path;

use super::{ENGINE, collect_sources, engine_sources, entries, name, read, root, shown, without_tests};

/// The modules of the engine, each above those that it may import.
const LAYERS: &[&str] = &[
    "invariants",
    "assembly",
    "contact",
    "boundaries",
    "simulation",
    "record",
    "formulations",
    "skins",
    "solids",
    "symmetry",
    "removal",
    "pair",
    "rigid",
    "integrate",
    "fields",
    "plugin",
    "schedule",
    "materials",
    "world",
    "scene",
    "shapes",
    "space",
    "neighbors",
    "correction",
    "kernels",
    "parallel",
    "ranks",
    "linalg",
    "notation",
];

#[test]
fn the_table_of_modules_has_all_of_them_in_order() {
    let page = read(&root().join("ARCHITECTURE.md"));
    let rows = page.lines().filter(|line| line.starts_with("| `"));
    let modules =
        rows.flat_map(|line| line.split('|').nth(1).unwrap_or_default().split('`').skip(1).step_by(2));
    let modules: Vec<&str> = modules.collect();
    assert_eq!(modules, LAYERS, "ARCHITECTURE.md lists the modules in the order of LAYERS");
    assert!(
        page.split_whitespace().count() < 1400,
        "ARCHITECTURE.md is a page to begin with: two printed pages"
    );
}

/// The words that follow `path::` in a text, also in a list in braces.
fn words_after<'t>(text: &'t str, path: &str) -> Vec<&'t str> {
    let is_word = |c: char| c.is_alphanumeric() || c == '_';
    let word = |rest: &'t str| &rest[..rest.find(|c| !is_word(c)).unwrap_or(rest.len())];
    let rests = text.match_indices(path).map(|(at, _)| (at, &text[at + path.len()..]));
    // `supercrate::` is not `crate::`, and what follows `super::super::` does not follow `super::`.
    let whole = rests.filter(|(at, _)| !text[..*at].ends_with(is_word) && !text[..*at].ends_with("super::"));
    let words = whole.map(|(_, rest)| match rest.strip_prefix('{') {
        Some(list) => parts(list).into_iter().map(|part| word(part.trim_start())).collect(),
        None => vec![word(rest)],
    });
    words.flatten().collect()
}

/// The parts of a list up to its closing brace, whose own lists are whole.
fn parts(list: &str) -> Vec<&str> {
    let (mut parts, mut depth, mut start) = (Vec::new(), 0, 0);
    for (at, c) in list.char_indices() {
        match c {
            '{' => depth += 1,
            '}' if depth > 0 => depth -= 1,
            '}' | ',' if depth == 0 => {
                parts.push(&list[start..at]);
                start = at + 1;
                if c == '}' {
                    break;
                }
            }
            _ => {}
        }
    }
    parts
}

#[test]
fn words_of_imports_are_read() {
    let text = "use super::{a::{X, y}, b}; use super::super::c::Z; super::d(); use subsuper::e;";
    assert_eq!(words_after(text, "super::"), ["a", "b", "super", "d"]);
    assert_eq!(words_after(text, "super::super::"), ["c"]);
}

#[test]
fn imports_of_the_engine_go_down_the_list_of_modules() {
    let rank = |module: &str| LAYERS.iter().position(|layer| *layer == module);
    let mut imports = 0;
    for folder in ENGINE.map(|folder| root().join(folder)) {
        for line in read(&folder.join("lib.rs")).lines() {
            if let Some(module) = line.strip_prefix("pub mod ").and_then(|rest| rest.strip_suffix(';')) {
                assert!(rank(module).is_some(), "module `{module}` has no place in the list");
            }
        }
        let mut files = Vec::new();
        collect_sources(&folder, &mut files);
        for path in &files {
            let inside = path.strip_prefix(&folder).expect("a file of the folder");
            let first = inside.iter().next().expect("a name").to_string_lossy().into_owned();
            let Some(own) = rank(first.trim_end_matches(".rs")) else { continue };
            let Some(text) = without_tests(path) else { continue };
            for other in words_after(&text, "crate::").into_iter().filter_map(rank) {
                imports += 1;
                let (own_name, name) = (LAYERS[own], LAYERS[other]);
                assert!(own <= other, "{}: `{own_name}` is below `{name}` and imports it", shown(path));
            }
        }
    }
    assert!(imports > 500, "only {imports} imports are found");
}

/// The modules of `folder`, one of the engine, that a file of it imports: `path` leads there from the folder.
fn imports_within(folder: &str, path: &Path) -> Vec<String> {
    let Some(text) = without_tests(path) else { return Vec::new() };
    let inside = path.strip_prefix(root().join(folder)).expect("a file of the folder");
    let above = "super::".repeat(inside.components().count());
    let module = folder.splitn(3, '/').nth(2).unwrap_or_default();
    let absolute = format!("crate::{}::", module.replace('/', "::"));
    let relative = words_after(&text, &above).into_iter().filter(|word| *word != "super");
    relative.chain(words_after(&text, &absolute)).map(str::to_owned).collect()
}

/// Every file and folder in a folder of the engine, without the extension, and what it imports of the others.
fn modules_and_imports(folder: &str) -> Vec<(String, Vec<String>)> {
    let mut modules = Vec::new();
    for path in entries(&root().join(folder)) {
        let own = name(&path).trim_end_matches(".rs").to_owned();
        if own == "mod" || own.ends_with("tests") {
            continue;
        }
        let mut files = Vec::new();
        if path.is_dir() {
            collect_sources(&path, &mut files)
        } else {
            files.push(path)
        }
        let imports = files.iter().flat_map(|file| imports_within(folder, file)).collect();
        modules.push((own, imports));
    }
    modules
}

/// The modules of a folder that import each other in circles, or what does.
fn circles_of(folder: &str) -> Vec<String> {
    let mut open = modules_and_imports(folder);
    // What imports nothing that is still open is closed, until all are closed or wait for each other.
    loop {
        let names: Vec<String> = open.iter().map(|(name, _)| name.clone()).collect();
        let waits = |(own, imports): &(String, Vec<String>)| {
            imports.iter().any(|other| other != own && names.contains(other))
        };
        open.retain(waits);
        if open.len() == names.len() {
            return names;
        }
    }
}

#[test]
fn modules_of_a_folder_import_each_other_without_circles() {
    let mut folders: Vec<String> =
        engine_sources().iter().filter_map(|path| path.parent().map(shown)).collect();
    folders.sort();
    folders.dedup();
    let is_inside = |folder: &&String| {
        !ENGINE.contains(&folder.as_str()) && !folder.split('/').any(|part| part == "tests")
    };
    let inside: Vec<&String> = folders.iter().filter(is_inside).collect();
    assert!(inside.len() > 60, "only {} folders are found", inside.len());
    for folder in inside {
        let waiting = circles_of(folder);
        assert!(waiting.is_empty(), "{folder}: circles among {}", waiting.join(", "));
    }
}

#[test]
fn folders_of_contact_and_fluid_import_only_those_above_them_in_their_lists() {
    for folder in ["src/engine/contact", "src/engine/formulations/fluid"] {
        imports_go_up_the_list_of(folder);
    }
}

fn imports_go_up_the_list_of(folder: &str) {
    let list = read(&root().join(folder).join("mod.rs"));
    let folders: Vec<&str> =
        list.lines().filter_map(|line| line.strip_prefix("mod ")?.strip_suffix(';')).collect();
    let place = |name: &str| folders.iter().position(|folder| *folder == name);
    let mut imports = 0;
    for (own, others) in modules_and_imports(folder) {
        for other in others.iter().filter(|other| **other != own) {
            // What the list itself exports has no place in it.
            let Some(at) = place(other) else { continue };
            imports += 1;
            assert!(Some(at) < place(&own), "{folder}: `{own}` stands above `{other}` and imports it");
        }
    }
    assert!(imports > 30, "{folder}: only {imports} imports are found");
}
