//! A type name exists once in the project: whoever reads a name knows what is meant.

use std::collections::BTreeMap;
use std::fs;
use std::path::{Path, PathBuf};

/// The source files below a folder that are not tests.
fn sources(folder: &Path, found: &mut Vec<PathBuf>) {
    for entry in fs::read_dir(folder).expect("a folder") {
        let path = entry.expect("an entry").path();
        let stem = path.file_stem().map(|stem| stem.to_string_lossy().into_owned()).unwrap_or_default();
        if stem == "tests" || stem.ends_with("_tests") {
            continue;
        }
        if path.is_dir() {
            sources(&path, found);
        } else if path.extension().is_some_and(|extension| extension == "rs") {
            found.push(path);
        }
    }
}

/// The name of the struct, enum or trait that a line defines.
fn defined(line: &str) -> Option<&str> {
    let line = line.trim_start();
    let rest = match line.strip_prefix("pub(") {
        Some(rest) => rest.split_once(") ")?.1,
        None => line.strip_prefix("pub ").unwrap_or(line),
    };
    let rest = ["struct ", "enum ", "trait "].iter().find_map(|kind| rest.strip_prefix(kind))?;
    let name = rest.split(|c: char| !c.is_alphanumeric() && c != '_').next()?;
    name.starts_with(char::is_uppercase).then_some(name)
}

#[test]
fn definitions_are_read() {
    assert_eq!(defined("    pub(in crate::fluid) struct Rows<'a> {"), Some("Rows"));
    assert_eq!(defined("pub trait SolidPhase: Send {"), Some("SolidPhase"));
    assert_eq!(defined("type Rows<'a> = &'a [f64];"), None);
}

#[test]
fn a_type_name_exists_once() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let mut files = Vec::new();
    for folder in ["src", "plugins"] {
        sources(&root.join(folder), &mut files);
    }
    let mut places: BTreeMap<String, Vec<String>> = BTreeMap::new();
    for file in &files {
        let text = fs::read_to_string(file).expect("a source");
        let text = text.split("#[cfg(test)]\nmod tests {").next().unwrap_or_default();
        let shown = file.strip_prefix(root).unwrap_or(file).display().to_string();
        for name in text.lines().filter_map(defined) {
            let of_name = places.entry(name.to_owned()).or_default();
            // Alternatives for other targets stand in one file.
            if !of_name.contains(&shown) {
                of_name.push(shown.clone());
            }
        }
    }
    assert!(places.contains_key("FlowCloud") && places.contains_key("SolidPhase"), "types are not found");
    let twice: Vec<_> = places.iter().filter(|(_, files)| files.len() > 1).collect();
    assert!(twice.is_empty(), "names of several types: {twice:#?}");
}
