//! Names of the data, other than columns, that the systems of a flow share, for their declared access.

use super::flow_cloud::FlowCloud;
use crate::schedule::Shareable;

/// Position, volume, velocity and pressure of every particle of a flow
/// ([`FlowParticle`](crate::formulations::fluid::FlowParticle)).
pub const FLOW_RECORDS: &str = "flow_records";
/// Factor of pressures in sums over pairs.
pub const PRESSURE_FACTOR: &str = "pressure_factor";
/// Rates of compression of fluid particles.
pub const COMPRESSION_RATES: &str = "compression_rates";
/// Fluid particles that boundaries repel.
pub const REPELLED: &str = "repelled_particles";
/// Faces and particles at edges between walls that move against each other.
pub const EDGES: &str = "wall_edges";
/// Fluid particles past the ends of walls.
pub const ENDS: &str = "wall_ends";
/// Forces on boundary particles beside gaps that no particle of a fluid fits into.
pub const GAP_FORCES: &str = "gap_forces";
/// Accelerations of fluid particles by loads.
pub const FLOW_LOADS: &str = "flow_loads";
/// Places of the particles of bodies that take sub-steps, at the start of the long one.
pub const PLACES_BEFORE: &str = "places_before";
/// Spins of fluid particles.
pub const SPINS: &str = "fluid_spins";

impl Shareable for FlowCloud {
    const ROWS: &'static [&'static str] = &[
        FLOW_RECORDS,
        COMPRESSION_RATES,
        PRESSURE_FACTOR,
        REPELLED,
        EDGES,
        ENDS,
        GAP_FORCES,
        FLOW_LOADS,
        PLACES_BEFORE,
        SPINS,
    ];
}
