//! Validation cases, and the one list of all cases.

use anyhow::Result;
use meshless_engine::plugin::Registry;

use crate::check::Check;
use crate::{contact, coupled, exact, fluids, solids};

/// A case with a known answer.
pub struct Case {
    /// Identifier, such as `S11`.
    pub id: &'static str,
    /// Title, in one line.
    pub title: &'static str,
    /// Resolutions that show convergence, ascending: particles across the smallest dimension.
    pub resolutions: &'static [usize],
    /// The cheapest meaningful resolution, which tests run.
    pub ci_resolution: usize,
    /// Runs it at a resolution.
    pub run: fn(&Registry, usize) -> Result<Vec<Check>>,
}

/// Passes the list of all cases, `<id> <group>::<file>::<constant>;`, to the macro of that name, which
/// generates [`CASES`] and the tests.
#[macro_export]
macro_rules! for_each_case {
    ($then:ident) => {
        $then! {
            K1 exact::kernels::CASE;
            K2 exact::invariants::AFFINE;
            K3 exact::invariants::GRADIENT;
            K4 exact::invariants::PAIR_TERM;
            K5 exact::neighbor_lists::CASE;
            K6 exact::invariants::THROWN;
            M1 exact::laws::STRETCH;
            M5 exact::laws::CONSISTENCY;
            M2 exact::uniaxial_strain::CASE;
            M3 exact::johnson_cook::CASE;
            M4 exact::jaumann_shear::CASE;
            S1 solids::patch::CASE;
            S2 solids::cantilever::CASE;
            S3 solids::cantilever_large::CASE;
            S5 solids::rubber_pull::CASE;
            S6 solids::taylor_plane::CASE;
            S7 solids::tensile_failure::CASE;
            S8 solids::oscillating_plate::CASE;
            S9 solids::turek_hron::CASE;
            S10 solids::cook_membrane::CASE;
            S11 solids::bending_column::CASE;
            S12 solids::twisting_column::CASE;
            S13 solids::taylor_bars::COPPER;
            S14 solids::taylor_bars::STEEL;
            S15 solids::taylor_bars::ALUMINIUM;
            S4 solids::punch::CASE;
            S16 solids::elastic_bar::CASE;
            S17 solids::rubber_rings::CASE;
            S18 solids::bending_cylinder::CASE;
            S19 solids::quarter_punch::CASE;
            S21 solids::upsetting::CASE;
            S22 solids::bar_impact::CASE;
            S23 solids::pressurised::RING;
            S23b solids::pressurised::TUBE;
            S23c solids::pressurised::SPHERE;
            S23d solids::plate_with_hole::CASE;
            S24 solids::taylor_soft::CASE;
            S25 solids::taylor_sticking::CASE;
            K2U solids::updated_lagrangian::AFFINE;
            K3U solids::updated_lagrangian::GRADIENT;
            K4U solids::updated_lagrangian::PAIR_TERM;
            K6U solids::updated_lagrangian::THROWN;
            M5U exact::laws::OF_BODIES;
            S2U solids::updated_lagrangian::CANTILEVER;
            S8U solids::updated_lagrangian::PLATE;
            S9U solids::updated_lagrangian::FLAG;
            S11U solids::updated_lagrangian::COLUMN;
            S12U solids::updated_lagrangian::TWISTED;
            S13U solids::updated_lagrangian::COPPER;
            S15U solids::updated_lagrangian::ALUMINIUM;
            S20 solids::eulerian::TENSION;
            K2E solids::eulerian::AFFINE;
            K4E solids::eulerian::PAIR_TERM;
            K6E solids::eulerian::THROWN;
            M4E solids::eulerian::SHEAR;
            S1E solids::patch::EULERIAN;
            S1U solids::patch::UPDATED;
            S8E solids::eulerian::PLATE;
            S9E solids::eulerian::FLAG;
            S11E solids::eulerian::COLUMN;
            S15E solids::eulerian::ALUMINIUM;
            S21E solids::eulerian::UPSETTING;
            C1 contact::hertz::CASE;
            C2 contact::incline::CASE;
            C3 contact::restitution::CASE;
            C4 contact::rebound::CASE;
            C5 contact::metal_cutting::CASE;
            C6 contact::touching_surfaces::CASE;
            C6b contact::four_point::CASE;
            F1 fluids::hydrostatic_tank::CASE;
            F2 fluids::laminar_flows::CASE;
            F3 fluids::elliptic_drop::CASE;
            F4 fluids::waves::CASE;
            F5 fluids::dam_front::CASE;
            F5b fluids::dam_break::CASE;
            F6 fluids::lid_driven_cavity::CASE;
            F7 fluids::dam_break_box::CASE;
            F8 fluids::floating_box::CASE;
            F9 fluids::rotating_patch::CASE;
            F10 fluids::moving_square::CASE;
            F11 fluids::cylinder_in_channel::CASE;
            F12 fluids::rotating_flows::CASE;
            F13 fluids::vortices::CASE;
            F14 fluids::wedge_entry::CASE;
            F15 fluids::level_at_rest::CASE;
            F16 fluids::cylinder_array::CASE;
            X1 coupled::water_on_plate::CASE;
            X2 coupled::dam_break_obstacle::CASE;
            X3 coupled::elastic_gate::CASE;
            X4 coupled::abrasive_flow::CASE;
            X5 coupled::closed_box::CASE;
            X6 coupled::viscous_layers::CASE;
        }
    };
}

macro_rules! list {
    ($($id:ident $case:path;)*) => {
        /// All cases.
        pub const CASES: &[Case] = &[$($case),*];
    };
}

for_each_case!(list);
