//! J2 plasticity on the multiplicative split F = Fe Fp with logarithmic strain.
//!
//! The trial state is be = F Cp^-1 F^T with Cp^-1 of the step before; its logarithm splits into the volume,
//! ln J, and the deviator e. The Kirchhoff stress is tau = 2 mu e - J p I. Where its equivalent stress q =
//! sqrt(3/2) |2 mu e| is above the flow stress, e is scaled back by the plastic increment, and Cp^-1 = F^-1
//! be F^-T stores the result (Simo and Hughes 1998, section 9.3). Everything is three-dimensional: in plane
//! strain the plastic strain normal to the plane is included.
//!
//! Plastic work is the increment times the mean of the equivalent stresses before and after the step. Where
//! the stress keeps its direction, this is exactly the energy that the trapezoidal rule of the leapfrog takes
//! out of the motion; elsewhere it is that to second order in the step.

use glam::DMat3;

use super::elastic_constants::ElasticConstants;
use super::elastic_parameters::elastic_parameters;
use super::eos::{PressureLaw, SolidEos};
use super::eos_state::{PressureRows, StepHeat};
use super::error::ParameterError;
use super::hardening::Hardening;
use super::heat_state::TemperatureRows;
use super::heating::Heating;
use super::law::{Material, MaterialModel, SolidLaw, StressRows};
use super::return_mapping::Trial;
use super::state::StateRows;
use super::stretches::Stretches;
use super::viscous_heat::ViscousHeatRows;
use crate::linalg::Sym3;
use crate::parallel::{FourLanes, HotLoop, run_hot};
use crate::world::{ColumnSet, EquivalentStress, InversePlasticCauchyGreen, PlasticStrain, YieldStress};

elastic_parameters! {
    /// J2 plasticity (von Mises) with logarithmic strain, F = Fe Fp; hardening by plastic strain, its rate,
    /// and temperature.
    pub struct J2 {
        /// Flow stress.
        pub hardening: Hardening,
        /// Heat from plastic work; without it the temperature plays no part.
        #[serde(default)]
        pub heating: Option<Heating>,
        /// Pressure as a function of volume; without it the Kirchhoff pressure is -K ln J.
        #[serde(default)]
        pub eos: Option<SolidEos>,
    }
}

impl MaterialModel for J2 {
    const NAME: &'static str = "J2";
    const REFERENCE: &'static str = "Simo and Hughes 1998, Computational Inelasticity, section 9.3";

    fn build(self) -> Result<Material, ParameterError> {
        let elastic = self.elastic()?;
        require_heating(Some(&self.hardening), self.heating.as_ref())?;
        plastic(self.density, elastic, self.hardening, self.heating, self.eos)
    }
}

/// Checks flow stress and heating; a flow stress that depends on temperature needs one.
pub(super) fn require_heating(
    hardening: Option<&Hardening>,
    heating: Option<&Heating>,
) -> Result<(), ParameterError> {
    hardening.map_or(Ok(()), Hardening::check)?;
    if let Some(heating) = heating {
        return heating.check(&Heating::FIELDS_OF_HEATING);
    }
    if hardening.is_some_and(Hardening::needs_temperature) {
        return Err(ParameterError::new(
            "heating",
            "the flow stress depends on temperature, and `heating` is missing",
            "give `heating: (temperature: ..., specific_heat: ...)`; without specific heat the temperature stays",
        ));
    }
    Ok(())
}

/// A metal with parameters that are checked but for density and equation of state.
pub(super) fn plastic(
    density: f64,
    elastic: ElasticConstants,
    hardening: Hardening,
    heating: Option<Heating>,
    eos: Option<SolidEos>,
) -> Result<Material, ParameterError> {
    ParameterError::require_positive("density", density)?;
    let pressure = match eos {
        None => PressureLaw::Logarithmic { bulk: elastic.bulk },
        Some(eos) => eos.pressure(elastic.bulk, density)?,
    };
    let rise = heating.map_or(0.0, |heating| heating.rise(density));
    let temperature = heating.map(|heating| heating.temperature);
    let specific_heat = heating.and_then(|heating| heating.specific_heat);
    let rise_by_heat = heating.map_or(0.0, |heating| heating.rise_by_heat(density));
    let law = PlasticLaw { elastic, hardening, pressure, rise, rise_by_heat, temperature, specific_heat };
    Ok(Material::solid(density, law))
}

/// The law of [`J2`] and [`JohnsonCook`](super::JohnsonCook).
#[derive(Clone, Copy, Debug)]
struct PlasticLaw {
    elastic: ElasticConstants,
    hardening: Hardening,
    pressure: PressureLaw,
    /// Rise of the temperature for each J/m3 of plastic work, K m3/J.
    rise: f64,
    /// The same for each J/m3 of heat.
    rise_by_heat: f64,
    /// Temperature at the start, K, if it plays a part.
    temperature: Option<f64>,
    /// Specific heat, J/(kg K), if the metal heats up.
    specific_heat: Option<f64>,
}

impl PlasticLaw {
    /// Whether the heat of pair terms changes anything.
    fn reads_heat(&self) -> bool {
        self.specific_heat.is_some() || self.pressure.keeps_energy()
    }
}

impl SolidLaw for PlasticLaw {
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
        Some(self.hardening.static_stress(0.0, self.temperature.unwrap_or_default()))
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
        columns.add::<PlasticStrain>().add::<InversePlasticCauchyGreen>();
        columns.add::<EquivalentStress>().add::<YieldStress>();
        TemperatureRows::declare(self.temperature, columns);
        PressureRows::declare(&self.pressure, columns);
        ViscousHeatRows::declare(self.reads_heat(), columns);
    }

    fn start(&self, mut state: StateRows<'_>) {
        state.take::<InversePlasticCauchyGreen>().fill(InversePlasticCauchyGreen(Sym3::IDENTITY));
        let temperature = self.temperature.unwrap_or_default();
        state.take::<YieldStress>().fill(YieldStress(self.hardening.static_stress(0.0, temperature)));
        TemperatureRows::start(self.temperature, &mut state);
        PressureRows::start(&self.pressure, &mut state);
    }

    fn stress(&self, rows: &mut StressRows<'_>) {
        run_hot(PlasticLoop { law: self, rows });
    }
}

struct PlasticLoop<'a, 'r> {
    law: &'a PlasticLaw,
    rows: &'a mut StressRows<'r>,
}

impl HotLoop for PlasticLoop<'_, '_> {
    type Output = ();

    #[inline(always)]
    fn run<A: FourLanes>(self, _: A) {
        let (law, rows) = (self.law, self.rows);
        let mut state = rows.state.reborrow();
        let strain = state.take::<PlasticStrain>();
        let plastic = state.take::<InversePlasticCauchyGreen>();
        let equivalent = state.take::<EquivalentStress>();
        let yield_stress = state.take::<YieldStress>();
        let mut temperature = TemperatureRows::take(law.temperature, &mut state);
        let mut pressures = PressureRows::take(&law.pressure, &mut state);
        let heats = ViscousHeatRows::take(law.reads_heat(), &mut state);
        let shear = law.elastic.shear;
        rows.modulus.fill(law.elastic.young);
        for k in 0..rows.deformation.len() {
            let f = &rows.deformation[k];
            let volume = Volume::of(f);
            let b = left_cauchy_green(f, &plastic[k].0);
            let mut e = (b * volume.isochoric).half_log();
            let square = e.double_dot(&e);
            let mut q = (6.0 * square).sqrt() * shear;
            let mut left = 1.0;
            let viscous = heats.heat(k, rows.dt);
            let outside = pressures.heat_from_outside(k, temperature.get(k), law.rise_by_heat);
            temperature.set(k, temperature.get(k) + law.rise_by_heat * viscous);
            if law.hardening.needs_temperature() {
                // Contact, conduction or pair terms may have heated the particle since it last flowed.
                yield_stress[k].0 = law.hardening.static_stress(strain[k].0, temperature.get(k));
            }
            // NaN is not above the yield stress: it goes on into the stress, and the watchdog stops.
            if q > yield_stress[k].0 && rows.dt > 0.0 {
                let hot = temperature.get(k);
                let trial = Trial { stress: q, shear, strain: strain[k].0, temperature: hot, dt: rows.dt };
                let increment = trial.increment(&law.hardening);
                left = 1.0 - 3.0 * shear * increment / q;
                let kept = (e * (2.0 * (left - 1.0))).exp();
                plastic[k].0 = pull_back(&b.mul_coaxial(&kept), &volume.cofactor, volume.ratio);
                e = e * left;
                q *= left;
                let work = increment * 0.5 * (equivalent[k].0 + q);
                strain[k].0 += increment;
                rows.plastic_work[k] = work;
                temperature.set(k, hot + law.rise * work);
                yield_stress[k].0 = law.hardening.static_stress(strain[k].0, temperature.get(k));
            }
            // Also where bonds are cut: what is beyond yield after that flows back from there.
            equivalent[k].0 = q;
            let heat = StepHeat { plastic_work: rows.plastic_work[k], viscous: viscous + outside };
            let (pressure, stored) = pressures.advance(k, volume.ratio, heat, rows.dt);
            pressures.leave_at(k, temperature.get(k), rows.dt);
            let tau = (e * (2.0 * shear)).add_diagonal(-volume.ratio * pressure);
            rows.stress[k] = first_piola(&tau, &volume.cofactor, volume.ratio);
            rows.energy[k] = shear * square * left * left + stored;
            rows.strength[k] = if strain[k].0 > 0.0 { yield_stress[k].0 } else { f64::INFINITY };
        }
    }
}

/// The volume part of a deformation gradient.
pub(super) struct Volume {
    /// Cofactor J F^-T.
    pub cofactor: DMat3,
    /// J.
    pub ratio: f64,
    /// J^(-2/3).
    pub isochoric: f64,
}

impl Volume {
    #[inline(always)]
    pub fn of(f: &DMat3) -> Self {
        let (a, b, c) = (f.x_axis, f.y_axis, f.z_axis);
        let cofactor = DMat3::from_cols(b.cross(c), c.cross(a), a.cross(b));
        let ratio = a.dot(cofactor.x_axis);
        // ln and exp instead of powf: det F <= 0 gives NaN here too, and the watchdog stops.
        Self { cofactor, ratio, isochoric: (-2.0 / 3.0 * ratio.ln()).exp() }
    }
}

/// F C F^T.
#[inline(always)]
pub(super) fn left_cauchy_green(f: &DMat3, c: &Sym3) -> Sym3 {
    let (x, y, z) = (f.x_axis, f.y_axis, f.z_axis);
    let a = x * c.xx + y * c.xy + z * c.xz;
    let b = x * c.xy + y * c.yy + z * c.yz;
    let d = x * c.xz + y * c.yz + z * c.zz;
    Sym3 {
        xx: a.x * x.x + b.x * y.x + d.x * z.x,
        yy: a.y * x.y + b.y * y.y + d.y * z.y,
        zz: a.z * x.z + b.z * y.z + d.z * z.z,
        xy: a.x * x.y + b.x * y.y + d.x * z.y,
        xz: a.x * x.z + b.x * y.z + d.x * z.z,
        yz: a.y * x.z + b.y * y.z + d.y * z.z,
    }
}

/// F^-1 B F^-T from the cofactor of F.
#[inline(always)]
fn pull_back(b: &Sym3, cofactor: &DMat3, j: f64) -> Sym3 {
    left_cauchy_green(&cofactor.transpose(), b) * (1.0 / (j * j))
}

/// P = tau F^-T from the cofactor of F.
#[inline(always)]
pub(super) fn first_piola(tau: &Sym3, cofactor: &DMat3, j: f64) -> DMat3 {
    let tau = *tau * (1.0 / j);
    DMat3::from_cols(tau * cofactor.x_axis, tau * cofactor.y_axis, tau * cofactor.z_axis)
}
