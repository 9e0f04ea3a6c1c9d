//! Cases X: solids and rigid bodies in flows, fluids of several layers.

pub mod abrasive_flow;
pub mod closed_box;
pub mod dam_break_obstacle;
pub mod elastic_gate;
pub mod viscous_layers;
pub mod water_on_plate;
