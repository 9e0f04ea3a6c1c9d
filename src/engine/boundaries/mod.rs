//! Conditions: what holds, moves and loads bodies. A condition is one file and one line of [`register`].

mod fix;

pub use fix::Fix;

use crate::plugin::Registry;

/// Registers all conditions of the engine.
pub fn register(registry: &mut Registry) {
    registry.condition::<Fix>();
}
