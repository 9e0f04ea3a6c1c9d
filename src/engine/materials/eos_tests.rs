//! Equations of state against closed forms and a fine integration.

use glam::{DMat3, DVec3};

use super::specimen::MaterialSpecimen;
use super::{Hardening, J2, MaterialModel, PressureLaw, SolidEos};
use crate::world::{InternalEnergy, PlasticWork};

const BULK: f64 = 137.0e9;
const DENSITY: f64 = 8930.0;
const SPEED: f64 = 3940.0;
const SLOPE: f64 = 1.489;
const GAMMA: f64 = 1.99;

fn shock() -> PressureLaw {
    let eos = SolidEos::MieGrueneisen { sound_speed: Some(SPEED), slope: SLOPE, gamma: GAMMA };
    eos.pressure(BULK, DENSITY).expect("valid parameters")
}

fn close(found: f64, wanted: f64, tolerance: f64) {
    assert!((found - wanted).abs() <= tolerance * wanted.abs(), "{found} instead of {wanted}");
}

#[test]
fn on_the_hugoniot_the_jump_conditions_hold() {
    // u_s = c + s u_p; mass: 1 - J = u_p/u_s; momentum: p = rho_0 u_s u_p; energy: E = p (1 - J)/2.
    for u in [1.0, 50.0, 300.0, 1000.0, 2000.0] {
        let shock_speed = SPEED + SLOPE * u;
        let j = 1.0 - u / shock_speed;
        let p = DENSITY * shock_speed * u;
        let law = shock();
        close(law.cold(j) + law.gamma() * 0.5 * p * (1.0 - j), p, 1e-12);
    }
}

#[test]
fn closed_forms_of_the_others() {
    let linear = SolidEos::Linear.pressure(BULK, DENSITY).expect("no parameters");
    let polynomial = SolidEos::Polynomial { c1: None, c2: 175.0e9, c3: 564.0e9, gamma: 0.0 };
    let polynomial = polynomial.pressure(BULK, DENSITY).expect("valid parameters");
    for j in [0.7f64, 0.9, 0.999, 1.0, 1.05, 1.3] {
        let mu = 1.0 / j - 1.0;
        close(linear.cold(j), BULK * mu, 1e-12);
        let square = if mu > 0.0 { 175.0e9 * mu * mu } else { 0.0 };
        close(polynomial.cold(j), BULK * mu + square + 564.0e9 * mu.powi(3), 1e-12);
        close(PressureLaw::Logarithmic { bulk: BULK }.cold(j) * j, -BULK * j.ln(), 1e-12);
    }
    assert!(shock().cold(1.0 - 1.0 / SLOPE).is_infinite());
}

#[test]
fn stored_work_is_the_integral_of_the_pressure() {
    for law in [PressureLaw::Logarithmic { bulk: BULK }, PressureLaw::Linear { bulk: BULK }] {
        for j in [0.8f64, 1.2] {
            let (mut sum, steps) = (0.0, 2000);
            let width = (j - 1.0) / f64::from(steps);
            for k in 0..steps {
                sum -= law.cold(1.0 + width * (f64::from(k) + 0.5)) * width;
            }
            close(law.stored(j).expect("a closed form"), sum, 1e-6);
        }
    }
}

#[test]
fn waves_are_faster_where_the_hugoniot_is_steeper() {
    // Without energy: J p = rho c^2 J x/(1 - s x)^2, x = 1 - J; -J d(J p)/dJ by hand.
    let law = PressureLaw::Shock { bulk: BULK, slope: SLOPE, gamma: 0.0 };
    let j: f64 = 0.8;
    let x = 1.0 - j;
    let rest = 1.0 - SLOPE * x;
    let slope = -(1.0 - 2.0 * x) / rest.powi(2) - 2.0 * SLOPE * j * x / rest.powi(3);
    close(law.stiffening(j), -j * slope, 1e-4);
    close(PressureLaw::Logarithmic { bulk: BULK }.stiffening(0.5), 1.0, 1e-6);
}

#[test]
fn slow_compression_follows_the_isentrope_and_the_books_close() {
    let eos = Some(SolidEos::MieGrueneisen { sound_speed: Some(SPEED), slope: SLOPE, gamma: GAMMA });
    let hardening = Hardening::Perfect { yield_stress: 1.0e9 };
    let model = J2 {
        density: DENSITY,
        young: None,
        poisson: None,
        bulk: Some(BULK),
        shear: Some(47.0e9),
        hardening,
        heating: None,
        eos,
    };
    let mut specimen = MaterialSpecimen::new(model.build().expect("valid parameters"));
    // Without change of shape there is no plastic work: dE = -p dJ, integrated here with 100 times finer
    // steps.
    let end: f64 = 0.8;
    let side = |t: f64| (1.0 + (end - 1.0) * t).cbrt();
    specimen.follow(|t| DMat3::from_diagonal(DVec3::splat(side(t))), 1000, 1.0);
    let law = shock();
    let (mut energy, steps) = (0.0, 100_000);
    let width = (end - 1.0) / f64::from(steps);
    for k in 0..steps {
        let middle = 1.0 + width * (f64::from(k) + 0.5);
        let before = law.cold(middle) + GAMMA * energy;
        energy -= (before - GAMMA * 0.5 * before * width) * width;
    }
    close(specimen.get::<InternalEnergy>().0, energy, 1e-5);
    assert_eq!(specimen.get::<PlasticWork>().0, 0.0);
    close(specimen.work, specimen.energy, 1e-5);
    // With it, what is stored and what is dissipated are together the work.
    specimen.follow(
        |t| DMat3::from_diagonal(DVec3::new(side(1.0) * (1.0 + 0.2 * t), side(1.0), side(1.0))),
        2000,
        1.0,
    );
    assert!(specimen.get::<PlasticWork>().0 > 1e7);
    close(specimen.work, specimen.energy + specimen.plastic_work, 1e-5);
}
