//! The state of an equation of state with a path-dependent pressure: the internal energy from volume change,
//! plastic work, and the heat of pair terms, friction and conduction.

use super::eos::PressureLaw;
use super::state::StateRows;
use crate::world::{
    ColumnSet, InternalEnergy, PlasticWork, ReachedTemperature, ReachedVolumeRatio, ViscousHeat,
};

/// The pressure of a block, with its state columns if it depends on the path.
pub(super) struct PressureRows<'a> {
    law: &'a PressureLaw,
    energies: Option<EnergyRows<'a>>,
}

struct EnergyRows<'a> {
    internal: &'a mut [InternalEnergy],
    plastic: &'a mut [PlasticWork],
    viscous: &'a mut [ViscousHeat],
    volume: &'a mut [ReachedVolumeRatio],
    temperature: &'a mut [ReachedTemperature],
}

impl<'a> PressureRows<'a> {
    /// Adds the columns, if the pressure needs them.
    pub fn declare(pressure: &PressureLaw, columns: &mut ColumnSet) {
        if pressure.keeps_energy() {
            columns.add::<InternalEnergy>().add::<PlasticWork>().add::<ViscousHeat>();
            columns.add::<ReachedVolumeRatio>().add::<ReachedTemperature>();
        }
    }

    /// Fills the columns of undeformed particles.
    pub fn start(pressure: &PressureLaw, state: &mut StateRows<'_>) {
        if pressure.keeps_energy() {
            state.take::<ReachedVolumeRatio>().fill(ReachedVolumeRatio(1.0));
            state.take::<ReachedTemperature>().fill(ReachedTemperature(f64::NAN));
        }
    }

    /// Takes the columns of a block, if the pressure needs them.
    #[inline(always)]
    pub fn take(law: &'a PressureLaw, state: &mut StateRows<'a>) -> Self {
        let columns = || EnergyRows {
            internal: state.take(),
            plastic: state.take(),
            viscous: state.take(),
            volume: state.take(),
            temperature: state.take(),
        };
        Self { law, energies: law.keeps_energy().then(columns) }
    }

    /// Heat that row `k` has taken up since its last step beside the law, by friction or conduction, J/m3: it
    /// is at `temperature`, K, which rises by `rise_by_heat`, K m3/J, zero where heat plays no part.
    #[inline(always)]
    pub fn heat_from_outside(&self, k: usize, temperature: f64, rise_by_heat: f64) -> f64 {
        let Some(energies) = &self.energies else { return 0.0 };
        let change = temperature - energies.temperature[k].0;
        if rise_by_heat > 0.0 && !change.is_nan() { change / rise_by_heat } else { 0.0 }
    }

    /// Leaves row `k` at a temperature, K, after a step of `dt`, s.
    #[inline(always)]
    pub fn leave_at(&mut self, k: usize, temperature: f64, dt: f64) {
        if let Some(energies) = &mut self.energies {
            let reached = &mut energies.temperature[k].0;
            if dt > 0.0 || reached.is_nan() {
                *reached = temperature;
            }
        }
    }

    /// Pressure of row `k` at the volume ratio J, Pa, and the energy stored by the change of volume, J/m3;
    /// state advances by `dt`, s, and its heat.
    #[inline(always)]
    pub fn advance(&mut self, k: usize, j: f64, heat: StepHeat, dt: f64) -> (f64, f64) {
        match &mut self.energies {
            None => (self.law.cold(j), self.law.stored(j).unwrap_or(0.0)),
            Some(energies) => energies.advance(k, self.law, j, heat, dt),
        }
    }
}

/// The heat of a step per reference volume, J/m3.
#[derive(Clone, Copy)]
pub(super) struct StepHeat {
    /// Plastic work.
    pub plastic_work: f64,
    /// Heat of pair terms, friction and conduction.
    pub viscous: f64,
}

impl EnergyRows<'_> {
    /// Brings row `k` to the volume ratio J; returns the pressure, Pa, and the work stored by the change of
    /// volume, J/m3.
    ///
    /// The work is the mean of the pressures before and after times the change of volume; the pressure is
    /// linear in the energy, so that what it is after needs no iteration. All plastic work heats.
    #[inline(always)]
    fn advance(&mut self, k: usize, law: &PressureLaw, j: f64, heat: StepHeat, dt: f64) -> (f64, f64) {
        let StepHeat { plastic_work, viscous } = heat;
        let (internal, volume) = (&mut self.internal[k].0, &mut self.volume[k].0);
        let (plastic, viscous_heat) = (&mut self.plastic[k].0, &mut self.viscous[k].0);
        let gamma = law.gamma();
        let before = law.cold(*volume) + gamma * *internal;
        let change = j - *volume;
        let heated = *internal + plastic_work + viscous;
        let pressure =
            (law.cold(j) + gamma * (heated - 0.5 * before * change)) / (1.0 + 0.5 * gamma * change);
        let after = heated - 0.5 * (before + pressure) * change;
        let stored = after - (*plastic + plastic_work) - (*viscous_heat + viscous);
        if dt > 0.0 {
            (*internal, *volume) = (after, j);
            *plastic += plastic_work;
            *viscous_heat += viscous;
        }
        (pressure, stored)
    }
}
