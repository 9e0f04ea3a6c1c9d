//! From a scene to a simulation, on top of everything else: materials, particles, plugins, systems, columns.

mod approach;
mod build;
mod clamps;
mod drawn_sides;
mod face_on;
mod gaps_at_repeats;
#[cfg(test)]
mod handed_tests;
mod lattice_edges;
mod loaded_sides;
mod locking;
mod memory;
mod named_fields;
mod names;
mod narrow_gaps;
mod options;
mod overlap;
mod placement;
mod placing;
mod plausibility;
mod rows_on_faces;
mod spawn;
mod standard;
mod support_faces;
#[cfg(test)]
mod support_tests;
mod supports;
#[cfg(test)]
mod tests;

pub use build::{build, build_with};
pub use named_fields::fields;
pub use names::name_problems;
pub use options::BuildOptions;
