//! The hypoelastic law of [`HypoelasticJ2`] for formulations with a deformation gradient.

use glam::DMat3;

use super::elastic_constants::ElasticConstants;
use super::elastic_parameters::elastic_parameters;
use super::eos::{PressureLaw, SolidEos};
use super::eos_state::{PressureRows, StepHeat};
use super::error::ParameterError;
use super::hardening::Hardening;
use super::heat_state::TemperatureRows;
use super::heating::Heating;
use super::j2::{Volume, first_piola, require_heating};
use super::jaumann::{HypoelasticJ2, HypoelasticState, velocity_gradient_step};
use super::law::{Material, MaterialModel, SolidLaw, StressRows};
use super::state::StateRows;
use super::stretches::Stretches;
use super::viscous_heat::ViscousHeatRows;
use crate::parallel::{FourLanes, HotLoop, run_hot};
use crate::world::{ColumnSet, DeviatoricStress, PlasticStrain, ReachedDeformation};

elastic_parameters! {
    /// Hypoelasticity with the Jaumann rate of the Cauchy stress, with J2 plasticity where `hardening` is
    /// given. The pressure is K (rho/rho_0 - 1) unless `eos` says otherwise.
    pub struct Hypoelastic {
        /// Flow stress; without it there is no plasticity.
        #[serde(default)]
        pub hardening: Option<Hardening>,
        /// Heat from plastic work; without it the temperature plays no part.
        #[serde(default)]
        pub heating: Option<Heating>,
        /// Pressure as a function of volume.
        #[serde(default)]
        pub eos: Option<SolidEos>,
    }
}

impl MaterialModel for Hypoelastic {
    const NAME: &'static str = "Hypoelastic";
    const REFERENCE: &'static str =
        "Mohseni-Mofidi and Bierwisch 2020, eqs. 13-16 and 22; Hughes and Winget 1980";

    fn build(self) -> Result<Material, ParameterError> {
        let elastic = self.elastic()?;
        require_heating(self.hardening.as_ref(), self.heating.as_ref())?;
        let pressure = self.eos.unwrap_or(SolidEos::Linear).pressure(elastic.bulk, self.density)?;
        let rise = self.heating.map_or(0.0, |heating| heating.rise(self.density));
        let shape = HypoelasticJ2 { shear: elastic.shear, hardening: self.hardening };
        let temperature = self.heating.map(|heating| heating.temperature);
        let rise_by_heat = self.heating.map_or(0.0, |heating| heating.rise_by_heat(self.density));
        let specific_heat = self.heating.and_then(|heating| heating.specific_heat);
        let law = HypoelasticLaw { elastic, shape, pressure, temperature, specific_heat, rise, rise_by_heat };
        Ok(Material::solid(self.density, law))
    }
}

/// The law of [`Hypoelastic`]: the velocity gradient comes from the change of F.
#[derive(Clone, Copy, Debug)]
struct HypoelasticLaw {
    elastic: ElasticConstants,
    shape: HypoelasticJ2,
    pressure: PressureLaw,
    /// Temperature at the start, K, if it plays a part.
    temperature: Option<f64>,
    /// Specific heat, J/(kg K); none for no heating.
    specific_heat: Option<f64>,
    /// Rise of the temperature for each J/m3 of plastic work, K m3/J.
    rise: f64,
    /// Rise of the temperature for each J/m3 of heat, K m3/J; zero without specific heat.
    rise_by_heat: f64,
}

impl HypoelasticLaw {
    /// Whether the heat of pair terms changes anything.
    fn reads_heat(&self) -> bool {
        self.rise_by_heat > 0.0 || self.pressure.keeps_energy()
    }
}

impl SolidLaw for HypoelasticLaw {
    fn elastic(&self) -> &ElasticConstants {
        &self.elastic
    }

    fn needs_positive_volume(&self) -> bool {
        true
    }

    fn remembers_path(&self) -> bool {
        true
    }

    fn initial_yield_stress(&self) -> Option<f64> {
        let hardening = self.shape.hardening.as_ref()?;
        Some(hardening.static_stress(0.0, self.temperature.unwrap_or_default()))
    }

    fn specific_heat(&self) -> Option<f64> {
        self.specific_heat
    }

    fn plastic_heating(&self) -> f64 {
        self.rise
    }

    fn stable_step_factor(&self, stretches: &Stretches) -> f64 {
        self.pressure.step_factor(&self.elastic, stretches)
    }

    fn wave_factor(&self, stretches: &Stretches) -> f64 {
        self.pressure.wave_factor(&self.elastic, stretches)
    }

    fn state(&self, columns: &mut ColumnSet) {
        columns.add::<DeviatoricStress>().add::<ReachedDeformation>().add::<PlasticStrain>();
        TemperatureRows::declare(self.temperature, columns);
        PressureRows::declare(&self.pressure, columns);
        ViscousHeatRows::declare(self.reads_heat(), columns);
    }

    fn start(&self, mut state: StateRows<'_>) {
        state.take::<ReachedDeformation>().fill(ReachedDeformation(DMat3::IDENTITY));
        TemperatureRows::start(self.temperature, &mut state);
        PressureRows::start(&self.pressure, &mut state);
    }

    fn stress(&self, rows: &mut StressRows<'_>) {
        run_hot(HypoelasticLoop { law: self, rows });
    }
}

struct HypoelasticLoop<'a, 'r> {
    law: &'a HypoelasticLaw,
    rows: &'a mut StressRows<'r>,
}

impl HotLoop for HypoelasticLoop<'_, '_> {
    type Output = ();

    #[inline(always)]
    fn run<A: FourLanes>(self, _: A) {
        let (law, rows) = (self.law, self.rows);
        let mut state = rows.state.reborrow();
        let deviator = state.take::<DeviatoricStress>();
        let reached = state.take::<ReachedDeformation>();
        let strain = state.take::<PlasticStrain>();
        let mut temperature = TemperatureRows::take(law.temperature, &mut state);
        let mut pressures = PressureRows::take(&law.pressure, &mut state);
        let heats = ViscousHeatRows::take(law.reads_heat(), &mut state);
        rows.modulus.fill(law.elastic.young);
        let moves = rows.dt > 0.0;
        for k in 0..rows.deformation.len() {
            let f = &rows.deformation[k];
            let volume = Volume::of(f);
            let viscous = heats.heat(k, rows.dt);
            let outside = pressures.heat_from_outside(k, temperature.get(k), law.rise_by_heat);
            let mut now = HypoelasticState {
                deviator: deviator[k].0,
                plastic_strain: strain[k].0,
                temperature: temperature.get(k) + law.rise_by_heat * viscous,
            };
            let before = std::mem::replace(&mut reached[k].0, *f);
            if moves {
                let gradient = velocity_gradient_step(&before, f) * (1.0 / rows.dt);
                rows.plastic_work[k] = volume.ratio * law.shape.advance(&mut now, &gradient, rows.dt);
                strain[k].0 = now.plastic_strain;
                now.temperature += law.rise * rows.plastic_work[k];
                temperature.set(k, now.temperature);
            } else {
                // Deformed at the start, or bonds are cut: what is beyond yield then flows in the next step.
                now.deviator = law.shape.jump(&now.deviator, &before, f);
            }
            deviator[k].0 = now.deviator;
            let heat = StepHeat { plastic_work: rows.plastic_work[k], viscous: viscous + outside };
            let (pressure, stored) = pressures.advance(k, volume.ratio, heat, rows.dt);
            pressures.leave_at(k, temperature.get(k), rows.dt);
            let tau = (now.deviator.add_diagonal(-pressure)) * volume.ratio;
            rows.stress[k] = first_piola(&tau, &volume.cofactor, volume.ratio);
            let square = now.deviator.double_dot(&now.deviator);
            rows.energy[k] = volume.ratio * square / (4.0 * law.elastic.shear) + stored;
            if let Some(hardening) = law.shape.hardening.as_ref().filter(|_| now.plastic_strain > 0.0) {
                rows.strength[k] = hardening.static_stress(now.plastic_strain, now.temperature);
            }
        }
    }
}
