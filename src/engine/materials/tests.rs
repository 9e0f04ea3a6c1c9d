//! Hyperelastic laws against closed forms, stress against energy, frame indifference.

use glam::{DMat3, DQuat, DVec3};

use super::{
    DecoupledNeoHookean, Law, Material, MaterialModel, NeoHookean, StVenantKirchhoff, StateRows, StressRows,
};

const YOUNG: f64 = 1000.0;
const POISSON: f64 = 0.3;

fn stress_and_energy(material: &Material, deformation: DMat3) -> (DMat3, f64) {
    let (mut stress, mut energy, mut modulus) = ([DMat3::ZERO], [0.0], [0.0]);
    let Law::Solid(law) = &material.law else { panic!("a solid") };
    law.stress(&mut StressRows {
        dt: 0.0,
        deformation: &[deformation],
        share: &[1.0],
        stress_before: &[DMat3::ZERO],
        stress: &mut stress,
        energy: &mut energy,
        modulus: &mut modulus,
        strength: &mut [f64::INFINITY],
        plastic_work: &mut [0.0],
        state: StateRows::default(),
    });
    (stress[0], energy[0])
}

fn neo_hookean(poisson: f64) -> Material {
    let model =
        NeoHookean { density: 1.0, young: Some(YOUNG), poisson: Some(poisson), bulk: None, shear: None };
    model.build().expect("valid constants")
}

fn laws() -> [Material; 3] {
    let (density, young, poisson, bulk, shear) = (1.0, Some(YOUNG), Some(POISSON), None, None);
    [
        neo_hookean(POISSON),
        StVenantKirchhoff { density, young, poisson, bulk, shear }.build().expect("valid constants"),
        DecoupledNeoHookean { density, young, poisson, bulk, shear }.build().expect("valid constants"),
    ]
}

fn lame() -> (f64, f64, f64) {
    let shear = YOUNG / (2.0 * (1.0 + POISSON));
    let bulk = YOUNG / (3.0 * (1.0 - 2.0 * POISSON));
    (bulk - 2.0 / 3.0 * shear, shear, bulk)
}

fn assert_close(found: f64, wanted: f64, tolerance: f64) {
    assert!((found - wanted).abs() <= tolerance, "{found} instead of {wanted}");
}

#[test]
fn neo_hookean_uniaxial_tension_and_compression() {
    // E, nu, stretch, then lateral stretch, J, P, Cauchy stress in plane strain and the first three of
    // uniaxial stress.
    let reference = include_str!("../../../assets/reference/neo_hookean_uniaxial.csv");
    let mut rows = 0;
    for line in reference.lines().filter(|line| !line.starts_with(['#', 'E'])) {
        let row: Vec<f64> = line.split(',').map(|text| text.parse().expect("a number")).collect();
        let (poisson, stretch) = (row[1], row[2]);
        if !(0.5..=6.0).contains(&stretch) {
            continue;
        }
        rows += 1;
        let material = neo_hookean(poisson);
        // The lateral stretch has nine digits; its error times the stiffness is an error of the stress.
        let tolerance = 1e-6 * row[5].abs().max(YOUNG);
        let (plane, _) = stress_and_energy(&material, DMat3::from_diagonal(DVec3::new(row[3], stretch, 1.0)));
        assert_close(plane.y_axis.y, row[5], tolerance);
        assert_close(plane.x_axis.x, 0.0, tolerance);
        assert_close(row[3] * stretch, row[4], 1e-6 * row[4]);
        assert_close(plane.y_axis.y * stretch / row[4], row[6], 1e-6 * row[6].abs().max(YOUNG));
        let (space, _) =
            stress_and_energy(&material, DMat3::from_diagonal(DVec3::new(row[7], stretch, row[7])));
        assert_close(space.y_axis.y, row[8], 1e-6 * row[8].abs().max(YOUNG));
        assert_close(space.x_axis.x, 0.0, tolerance);
        assert_close(space.z_axis.z, 0.0, tolerance);
    }
    assert!(rows >= 14, "{rows} rows");
}

#[test]
fn uniaxial_strain_of_every_law() {
    let (lambda, mu, bulk) = lame();
    for s in [0.5f64, 0.8, 1.0, 1.3, 2.0, 3.0, 6.0] {
        let deformation = DMat3::from_diagonal(DVec3::new(1.0, s, 1.0));
        let log = s.ln();
        let spherical = bulk * s * (s - 1.0);
        let deviatoric = mu * s.powf(-2.0 / 3.0) * (s * s - 1.0) / 3.0;
        let wanted = [
            (mu * (s - 1.0 / s) + lambda * log / s, lambda * log),
            (0.5 * (lambda + 2.0 * mu) * s * (s * s - 1.0), 0.5 * lambda * (s * s - 1.0)),
            ((2.0 * deviatoric + spherical) / s, spherical - deviatoric),
        ];
        for (material, (along, across)) in laws().iter().zip(wanted) {
            let (stress, _) = stress_and_energy(material, deformation);
            let tolerance = 1e-12 * (YOUNG + along.abs());
            assert_close(stress.y_axis.y, along, tolerance);
            assert_close(stress.x_axis.x, across, tolerance);
            assert_close(stress.z_axis.z, across, tolerance);
        }
    }
}

#[test]
fn st_venant_kirchhoff_in_plane_strain_tension() {
    // With no stress across: P = E / (1 - nu^2) s (s^2 - 1) / 2.
    let [_, material, _] = laws();
    for s in [0.5f64, 0.9, 1.1, 1.5, 1.8] {
        let lateral = (1.0 - POISSON / (1.0 - POISSON) * (s * s - 1.0)).sqrt();
        let (stress, _) = stress_and_energy(&material, DMat3::from_diagonal(DVec3::new(lateral, s, 1.0)));
        assert_close(
            stress.y_axis.y,
            YOUNG / (1.0 - POISSON * POISSON) * s * 0.5 * (s * s - 1.0),
            1e-9 * YOUNG,
        );
        assert_close(stress.x_axis.x, 0.0, 1e-9 * YOUNG);
    }
}

/// Deformation gradients with stretch, shear and rotation.
fn deformations() -> Vec<DMat3> {
    let turn = DMat3::from_quat(DQuat::from_axis_angle(DVec3::new(1.0, -2.0, 0.5).normalize(), 0.7));
    let sheared =
        DMat3::from_cols(DVec3::new(1.4, 0.1, -0.2), DVec3::new(0.3, 0.7, 0.1), DVec3::new(-0.1, 0.2, 1.1));
    let stretched =
        DMat3::from_cols(DVec3::new(3.1, 0.4, 0.0), DVec3::new(-0.2, 0.8, 0.0), DVec3::new(0.0, 0.0, 1.0));
    vec![DMat3::IDENTITY, sheared, stretched, turn * sheared, sheared * 0.6]
}

#[test]
fn stress_is_the_derivative_of_the_energy() {
    for material in laws() {
        for deformation in deformations() {
            let (stress, _) = stress_and_energy(&material, deformation);
            for (row, column) in (0..3).flat_map(|row| (0..3).map(move |column| (row, column))) {
                let step = 1e-5;
                let energy = |by: f64| {
                    let mut moved = deformation;
                    moved.col_mut(column)[row] += by;
                    stress_and_energy(&material, moved).1
                };
                // Fourth-order central difference.
                let slope = (8.0 * (energy(step) - energy(-step))
                    - (energy(2.0 * step) - energy(-2.0 * step)))
                    / (12.0 * step);
                let scale = YOUNG.max(stress.to_cols_array().into_iter().fold(0.0, |a, b| b.abs().max(a)));
                assert_close(stress.col(column)[row], slope, 1e-6 * scale);
            }
        }
    }
}

#[test]
fn a_rotation_of_the_deformed_body_rotates_the_stress() {
    let turn = DMat3::from_quat(DQuat::from_axis_angle(DVec3::new(0.3, 1.0, -0.4).normalize(), 2.1));
    for material in laws() {
        for deformation in deformations() {
            let (stress, energy) = stress_and_energy(&material, deformation);
            let (turned, turned_energy) = stress_and_energy(&material, turn * deformation);
            assert_close(turned_energy, energy, 1e-10 * energy.abs().max(YOUNG));
            let scale = YOUNG.max(stress.to_cols_array().into_iter().fold(0.0, |a, b| b.abs().max(a)));
            assert!(
                turned.abs_diff_eq(turn * stress, 1e-12 * scale),
                "{turned} instead of {}",
                turn * stress
            );
        }
    }
}

#[test]
fn a_rotated_body_is_free_of_stress() {
    let turn = DMat3::from_quat(DQuat::from_axis_angle(DVec3::Z, 1.2));
    for material in laws() {
        let (stress, energy) = stress_and_energy(&material, turn);
        assert!(stress.abs_diff_eq(DMat3::ZERO, 1e-12 * YOUNG), "{stress}");
        assert_close(energy, 0.0, 1e-12 * YOUNG);
    }
}
