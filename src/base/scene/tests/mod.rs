//! Tests of the scene language. The good and bad scenes are files, shared with the tests of simulations built
//! from them.

mod corpus;
mod items;
mod mutation;
mod overrides;
mod parameters;
mod reading;
mod reference;

use std::path::PathBuf;

use super::Source;

/// Number of cases of a property test: `PROPTEST_CASES` if it is set, for a long search.
fn cases(few: u32) -> u32 {
    std::env::var("PROPTEST_CASES").ok().and_then(|cases| cases.parse().ok()).unwrap_or(few)
}

/// A folder of scenes under `tests/scenes`.
fn folder(name: &str) -> PathBuf {
    PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("../../tests/scenes").join(name)
}

/// The scene that uses every part of the language.
fn everything() -> Source {
    Source::new("everything.ron", include_str!("../../../../tests/scenes/good/everything.ron"))
}

/// The smallest scene, with more fields at its end.
fn smallest_with(fields: &str) -> Source {
    let smallest = include_str!("../../../../tests/scenes/good/smallest.ron").trim_end();
    let open = smallest.strip_suffix(')').expect("the scene ends with a bracket");
    Source::new("small.ron", format!("{open}{fields})"))
}
