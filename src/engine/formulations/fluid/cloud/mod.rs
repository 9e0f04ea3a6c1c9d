//! All particles of a flow as one cloud that is packed, searched and sorted in the course of the run.

mod group;

mod shared;

mod parts;

mod viscosities;

mod neighborhood;

mod repelled;

mod edges;

mod wall_end;

mod other_particles;

mod flow_cloud;

mod pack;

mod near;

mod row_pass;

mod row_blocks;

mod arrangement;

mod rows;

mod surroundings;

mod loads;

mod sort;

mod neighbors;

mod others;

pub use arrangement::{ArrangementPass, add_arrangement};
pub use edges::{BoundaryEdges, EdgeParticle, Front};
pub use flow_cloud::{FlowCloud, MIN_SHARE, Near};
pub use group::{BoundarySurface, FluidState, Group, Role};
pub use near::{part, take_until};
pub use neighborhood::{Cluster, Neighborhood};
pub use neighbors::{ListPosition, NEIGHBORS, Neighbors};
pub use other_particles::OtherParticles;
pub use parts::{ACCOUNTS, PARTS};
pub use repelled::{LoadCarrier, Repelled, Shares};
pub use row_pass::{NearPairs, RowPass};
pub use rows::RowSums;
pub use shared::{
    COMPRESSION_RATES, EDGES, ENDS, FLOW_LOADS, FLOW_RECORDS, GAP_FORCES, PLACES_BEFORE, PRESSURE_FACTOR,
    REPELLED, SPINS,
};
pub use surroundings::smallest_eigenvalue;
pub use viscosities::{NONE, PLAIN, Viscosities, WITH_SPIN, is_viscous};
pub use wall_end::WallEnd;
