//! What a case is, and the one list of all cases.

use anyhow::Result;
use meshless_engine::plugin::Registry;

use super::check::Check;

/// A case with a known answer.
pub struct Case {
    /// Its identity, such as `S11`.
    pub id: &'static str,
    /// What it is, in one line.
    pub title: &'static str,
    /// Resolutions that show convergence, ascending: particles across the smallest dimension.
    pub resolutions: &'static [usize],
    /// The cheapest meaningful resolution, which tests run.
    pub ci_resolution: usize,
    /// Runs it at a resolution.
    pub run: fn(&Registry, usize) -> Result<Vec<Check>>,
}

/// Hands the list of all cases, `<id> <file>::<constant>;`, to the macro of that name: [`CASES`] and the tests are made of it.
#[macro_export]
macro_rules! for_each_case {
    ($then:ident) => {
        $then! {
            K1 kernels::CASE;
            K2 invariants::AFFINE;
            K3 invariants::GRADIENT;
            K4 invariants::PAIR_TERM;
            K5 neighbor_lists::CASE;
            K6 invariants::THROWN;
            M1 laws::STRETCH;
            M5 laws::CONSISTENCY;
            M2 uniaxial_strain::CASE;
            M3 johnson_cook::CASE;
            M4 jaumann_shear::CASE;
            S1 patch::CASE;
            S2 cantilever::CASE;
            S3 cantilever_large::CASE;
            S5 rubber_pull::CASE;
            S6 taylor_plane::CASE;
            S7 tensile_failure::CASE;
            S8 oscillating_plate::CASE;
            S9 turek_hron::CASE;
            S10 cook_membrane::CASE;
            S11 bending_column::CASE;
            S12 twisting_column::CASE;
            S13 taylor_bars::COPPER;
            S14 taylor_bars::STEEL;
            S15 taylor_bars::ALUMINIUM;
            S4 punch::CASE;
            S16 elastic_bar::CASE;
            S17 rubber_rings::CASE;
            S18 bending_cylinder::CASE;
            S19 quarter_punch::CASE;
            S21 upsetting::CASE;
            S22 bar_impact::CASE;
            S23 thick_ring::CASE;
            S23b pressurised::TUBE;
            S23c pressurised::SPHERE;
            S23d plate_with_hole::CASE;
            K2U updated_lagrangian::AFFINE;
            K3U updated_lagrangian::GRADIENT;
            K4U updated_lagrangian::PAIR_TERM;
            K6U updated_lagrangian::THROWN;
            S2U updated_lagrangian::CANTILEVER;
            S8U updated_lagrangian::PLATE;
            S9U updated_lagrangian::FLAG;
            S11U updated_lagrangian::COLUMN;
            S12U updated_lagrangian::TWISTED;
            S13U updated_lagrangian::COPPER;
            S15U updated_lagrangian::ALUMINIUM;
            S20 eulerian::TENSION;
            K2E eulerian::AFFINE;
            K4E eulerian::PAIR_TERM;
            K6E eulerian::THROWN;
            M4E eulerian::SHEAR;
            S1E patch::EULERIAN;
            S8E eulerian::PLATE;
            S9E eulerian::FLAG;
            S11E eulerian::COLUMN;
            S15E eulerian::ALUMINIUM;
            S21E eulerian::UPSETTING;
            C1 hertz::CASE;
            C2 incline::CASE;
            C3 restitution::CASE;
            C4 rebound::CASE;
            C5 metal_cutting::CASE;
            C6 touching_surfaces::CASE;
            C6b four_point::CASE;
            F1 hydrostatic_tank::CASE;
            F2 laminar_flows::CASE;
            F3 elliptic_drop::CASE;
            F4 waves::CASE;
            F5 dam_front::CASE;
            F5b dam_break::CASE;
            F6 lid_driven_cavity::CASE;
            F7 dam_break_box::CASE;
            F8 floating_box::CASE;
            F9 rotating_patch::CASE;
            F10 moving_square::CASE;
            F12 rotating_flows::CASE;
            F13 vortices::CASE;
            F14 wedge_entry::CASE;
            F15 level_at_rest::CASE;
            X1 water_on_plate::CASE;
            X2 dam_break_obstacle::CASE;
            X4 abrasive_flow::CASE;
            X5 closed_box::CASE;
            X6 viscous_layers::CASE;
        }
    };
}

macro_rules! list {
    ($($id:ident $file:ident::$case:ident;)*) => {
        /// All cases.
        pub const CASES: &[Case] = &[$(super::$file::$case),*];
    };
}

for_each_case!(list);
