//! Cases F: flows.

pub mod cylinder_array;
pub mod cylinder_in_channel;
pub mod dam_break;
pub mod dam_break_box;
pub mod dam_front;
pub mod elliptic_drop;
pub mod floating_box;
pub mod hydrostatic_tank;
pub mod laminar_flows;
pub mod level_at_rest;
pub mod lid_driven_cavity;
pub mod moving_square;
pub mod rotating_flows;
pub mod rotating_patch;
pub mod viscous_channel;
pub mod vortices;
pub mod waves;
pub mod wedge_entry;
