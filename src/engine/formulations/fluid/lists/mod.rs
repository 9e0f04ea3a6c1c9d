//! Neighbour lists, their validity, and pairs hidden by thin bodies.

mod displacement_bounds;

mod near_rows;

pub mod blocks;

mod drift;

mod thickness;

mod sides;

mod gaps;

mod pairs;

pub use displacement_bounds::{BoundsBuilder, DisplacementBounds};
pub use drift::Skins;
pub use gaps::{GapPairs, GapSide, SideMotion};
pub use near_rows::{NearRow, NearRows, NearWriter};
pub use pairs::FlowPairs;
pub use sides::ThinBody;
pub use thickness::{Thickness, Thin};
