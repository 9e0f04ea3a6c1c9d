//! The law of a material that can fail: it wraps any other law.
//!
//! Up to failure, the wrapped law is evaluated unchanged, and damage 0 < D < 1 reduces its stress. The
//! remaining energy is the share sigma' : sigma / sigma : sigma of the law's energy. The energy released by
//! damage is the stress work of a step that is neither stored nor plastic: mean stress times the change of F,
//! as the two kicks apply it.
//!
//! After failure, the law is evaluated for the deformation at failure, scaled to the present volume. The
//! particle carries only the mean stress sigma_m(J) of the result, P = sigma_m J F^-T. Its energy is the
//! integral of sigma_m dJ.

use std::sync::Arc;

use glam::DMat3;
use meshless_engine::linalg::Sym3;
use meshless_engine::materials::{ElasticConstants, SolidLaw, StateRows, StressRows, Stretches};
use meshless_engine::parallel::BLOCK;
use meshless_engine::world::{
    Column, ColumnSet, Damage, InternalEnergy, PlasticStrain, PlasticWork, ReachedTemperature, Temperature,
};

use crate::criterion::{CriterionInput, WatchedCriterion};
use crate::softening::{AfterFailure, at_volume, cauchy, cofactor};
use crate::{DamagedDeformation, DamagedEnergy, FailedStress, FailedVolume, FailureIndex, FractureEnergy};

pub(crate) struct FailingLaw {
    watch: WatchedCriterion,
    inner: Arc<dyn SolidLaw>,
    /// Growth of the cube root of damage where the criterion is met, 1/s.
    growth: f64,
    then: AfterFailure,
    /// Whether the pressure of the wrapped law depends on the energy that plastic work brings.
    keeps_energy: bool,
}

/// The columns of the law, block by block.
struct LawColumns<'a> {
    damage: &'a mut [Damage],
    index: &'a mut [FailureIndex],
    fracture: &'a mut [FractureEnergy],
    energy: &'a mut [DamagedEnergy],
    deformation: &'a mut [DamagedDeformation],
    volume: &'a mut [FailedVolume],
    mean: &'a mut [FailedStress],
    /// Where plastic work heats, or the criterion depends on it.
    temperature: Option<&'a mut [Temperature]>,
    /// Where plastic work adds to the pressure.
    energies: Option<Energies<'a>>,
}

/// What an equation of state keeps.
struct Energies<'a> {
    internal: &'a mut [InternalEnergy],
    plastic: &'a mut [PlasticWork],
    temperature: &'a mut [ReachedTemperature],
}

impl<'a> LawColumns<'a> {
    fn take(state: &mut StateRows<'a>, has_temperature: bool, keeps_energy: bool) -> Self {
        Self {
            damage: state.take(),
            index: state.take(),
            fracture: state.take(),
            energy: state.take(),
            deformation: state.take(),
            volume: state.take(),
            mean: state.take(),
            temperature: has_temperature.then(|| state.take()),
            energies: keeps_energy.then(|| Energies {
                internal: state.take(),
                plastic: state.take(),
                temperature: state.take(),
            }),
        }
    }
}

impl FailingLaw {
    pub fn new(watch: WatchedCriterion, inner: Arc<dyn SolidLaw>, growth: f64, then: AfterFailure) -> Self {
        let mut columns = ColumnSet::default();
        inner.state(&mut columns);
        let keeps_energy = columns.get(InternalEnergy::NAME).is_some();
        Self { watch, inner, growth, then, keeps_energy }
    }

    /// Damage after a step of length `dt`, s, in which the criterion is met.
    fn grown(&self, damage: f64, dt: f64) -> f64 {
        (damage.cbrt() + self.growth * dt).min(1.0).powi(3)
    }

    /// A particle that has failed in an earlier step.
    fn failed(&self, k: usize, given: &DMat3, rows: &mut StressRows<'_>, own: &mut LawColumns<'_>) {
        let f = &rows.deformation[k];
        let (volume, cofactor) = (f.determinant(), cofactor(f));
        (rows.plastic_work[k], rows.modulus[k]) = (0.0, 0.0);
        let was_torn = own.volume[k].0.is_infinite();
        if was_torn || self.then.is_torn(volume, &cofactor) {
            if !was_torn {
                // What it held, and what its last stress does on the way here.
                let held = own.energy[k].0 + 0.5 * own.mean[k].0 * (volume - own.volume[k].0);
                own.fracture[k].0 += rows.share[k] * held;
            }
            (own.energy[k].0, own.volume[k].0, own.mean[k].0) = (0.0, f64::INFINITY, 0.0);
            (rows.stress[k], rows.energy[k]) = (DMat3::ZERO, 0.0);
            return;
        }
        let mean = self.then.borne(cauchy(&rows.stress[k], given).trace() / 3.0);
        own.energy[k].0 += 0.5 * (own.mean[k].0 + mean) * (volume - own.volume[k].0);
        (own.volume[k].0, own.mean[k].0) = (volume, mean);
        rows.stress[k] = cofactor * mean;
        rows.energy[k] = own.energy[k].0;
    }

    /// A particle in which there is damage, below or just at 1.
    fn soften(&self, k: usize, stress: &Sym3, rows: &mut StressRows<'_>, own: &mut LawColumns<'_>) {
        let f = &rows.deformation[k];
        let damage = own.damage[k].0;
        let stored = if damage < 1.0 {
            let left = self.then.soften(stress, damage);
            let square = stress.double_dot(stress);
            rows.stress[k] = left.to_matrix() * cofactor(f);
            rows.energy[k] * if square > 0.0 { left.double_dot(stress) / square } else { 1.0 }
        } else {
            let mean = self.then.borne(stress.trace() / 3.0);
            let volume = f.determinant();
            (own.volume[k].0, own.mean[k].0) = (volume, mean);
            rows.stress[k] = cofactor(f) * mean;
            0.5 * (volume * mean).powi(2) / self.inner.elastic().bulk
        };
        // The law has heated by the plastic work of a particle without damage.
        let lost = damage * rows.plastic_work[k];
        rows.plastic_work[k] -= lost;
        let colder = self.inner.plastic_heating() * lost;
        if let Some(temperature) = &mut own.temperature {
            temperature[k].0 -= colder;
        }
        if let Some(Energies { internal, plastic, temperature }) = &mut own.energies {
            internal[k].0 -= lost;
            plastic[k].0 -= lost;
            temperature[k].0 -= colder;
        }
        rows.modulus[k] *= 1.0 - damage;
        if rows.dt > 0.0 {
            let change = *f - own.deformation[k].0;
            let work = 0.5 * double_dot(&(rows.stress_before[k] + rows.stress[k]), &change);
            let released = work - (stored - own.energy[k].0) - rows.plastic_work[k];
            own.fracture[k].0 += rows.share[k] * released;
        }
        rows.energy[k] = stored;
    }
}

/// A : B, the sum of products of all components.
fn double_dot(a: &DMat3, b: &DMat3) -> f64 {
    a.x_axis.dot(b.x_axis) + a.y_axis.dot(b.y_axis) + a.z_axis.dot(b.z_axis)
}

impl SolidLaw for FailingLaw {
    fn elastic(&self) -> &ElasticConstants {
        self.inner.elastic()
    }

    fn needs_positive_volume(&self) -> bool {
        self.inner.needs_positive_volume()
    }

    fn remembers_path(&self) -> bool {
        true
    }

    fn reads_last_stress(&self) -> bool {
        true
    }

    fn specific_heat(&self) -> Option<f64> {
        self.inner.specific_heat()
    }

    fn plastic_heating(&self) -> f64 {
        self.inner.plastic_heating()
    }

    fn initial_yield_stress(&self) -> Option<f64> {
        self.inner.initial_yield_stress()
    }

    fn stable_step_factor(&self, stretches: &Stretches) -> f64 {
        self.inner.stable_step_factor(stretches)
    }

    fn wave_factor(&self, stretches: &Stretches) -> f64 {
        self.inner.wave_factor(stretches)
    }

    fn state(&self, columns: &mut ColumnSet) {
        self.inner.state(columns);
        columns.add::<Damage>().add::<FailureIndex>().add::<FractureEnergy>().add::<DamagedEnergy>();
        columns.add::<DamagedDeformation>().add::<FailedVolume>().add::<FailedStress>();
    }

    fn start(&self, mut state: StateRows<'_>) {
        state.reborrow().take::<DamagedDeformation>().fill(DamagedDeformation(DMat3::IDENTITY));
        self.inner.start(state);
    }

    fn stress(&self, rows: &mut StressRows<'_>) {
        let n = rows.deformation.len();
        let (mut given, mut strain) = ([DMat3::IDENTITY; BLOCK], [0.0; BLOCK]);
        let mut state = rows.state.reborrow();
        let (damage, reached) = (state.take::<Damage>(), state.take::<DamagedDeformation>());
        for k in 0..n {
            let f = rows.deformation[k];
            given[k] = if damage[k].0 < 1.0 { f } else { at_volume(&reached[k].0, f.determinant()) };
        }
        if self.watch.plastic {
            let now = state.take::<PlasticStrain>();
            strain.iter_mut().zip(now).for_each(|(before, now)| *before = now.0);
        }
        self.inner.stress(&mut StressRows {
            dt: rows.dt,
            deformation: &given[..n],
            share: rows.share,
            stress_before: rows.stress_before,
            stress: rows.stress,
            energy: rows.energy,
            modulus: rows.modulus,
            strength: rows.strength,
            plastic_work: rows.plastic_work,
            state: rows.state.reborrow(),
        });
        // Taken out of the rows, so that the loop can hand both on.
        let mut all = std::mem::take(&mut rows.state);
        let mut state = all.reborrow();
        let has_temperature = self.watch.temperature || self.inner.plastic_heating() > 0.0;
        let mut own = LawColumns::take(&mut state, has_temperature, self.keeps_energy);
        let now = self.watch.plastic.then(|| state.take::<PlasticStrain>());
        for k in 0..n {
            if own.damage[k].0 >= 1.0 {
                self.failed(k, &given[k], rows, &mut own);
                continue;
            }
            let stress = cauchy(&rows.stress[k], &given[k]);
            // What carries nothing of its stress does not fail by it.
            if rows.dt > 0.0 && rows.share[k] > 0.0 {
                let seen = CriterionInput {
                    deformation: &given[k],
                    stress: &stress,
                    plastic: now.as_deref().map_or(0.0, |now| now[k].0 - strain[k]),
                    temperature: own.temperature.as_deref().map_or(0.0, |temperature| temperature[k].0),
                    dt: rows.dt,
                };
                let (index, met) = self.watch.index(own.index[k].0, &seen);
                own.index[k].0 = index;
                if met {
                    own.damage[k].0 = self.grown(own.damage[k].0, rows.dt);
                }
            }
            if own.damage[k].0 > 0.0 {
                self.soften(k, &stress, rows, &mut own);
            }
            own.deformation[k].0 = given[k];
            own.energy[k].0 = rows.energy[k];
        }
        rows.state = all;
    }
}
