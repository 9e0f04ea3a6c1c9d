//! Boundaries of a fluid: pressure, shape, and repulsion of single particles.

mod wall;

mod body_motion;

mod surface_distance;

mod repulsion;

mod wall_compression;

mod wall_pressure;

mod wall_blocks;

mod wall_state;

mod own_motion;

mod edges;

mod ends;

mod gaps;

pub use edges::{EdgeForces, EdgeMotion, WallShapes};
pub use ends::WallEnds;
pub use gaps::GapPressure;
pub use own_motion::SeenMotions;
pub use repulsion::{BeforeSphere, RangeShortfall, Repulsion};
pub use surface_distance::apart;
pub use wall::{PreviousVelocity, Slip, Wall, WallBody, has_suction};
pub use wall_compression::WallCompression;
pub use wall_state::WallState;
