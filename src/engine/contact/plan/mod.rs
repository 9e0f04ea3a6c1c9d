//! From the contacts of a scene to the systems that compute them.

mod images;

mod skins_of;

mod pairs;

mod start;

pub use pairs::{MakeLaw, add_systems};
