//! The command line: a file for each command, and shared parts.

mod bench;
mod check;
mod commands;
mod completions;
mod execution;
mod failure;
mod folder;
mod interrupt;
mod lock;
mod memory;
mod neighbors;
mod new;
mod picture;
mod plugins;
mod profile;
mod progress;
mod ranks;
mod resume;
mod run;
mod scene_file;
mod schema;
mod summary;
mod surface;
mod sweep;
mod text;
mod validate;
mod values;
mod version;
mod view;
#[cfg(feature = "rerun")]
mod web_viewer;

pub use commands::run;
