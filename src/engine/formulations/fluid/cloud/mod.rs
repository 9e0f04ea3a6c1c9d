//! All particles that a fluid meets, as one cloud that is packed, searched and sorted in the course of the run.

mod viscosities;

mod flow_cloud;

mod pack;

mod near;

mod surroundings;

mod loads;

mod sort;

mod neighbors;

pub use flow_cloud::{FlowCloud, FluidState, Group, Near, Role, Surface};
pub use near::{FourNear, Fours, RowPass, part, take_until};
pub use neighbors::{NEIGHBORS, Neighbors};
pub use surroundings::{SmallestEigenvalue, smallest_eigenvalue};
pub use viscosities::{NONE, PLAIN, Viscosities, WITH_SPIN};
