//! One particle before, at and after failure: growth of damage, stress, and energy balance.

use glam::DMat3;
use meshless_engine::materials::{
    DecoupledNeoHookean, Hardening, Heating, Hypoelastic, J2, Law, MAX_STATE, Material, MaterialModel,
    NeoHookean, SolidEos, SolidLaw, StateColumns, StateRows, StressRows,
};
use meshless_engine::world::{ColumnSet, Damage, InternalEnergy, Temperature};

use crate::criterion::{Criterion, WatchedCriterion};
use crate::johnson_cook::JohnsonCookFailure;
use crate::law::FailingLaw;
use crate::softening::AfterFailure;
use crate::{FailureIndex, FractureEnergy};

const BULK: f64 = 2e9;
const SHEAR: f64 = 1e9;

/// A particle with its state, and the work that its stress has done.
struct Specimen {
    law: FailingLaw,
    columns: StateColumns,
    bytes: Vec<Vec<u8>>,
    f: DMat3,
    stress: [DMat3; 1],
    energy: [f64; 1],
    modulus: [f64; 1],
    work: f64,
    /// Plastic work that the law reports, J/m3.
    plastic_work: f64,
}

fn inner(material: Material) -> std::sync::Arc<dyn SolidLaw> {
    let Law::Solid(law) = material.law else { panic!("a solid") };
    law
}

fn rubber() -> Material {
    let model = DecoupledNeoHookean {
        density: 1000.0,
        young: None,
        poisson: None,
        bulk: Some(BULK),
        shear: Some(SHEAR),
    };
    model.build().unwrap()
}

impl Specimen {
    fn new(material: Material, criterion: Criterion, growth: f64, then: AfterFailure) -> Self {
        let inner = inner(material);
        let watch = WatchedCriterion::new(criterion, &*inner, "body").unwrap();
        let law = FailingLaw::new(watch, inner, growth, then);
        let mut set = ColumnSet::default();
        law.state(&mut set);
        let columns = StateColumns::new(&set).unwrap();
        let bytes = columns.as_slice().iter().map(|column| vec![0; column.element_size]).collect();
        let mut specimen = Self {
            law,
            columns,
            bytes,
            f: DMat3::IDENTITY,
            stress: [DMat3::ZERO],
            energy: [0.0],
            modulus: [0.0],
            work: 0.0,
            plastic_work: 0.0,
        };
        specimen.with_state(|law, state| law.start(state));
        specimen.to(DMat3::IDENTITY, 0.0);
        specimen
    }

    fn with_state<R>(&mut self, f: impl FnOnce(&FailingLaw, StateRows<'_>) -> R) -> R {
        let mut bytes: [&mut [u8]; MAX_STATE] = Default::default();
        for (slot, column) in bytes.iter_mut().zip(&mut self.bytes) {
            *slot = column;
        }
        f(&self.law, StateRows::new(&self.columns, bytes))
    }

    /// One step to the deformation `f`.
    fn to(&mut self, f: DMat3, dt: f64) {
        let before = self.stress[0];
        // What stands in the output before the call is of no account.
        let (mut stress, mut energy, mut modulus) = ([DMat3::NAN], [f64::NAN], [f64::NAN]);
        let mut plastic_work = [0.0];
        self.with_state(|law, state| {
            law.stress(&mut StressRows {
                dt,
                deformation: &[f],
                share: &[1.0],
                stress_before: &[before],
                stress: &mut stress,
                energy: &mut energy,
                modulus: &mut modulus,
                strength: &mut [f64::INFINITY],
                plastic_work: &mut plastic_work,
                state,
            });
        });
        let (mean, change) = (0.5 * (before + stress[0]), f - self.f);
        self.work += (0..3).map(|k| mean.col(k).dot(change.col(k))).sum::<f64>();
        self.plastic_work += plastic_work[0];
        (self.f, self.stress, self.energy, self.modulus) = (f, stress, energy, modulus);
    }

    fn damage(&mut self) -> f64 {
        self.with_state(|_, mut state| state.take::<Damage>()[0].0)
    }

    fn index(&mut self) -> f64 {
        self.with_state(|_, mut state| state.take::<FailureIndex>()[0].0)
    }

    fn fracture(&mut self) -> f64 {
        self.with_state(|_, mut state| state.take::<FractureEnergy>()[0].0)
    }
}

fn stretched(x: f64, y: f64) -> DMat3 {
    DMat3::from_diagonal(glam::DVec3::new(x, y, 1.0))
}

const STRAIN: Criterion = Criterion::MaximumPrincipalStrain { limit: 0.05 };

#[test]
fn a_particle_heats_by_the_plastic_work_that_damage_leaves() {
    let (density, heat, yield_stress) = (2700.0, 900.0, 1e-3 * SHEAR);
    let heating = Heating { specific_heat: Some(heat), taylor_quinney: 0.9, temperature: 300.0 };
    let (bulk, shear) = (Some(BULK), Some(SHEAR));
    let hardening = Hardening::Perfect { yield_stress };
    let (young, poisson, heating) = (None, None, Some(heating));
    // The internal energy of this one is the heat, as the volume stays what it was.
    let eos = Some(SolidEos::MieGrueneisen { sound_speed: None, slope: 1.4, gamma: 2.0 });
    let j2 = J2 { density, young, poisson, bulk, shear, hardening, heating, eos }.build();
    let hypoelastic =
        Hypoelastic { density, young, poisson, bulk, shear, hardening: Some(hardening), heating, eos }
            .build();
    for material in [j2.unwrap(), hypoelastic.unwrap()] {
        let mut specimen = Specimen::new(material, STRAIN, 1e4, AfterFailure::NoDeviator);
        for k in 1..=2000 {
            let strain = 0.15 * f64::from(k) / 2000.0;
            specimen.to(stretched(strain.exp(), (-strain).exp()), 1e-7);
        }
        assert_eq!(specimen.damage(), 1.0);
        let rise = specimen.with_state(|_, mut state| state.take::<Temperature>()[0].0) - 300.0;
        let wanted = 0.9 * specimen.plastic_work / (density * heat);
        assert!(wanted > 0.0 && (rise / wanted - 1.0).abs() < 1e-9, "{rise} {wanted}");
        let internal = specimen.with_state(|_, mut state| state.take::<InternalEnergy>()[0].0);
        assert!(
            (internal / specimen.plastic_work - 1.0).abs() < 1e-9,
            "{internal} {}",
            specimen.plastic_work
        );
    }
}

#[test]
fn damage_grows_as_the_cube_of_time_from_the_limit_on() {
    let mut specimen = Specimen::new(rubber(), STRAIN, 1e5, AfterFailure::NoTension);
    for k in 1..=20 {
        specimen.to(stretched((0.0499 * f64::from(k) / 20.0).exp(), 1.0), 1e-7);
    }
    assert_eq!(specimen.damage(), 0.0);
    assert!((specimen.index() - 0.998).abs() < 1e-9);
    // At rest above the limit: D = (1e5 t)^3, 1 after 1e-5 s.
    for k in 1..=110 {
        specimen.to(stretched(0.06f64.exp(), 1.0), 1e-7);
        let expected = (1e-2 * f64::from(k)).min(1.0).powi(3);
        assert!((specimen.damage() - expected).abs() < 1e-12, "{k}");
    }
    assert_eq!((specimen.modulus[0], specimen.stress[0]), (0.0, DMat3::ZERO));
    // Below the limit it would have stayed.
    let mut other = Specimen::new(rubber(), STRAIN, 1e5, AfterFailure::NoTension);
    for stretch in [0.06f64, 0.04, 0.04, 0.04] {
        other.to(stretched(stretch.exp(), 1.0), 1e-6);
    }
    assert!((other.damage() - 1e-3).abs() < 1e-12 && other.index() > 1.19);
}

#[test]
fn compression_breaks_nothing() {
    let stress = Criterion::MaximumPrincipalStress { limit: 1e6 };
    for criterion in [STRAIN, stress] {
        let mut specimen = Specimen::new(rubber(), criterion, f64::INFINITY, AfterFailure::NoTension);
        let squeezed = DMat3::from_diagonal(glam::DVec3::splat(0.7));
        specimen.to(squeezed, 1e-6);
        assert_eq!(specimen.damage(), 0.0);
    }
}

#[test]
fn what_has_failed_bears_what_the_scene_says() {
    let failed = |then: AfterFailure| {
        let mut specimen = Specimen::new(rubber(), STRAIN, f64::INFINITY, then);
        specimen.to(stretched(1.1, 1.0), 1e-6);
        assert_eq!(specimen.damage(), 1.0);
        specimen
    };
    // Vidal's law: the Cauchy pressure is -K (J - 1), whatever the shape.
    let sheared = |j: f64| DMat3::from_cols_array(&[1.3, 0.0, 0.0, 0.6, j / 1.3, 0.0, 0.0, 0.0, 1.0]);
    for (then, j, mean) in [
        (AfterFailure::NoTension, 0.9, -0.1 * BULK),
        (AfterFailure::NoTension, 1.2, 0.0),
        (AfterFailure::NoDeviator, 0.9, -0.1 * BULK),
        (AfterFailure::NoDeviator, 1.2, 0.2 * BULK),
    ] {
        let mut specimen = failed(then);
        specimen.to(sheared(j), 1e-6);
        let f = sheared(j);
        let stress = specimen.stress[0] * f.transpose() * (1.0 / j);
        assert!(
            (stress - DMat3::IDENTITY * mean).abs_diff_eq(DMat3::ZERO, 1e-7 * BULK),
            "{then:?} {j}: {stress}"
        );
        assert_eq!(specimen.modulus[0], 0.0);
    }
    // Turned inside out it is still a number, and pushes back.
    let mut specimen = failed(AfterFailure::NoTension);
    specimen.to(stretched(-0.4, 1.0), 1e-6);
    assert!(specimen.stress[0].is_finite() && specimen.stress[0].x_axis.x < 0.0);
    assert!(specimen.energy[0].is_finite());
}

/// A pull that turns, with a shear and a return to compression: to failure and on.
fn path(s: f64) -> DMat3 {
    let turn = DMat3::from_rotation_z(0.8 * s) * DMat3::from_rotation_x(0.3 * s);
    let stretch = if s < 0.6 { 1.0 + 0.2 * s } else { 1.12 - 0.6 * (s - 0.6) };
    turn * DMat3::from_cols_array(&[
        stretch,
        0.05 * s,
        0.0,
        0.1 * s,
        1.0 + 0.04 * s,
        0.0,
        0.0,
        0.02 * s,
        1.0 - 0.05 * s,
    ])
}

#[test]
fn all_work_is_stored_or_set_free() {
    let neo = || {
        let model =
            NeoHookean { density: 1000.0, young: Some(2e9), poisson: Some(0.3), bulk: None, shear: None };
        model.build().unwrap()
    };
    let materials: [fn() -> Material; 2] = [rubber, neo];
    for material in materials {
        for then in [AfterFailure::NoTension, AfterFailure::NoDeviator, AfterFailure::Removed] {
            for growth in [f64::INFINITY, 4.0] {
                let mut specimen = Specimen::new(material(), STRAIN, growth, then);
                let steps = 20_000;
                let mut freed = 0.0;
                for k in 1..=steps {
                    specimen.to(path(f64::from(k) / f64::from(steps)), 1.0 / f64::from(steps));
                    let now = specimen.fracture();
                    assert!(now >= freed - 1e-3 * SHEAR * 1e-4, "{then:?} {growth}: {now} after {freed}");
                    freed = now;
                }
                assert_eq!(specimen.damage(), 1.0);
                let (energy, work) = (specimen.energy[0], specimen.work);
                let scale = freed.abs() + energy.abs();
                assert!(
                    freed > 0.0 && (work - energy - freed).abs() < 1e-4 * scale,
                    "{then:?} {growth}: {work} {energy} {freed}"
                );
            }
        }
    }
}

#[test]
fn a_law_that_does_not_fail_is_left_as_it_is() {
    let mut specimen = Specimen::new(
        rubber(),
        Criterion::MaximumPrincipalStrain { limit: 9.0 },
        1.0,
        AfterFailure::NoTension,
    );
    let bare = inner(rubber());
    for k in 1..50 {
        let f = path(f64::from(k) / 50.0);
        specimen.to(f, 1e-6);
        let (mut stress, mut energy, mut modulus) = ([DMat3::ZERO], [0.0], [0.0]);
        bare.stress(&mut StressRows {
            dt: 1e-6,
            deformation: &[f],
            share: &[1.0],
            stress_before: &[DMat3::ZERO],
            stress: &mut stress,
            energy: &mut energy,
            modulus: &mut modulus,
            strength: &mut [f64::INFINITY],
            plastic_work: &mut [0.0],
            state: StateRows::default(),
        });
        assert_eq!((specimen.stress, specimen.energy, specimen.modulus), (stress, energy, modulus));
    }
}

#[test]
fn failure_strains_are_those_of_johnson_and_cook() {
    // Mohseni-Mofidi et al. 2020, Table 1; the file has equation 26 evaluated, without a floor.
    let alloy = JohnsonCookFailure {
        d1: -0.77,
        d2: 1.45,
        d3: -0.47,
        d4: 0.0,
        d5: 1.6,
        reference_rate: 1.0,
        reference_temperature: 292.0,
        melt_temperature: Some(925.0),
        minimum_strain: 1e-3,
    };
    let acrylic = JohnsonCookFailure {
        d1: -1.751,
        d2: 2.32,
        d3: -0.773,
        d4: -0.0491,
        d5: 0.38,
        reference_rate: 1e-3,
        reference_temperature: 213.0,
        melt_temperature: Some(398.0),
        minimum_strain: 1e-3,
    };
    let file = include_str!("../tests/johnson_cook_failure_strain.csv");
    let mut seen = 0;
    for line in file.lines().filter(|line| line.starts_with("Al,") || line.starts_with("PMMA,")) {
        let values: Vec<f64> = line.split(',').skip(1).map(|value| value.parse().unwrap()).collect();
        let [triaxiality, rate, temperature, expected] = values[..] else { panic!("{line}") };
        let law = if line.starts_with("Al,") { &alloy } else { &acrylic };
        let found = law.at(triaxiality, rate, temperature);
        let expected = expected.max(1e-3);
        assert!((found / expected - 1.0).abs() < 1e-6, "{line}: {found}");
        seen += 1;
    }
    assert!(seen >= 40);
}
