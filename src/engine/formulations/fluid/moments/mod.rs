//! The forces of a flow act at the surface of boundaries, and not at the particles below it.

mod cluster_forces;

mod whole_body;

mod friction;

mod pressure;

mod surface;

mod stretching;

pub use stretching::SurfaceStretching;
pub use surface::SurfaceMoments;
pub use whole_body::WholeBody;
