//! J2 plasticity against closed forms, its energy balance, frame indifference, and the return mapping.

use glam::{DMat3, DQuat, DVec3};
use proptest::prelude::*;

use super::specimen::MaterialSpecimen;
use super::{Hardening, Heating, J2, JohnsonCookFlow, Material, MaterialModel, Trial};
use crate::world::{InversePlasticCauchyGreen, PlasticStrain, Temperature, ViscousPower, YieldStress};

const BULK: f64 = 69.0e9;
const SHEAR: f64 = 26.5e9;
const YIELD: f64 = 164.0e6;

fn metal(hardening: Hardening) -> Material {
    let heating = Some(Heating { specific_heat: Some(885.0), taylor_quinney: 0.9, temperature: 292.0 });
    let (bulk, shear) = (Some(BULK), Some(SHEAR));
    let model =
        J2 { density: 2800.0, young: None, poisson: None, bulk, shear, hardening, heating, eos: None };
    model.build().unwrap_or_else(|error| panic!("{error}"))
}

fn flow() -> JohnsonCookFlow {
    JohnsonCookFlow {
        a: YIELD,
        b: 211.0e6,
        n: 0.465,
        c: 0.002,
        m: 1.419,
        reference_rate: 1.0,
        reference_temperature: 292.0,
        melt_temperature: 925.0,
    }
}

fn all() -> [Hardening; 5] {
    [
        Hardening::Perfect { yield_stress: YIELD },
        Hardening::Linear { yield_stress: YIELD, modulus: 1.0e9 },
        Hardening::Power { yield_stress: YIELD, coefficient: 211.0e6, exponent: 0.465 },
        Hardening::Voce { yield_stress: YIELD, saturation: 120.0e6, rate: 15.0 },
        Hardening::JohnsonCook(flow()),
    ]
}

fn close(found: f64, wanted: f64, tolerance: f64) {
    assert!((found - wanted).abs() <= tolerance, "{found} instead of {wanted}");
}

#[test]
fn uniaxial_strain_loading_and_unloading() {
    // q = 2 mu |ln s| until yield; then q = sy + H ep with ep = (2 mu e - sy)/(3 mu + H) where e = |ln s| and
    // 2 mu e is q of the elastic state; unloading by 2 q / (2 mu) of strain brings reverse yield.
    let modulus = 1.0e9;
    let mut specimen = MaterialSpecimen::new(metal(Hardening::Linear { yield_stress: YIELD, modulus }));
    let along = |strain: f64| DMat3::from_diagonal(DVec3::new((-strain).exp(), 1.0, 1.0));
    let mut check = |strain: f64, plastic: f64, equivalent: f64, sign: f64| {
        let tau = specimen_at(&mut specimen, along(strain));
        close(specimen.get::<PlasticStrain>().0, plastic, 1e-12);
        close(tau.y_axis.y - tau.x_axis.x, sign * equivalent, 1e-6 * YIELD);
        close(-(tau.x_axis.x + 2.0 * tau.y_axis.y) / 3.0, BULK * strain, 1e-9 * BULK);
        close(tau.y_axis.y, tau.z_axis.z, 1e-6);
    };
    check(0.5 * YIELD / (2.0 * SHEAR), 0.0, 0.5 * YIELD, 1.0);
    let loaded = |e: f64| {
        let plastic = (2.0 * SHEAR * e - YIELD) / (3.0 * SHEAR + modulus);
        (plastic, YIELD + modulus * plastic)
    };
    for e in [0.01, 0.03, 0.05] {
        let (plastic, q) = loaded(e);
        check(e, plastic, q, 1.0);
    }
    let (plastic, q) = loaded(0.05);
    check(0.05 - 0.5 * q / (2.0 * SHEAR), plastic, 0.5 * q, 1.0);
    check(0.05 - 2.0 * q / (2.0 * SHEAR), plastic, q, -1.0);
    let more = (0.01 * 2.0 * SHEAR) / (3.0 * SHEAR + modulus);
    check(0.05 - 2.0 * q / (2.0 * SHEAR) - 0.01, plastic + more, q + modulus * more, -1.0);
}

fn specimen_at(specimen: &mut MaterialSpecimen, deformation: DMat3) -> DMat3 {
    specimen.step(deformation, 1e-3);
    specimen.kirchhoff()
}

/// A path with shear, stretch and rotation that ends unloaded by a little.
fn path(t: f64) -> DMat3 {
    let turn = DMat3::from_quat(DQuat::from_axis_angle(DVec3::new(1.0, -2.0, 0.5).normalize(), 1.3 * t));
    let s = 0.4 * (t - 0.2 * t * t);
    turn * DMat3::from_cols(DVec3::new(1.0 - s, 0.1 * s, 0.0), DVec3::new(0.9 * s, 1.0, 0.2 * s), DVec3::Z)
        * DMat3::from_diagonal(DVec3::new(1.0, 1.0 + s, 1.0))
}

#[test]
fn work_is_stored_or_dissipated_to_second_order_of_the_step() {
    for hardening in all() {
        let error = |steps: u32| {
            let mut specimen = MaterialSpecimen::new(metal(hardening));
            specimen.follow(path, steps, 1e-3);
            assert!(specimen.plastic_work > 0.1 * YIELD * specimen.get::<PlasticStrain>().0);
            (specimen.work - specimen.energy - specimen.plastic_work) / specimen.work
        };
        let (coarse, fine) = (error(500).abs(), error(1000).abs());
        assert!(fine < 1e-4, "{hardening:?}: {coarse} then {fine}");
        assert!(coarse / fine > 3.0, "{hardening:?}: {coarse} then {fine}");
    }
}

#[test]
fn heat_is_the_share_of_the_plastic_work() {
    for hardening in all() {
        let mut specimen = MaterialSpecimen::new(metal(hardening));
        specimen.follow(path, 200, 1e-3);
        let wanted = 292.0 + 0.9 * specimen.plastic_work / (2800.0 * 885.0);
        close(specimen.get::<Temperature>().0, wanted, 1e-9);
    }
}

#[test]
fn plastic_flow_keeps_the_volume_and_the_stress_on_the_yield_surface() {
    for hardening in all() {
        let mut specimen = MaterialSpecimen::new(metal(hardening));
        specimen.follow(|t| path(0.9 * t), 300, 1e3);
        let determinant = specimen.get::<InversePlasticCauchyGreen>().0.determinant();
        close(determinant, 1.0, 1e-9);
        let tau = specimen.kirchhoff();
        let s = tau - DMat3::IDENTITY * ((tau.x_axis.x + tau.y_axis.y + tau.z_axis.z) / 3.0);
        let q = (1.5 * s.to_cols_array().iter().map(|c| c * c).sum::<f64>()).sqrt();
        // At this rate, 1e-3 1/s, the flow stress is the one of slow deformation.
        close(q, specimen.get::<YieldStress>().0, 2e-4 * YIELD);
        let strength = specimen.strength;
        assert_eq!(strength, specimen.get::<YieldStress>().0);
    }
}

#[test]
fn a_rotation_of_the_deformed_body_rotates_the_stress() {
    let turn = DMat3::from_quat(DQuat::from_axis_angle(DVec3::new(0.3, 1.0, -0.4).normalize(), 2.1));
    for hardening in all() {
        let (mut one, mut other) =
            (MaterialSpecimen::new(metal(hardening)), MaterialSpecimen::new(metal(hardening)));
        one.follow(path, 100, 1e-3);
        // Every other step is turned by a different rotation: the law must not see it.
        for k in 1..=100 {
            let t = f64::from(k) / 100.0;
            let q = DMat3::from_quat(DQuat::from_axis_angle(DVec3::Y, 20.0 * t));
            other.step(if k == 100 { turn * path(t) } else { q * path(t) }, 1e-5);
        }
        assert!(other.stress.abs_diff_eq(turn * one.stress, 1e-9 * BULK * 1e-3), "{hardening:?}");
        close(other.get::<PlasticStrain>().0, one.get::<PlasticStrain>().0, 1e-12);
    }
}

#[test]
fn nothing_changes_in_no_time() {
    let mut specimen = MaterialSpecimen::new(metal(Hardening::Perfect { yield_stress: YIELD }));
    specimen.step(path(1.0), 0.0);
    assert_eq!(specimen.get::<PlasticStrain>().0, 0.0);
    assert_eq!((specimen.plastic_work, specimen.strength), (0.0, f64::INFINITY));
}

proptest! {
    #![proptest_config(ProptestConfig { failure_persistence: None, ..ProptestConfig::with_cases(3000) })]

    #[test]
    fn the_return_ends_on_the_flow_stress(
        which in 0..5_usize, over in -9.0..2.0_f64, strain in -14.0..1.0_f64, dt in -12.0..3.0_f64, heat in 0.0..700.0_f64,
    ) {
        let hardening = all()[which];
        let (strain, dt, temperature) = (10_f64.powf(strain), 10_f64.powf(dt), 280.0 + heat);
        let start = hardening.static_stress(strain, temperature);
        let stress = start * (1.0 + 10_f64.powf(over)) + 1.0;
        let trial = Trial { stress, shear: SHEAR, strain, temperature, dt };
        let d = trial.increment(&hardening);
        let flow = hardening.flow_stress(strain, d, dt, temperature).value;
        prop_assert!(d >= 0.0);
        prop_assert!((stress - 3.0 * SHEAR * d - flow).abs() <= 1e-9 * stress, "{d}, rest {}", stress - 3.0 * SHEAR * d - flow);
    }
}

#[test]
fn a_return_from_what_is_no_number_is_none() {
    for hardening in all() {
        let trial = Trial { stress: f64::NAN, shear: SHEAR, strain: 0.1, temperature: 300.0, dt: 1e-6 };
        assert!(trial.increment(&hardening).is_nan());
        let trial = Trial { stress: 2.0 * YIELD, temperature: f64::NAN, ..trial };
        let d = trial.increment(&hardening);
        assert!(d.is_nan() || !hardening.needs_temperature());
    }
}

/// Just above the yield stress of a virgin metal the increment is `(excess / coefficient)^(1/exponent)`, of
/// any size.
#[test]
fn a_steep_beginning_is_found() {
    let coefficient = 5.0e8;
    for exponent in [0.05, 0.1, 0.2, 0.5, 0.9] {
        let hardening = Hardening::Power { yield_stress: YIELD, coefficient, exponent };
        for excess in [1.0e-3, 1.0, 1.0e3, 1.0e5, 1.0e7, 1.0e9] {
            let trial =
                Trial { stress: YIELD + excess, shear: SHEAR, strain: 0.0, temperature: 300.0, dt: 1e-6 };
            let d = trial.increment(&hardening);
            let rest = excess - 3.0 * SHEAR * d - coefficient * d.powf(exponent);
            assert!(d >= 0.0 && rest.abs() < 1e-11 * trial.stress, "{exponent} {excess}: {d} leaves {rest}");
        }
        let trial = Trial { stress: YIELD + 1e4, shear: SHEAR, strain: 0.0, temperature: 300.0, dt: 1e-6 };
        if exponent < 0.4 {
            let exact = (1e4 / coefficient).powf(1.0 / exponent);
            let found = trial.increment(&hardening);
            assert!(
                (found / exact - 1.0).abs() < 1e-3 / exponent || found == exact,
                "{exponent}: {found} {exact}"
            );
        }
    }
}

#[test]
fn a_metal_heated_from_outside_yields_at_its_flow_stress_when_hot() {
    // Half way to melting, without plastic strain, the flow stress is a (1 - 0.5^m), at the reference rate.
    let mut specimen =
        MaterialSpecimen::new(metal(Hardening::JohnsonCook(JohnsonCookFlow { c: 0.0, ..flow() })));
    specimen.set(Temperature(0.5 * (292.0 + 925.0)));
    let strength = YIELD * (1.0 - 0.5_f64.powf(1.419));
    let along =
        |share: f64| DMat3::from_diagonal(DVec3::new((share * strength / (2.0 * SHEAR)).exp(), 1.0, 1.0));
    specimen.step(along(0.999), 1e-3);
    close(specimen.get::<PlasticStrain>().0, 0.0, 0.0);
    close(specimen.get::<YieldStress>().0, strength, 1e-9 * strength);
    specimen.step(along(1.001), 1e-3);
    assert!(specimen.get::<PlasticStrain>().0 > 0.0);
}

#[test]
fn the_heat_of_pair_terms_warms_and_softens() {
    let mut specimen = MaterialSpecimen::new(metal(Hardening::JohnsonCook(flow())));
    specimen.set(ViscousPower(1e11));
    for _ in 0..10 {
        specimen.step(DMat3::IDENTITY, 1e-4);
    }
    let rise = 1e8 / (2800.0 * 885.0);
    close(specimen.get::<Temperature>().0, 292.0 + rise, 1e-9);
    let soft = YIELD * (1.0 - (rise / (925.0 - 292.0)).powf(1.419));
    close(specimen.get::<YieldStress>().0, soft, 1e-9 * soft);
}
