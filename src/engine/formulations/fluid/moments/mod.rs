//! Where the forces of a flow on boundaries act: at their surface, not at the particles below it.

mod cluster_forces;

mod friction;

mod pressure;

mod surface;

mod stretching;

pub use stretching::SurfaceStretching;
pub use surface::SurfaceMoments;
