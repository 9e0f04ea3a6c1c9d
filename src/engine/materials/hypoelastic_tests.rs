//! The hypoelastic law: its heat, and bodies that start deformed.

use glam::{DMat3, DVec3};

use super::specimen::MaterialSpecimen;
use super::{Hardening, Heating, Hypoelastic, Law, Material, MaterialModel};
use crate::world::Temperature;

const DENSITY: f64 = 2800.0;
const BULK: f64 = 69.0e9;
const SHEAR: f64 = 26.5e9;
const HEATING: Heating = Heating { specific_heat: Some(885.0), taylor_quinney: 0.9, temperature: 292.0 };

fn metal(hardening: Option<Hardening>) -> Material {
    let model = Hypoelastic {
        density: DENSITY,
        bulk: Some(BULK),
        shear: Some(SHEAR),
        young: None,
        poisson: None,
        hardening,
        heating: Some(HEATING),
        eos: None,
    };
    model.build().unwrap_or_else(|error| panic!("{error}"))
}

#[test]
fn heat_is_the_share_of_the_plastic_work_of_the_reference_volume() {
    let mut specimen = MaterialSpecimen::new(metal(Some(Hardening::Perfect { yield_stress: 164.0e6 })));
    // Compressed to 0.8 of its volume as it is sheared.
    let path = |t: f64| DMat3::from_cols(DVec3::X * (1.0 - 0.2 * t), DVec3::new(t, 1.0, 0.0), DVec3::Z);
    specimen.follow(path, 2000, 1e-3);
    let rise = specimen.get::<Temperature>().0 - HEATING.temperature;
    let wanted = 0.9 * specimen.plastic_work / (DENSITY * 885.0);
    assert!(wanted > 20.0, "{wanted}");
    assert!((rise - wanted).abs() < 1e-10 * wanted, "{rise} of {wanted}");
}

#[test]
fn what_heats_the_metal_knows_its_specific_heat() {
    let Law::Solid(law) = metal(None).law else { panic!("not a solid") };
    assert_eq!(law.specific_heat(), Some(885.0));
}

#[test]
fn a_body_that_starts_stretched_and_turned_has_the_turned_stress_of_the_stretch() {
    for angle in [0.0_f64, 0.4, 1.57, 3.0, std::f64::consts::PI] {
        let turn = DMat3::from_rotation_z(angle);
        let stretches = DVec3::new(1.1, 0.95, 1.0);
        let mut specimen = MaterialSpecimen::new(metal(None));
        specimen.step(turn * DMat3::from_diagonal(stretches), 0.0);
        // Along axes that stay, the integral of 2 mu dev D is 2 mu dev ln U.
        let volume = stretches.element_product();
        let strain = stretches.map(f64::ln);
        let deviator = (strain - strain.element_sum() / 3.0) * (2.0 * SHEAR);
        let pressure = BULK * (1.0 / volume - 1.0);
        let cauchy = turn * DMat3::from_diagonal(deviator - pressure) * turn.transpose();
        let difference = specimen.kirchhoff() - cauchy * volume;
        let size = difference.to_cols_array().iter().fold(0.0_f64, |most, value| most.max(value.abs()));
        assert!(size < 1e-9 * SHEAR, "{angle}: {size}");
        // Nothing changes where F does not.
        let stress = specimen.stress;
        specimen.step(specimen.deformation, 0.0);
        assert_eq!(specimen.stress, stress);
    }
}
