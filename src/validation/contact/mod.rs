//! Cases C: contact, friction, cutting.

pub mod four_point;
pub mod hertz;
pub mod incline;
pub mod metal_cutting;
pub mod rebound;
pub mod restitution;
pub mod touching_surfaces;
