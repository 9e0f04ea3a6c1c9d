//! From the contacts of a scene to the systems that compute them.

mod body;

mod checks;

mod images;

mod skins_of;

mod pairs;

mod start;

mod systems;

pub use pairs::MakeLaw;
pub use systems::add_systems;
