//! Where things are in a recording.

use rerun::{EntityPath, EntityPathPart};

/// The entity of these names, whatever signs they hold.
pub fn entity<'a>(parts: impl IntoIterator<Item = &'a str>) -> EntityPath {
    EntityPath::new(parts.into_iter().map(EntityPathPart::new).collect())
}

/// All bodies.
pub fn bodies() -> EntityPath {
    entity(["bodies"])
}

/// The particles of a body.
pub fn body(name: &str) -> EntityPath {
    entity(["bodies", name])
}

/// A field of a body's particles, as numbers to read back.
pub fn field(body: &str, name: &str) -> EntityPath {
    entity(["bodies", body, name])
}

/// The surface of a body.
pub fn surface(body: &str) -> EntityPath {
    entity(["bodies", body, "surface"])
}

/// Where the particles of a body were in the first frame.
pub fn undeformed(body: &str) -> EntityPath {
    entity(["bodies", body, "undeformed"])
}

/// A time series: `energy/kinetic`.
pub fn series(name: &str) -> EntityPath {
    entity(name.split('/'))
}

/// The text of the scene.
pub fn scene() -> EntityPath {
    entity(["scene"])
}

/// Notes on the run.
pub fn notes() -> EntityPath {
    entity(["notes"])
}

/// Legend of the colours.
pub fn legend() -> EntityPath {
    entity(["legend"])
}

/// A part of it.
pub fn legend_part(name: &str) -> EntityPath {
    entity(["legend", name])
}

/// The title of the scene.
pub fn title() -> EntityPath {
    entity(["title"])
}
