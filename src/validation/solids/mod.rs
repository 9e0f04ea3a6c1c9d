//! Cases S: solids.

pub mod bar_impact;
pub mod bending_column;
pub mod bending_cylinder;
pub mod cantilever;
pub mod cantilever_large;
pub mod cook_membrane;
pub mod elastic_bar;
pub mod eulerian;
pub mod oscillating_plate;
pub mod patch;
pub mod plate_with_hole;
pub mod pressurised;
pub mod punch;
pub mod quarter_punch;
pub mod rubber_pull;
pub mod rubber_rings;
pub mod taylor;
pub mod taylor_bars;
pub mod taylor_plane;
pub mod taylor_soft;
pub mod taylor_sticking;
pub mod tensile_failure;
pub mod turek_hron;
pub mod twisting_column;
pub mod updated_lagrangian;
pub mod upsetting;
