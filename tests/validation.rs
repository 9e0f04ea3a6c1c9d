//! Every case of `meshless validate` at its cheapest meaningful resolution.

use meshless::cli::validate::CASES;
use meshless::standard_plugins;

fn passes(id: &str) {
    let case = CASES.iter().find(|case| case.id == id).expect("a known case");
    let checks =
        (case.run)(&standard_plugins(), case.ci_resolution).unwrap_or_else(|error| panic!("{id}: {error:#}"));
    assert!(!checks.is_empty());
    let failed: Vec<_> = checks.iter().filter(|check| !check.passes()).collect();
    assert!(failed.is_empty(), "{id}: {failed:#?}");
}

#[test]
fn m2_j2_in_uniaxial_strain() {
    passes("M2");
}

#[test]
fn m3_flow_stress_of_johnson_and_cook() {
    passes("M3");
}

#[test]
fn m4_jaumann_rate_in_simple_shear() {
    passes("M4");
}

#[test]
fn k1_kernels() {
    passes("K1");
}

#[test]
fn k2_affine_map() {
    passes("K2");
}

#[test]
fn k3_force_and_energy() {
    passes("K3");
}

#[test]
fn k4_pair_term() {
    passes("K4");
}

#[test]
fn k5_neighbor_lists() {
    passes("K5");
}

#[test]
fn k6_thrown_body() {
    passes("K6");
}

#[test]
fn m1_homogeneous_stretch() {
    passes("M1");
}

#[test]
fn m5_stress_and_rotation() {
    passes("M5");
}

#[test]
fn s1_breathing_patch() {
    passes("S1");
}

#[test]
fn s2_cantilever_stiffness() {
    passes("S2");
}

#[test]
fn s3_cantilever_large_deflection() {
    passes("S3");
}

#[test]
fn s5_rubber_pull() {
    passes("S5");
}

#[test]
fn s6_taylor_bar_in_plane_strain() {
    passes("S6");
}

#[test]
fn s7_tensile_failure() {
    passes("S7");
}

#[test]
fn s8_oscillating_plate() {
    passes("S8");
}

#[test]
fn s9_turek_hron() {
    passes("S9");
}

#[test]
fn s10_cook_membrane() {
    passes("S10");
}

#[test]
fn s11_bending_column() {
    passes("S11");
}

#[test]
fn s12_twisting_column() {
    passes("S12");
}

#[test]
fn s13_taylor_bar_of_copper() {
    passes("S13");
}

#[test]
fn s14_taylor_bar_of_steel() {
    passes("S14");
}

#[test]
fn s15_taylor_bar_of_aluminium() {
    passes("S15");
}

#[test]
fn s4_punch() {
    passes("S4");
}

#[test]
fn s22_impact_of_two_bars() {
    passes("S22");
}

#[test]
fn c1_hertz() {
    passes("C1");
}

#[test]
fn c2_incline() {
    passes("C2");
}

#[test]
fn c3_restitution() {
    passes("C3");
}

#[test]
fn c4_rebound() {
    passes("C4");
}

#[test]
fn f1_hydrostatic_tank() {
    passes("F1");
}

#[test]
fn f2_laminar_flows() {
    passes("F2");
}

#[test]
fn f3_elliptic_drop() {
    passes("F3");
}

#[test]
fn every_case_has_a_test_and_resolutions_that_rise() {
    let tests = include_str!("validation.rs");
    for case in CASES {
        assert!(tests.contains(&format!("passes(\"{}\")", case.id)), "{} has no test", case.id);
        assert!(case.resolutions.windows(2).all(|pair| pair[0] < pair[1]), "{}", case.id);
        assert!(case.resolutions.contains(&case.ci_resolution) || case.resolutions[0] > case.ci_resolution);
    }
}
