//! Blocks of eight fluid particles: their common neighbours, and their records in single precision.

mod table;

mod record;

mod sift;

mod seen;

mod lists;

mod others;

mod found_rows;

mod memory;

pub use found_rows::OtherSources;
pub use lists::{BlockLists, ListSources};
pub use memory::Blocks;
pub use record::{Other, OwnBlock, Packed, Units, dot, pack_states};
pub use seen::SEEN;
pub use table::{OfBlocks, Rows};
