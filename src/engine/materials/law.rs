//! The material as the engine sees it, and the trait of a hyperelastic law.

use std::sync::Arc;

use glam::DMat3;
use schemars::JsonSchema;
use serde::de::DeserializeOwned;

use super::elastic_constants::ElasticConstants;
use super::error::ParameterError;
use super::fluid_law::FluidLaw;
use super::state::StateRows;
use super::stretches::Stretches;
use crate::parallel::{FourLanes, HotLoop, run_hot};
use crate::world::ColumnSet;

/// A material of a scene, ready for use.
#[derive(Clone)]
pub struct Material {
    /// Density in the reference configuration rho_0, kg/m3.
    pub density: f64,
    /// The constitutive law.
    pub law: Law,
}

/// The constitutive law of a material.
#[derive(Clone)]
pub enum Law {
    /// On the deformation.
    Solid(Arc<dyn SolidLaw>),
    /// On density and shear rate.
    Fluid(FluidLaw),
    /// On nothing: walls that are no more than a surface.
    Nothing,
}

impl Material {
    /// A solid of reference density rho_0, kg/m3.
    pub fn solid(density: f64, law: impl SolidLaw + 'static) -> Self {
        Self { density, law: Law::Solid(Arc::new(law)) }
    }

    /// The empty material of walls that name no material of the scene: they have no mass.
    pub fn nothing() -> Self {
        Self { density: 0.0, law: Law::Nothing }
    }

    /// The kind of the material, in words.
    pub fn word(&self) -> &'static str {
        match self.law {
            Law::Solid(_) => "a solid",
            Law::Fluid(_) => "a fluid",
            Law::Nothing => "no material",
        }
    }

    /// Speed of sound, m/s: of longitudinal waves in a solid; none where the material does not say.
    pub fn sound_speed(&self) -> Option<f64> {
        match &self.law {
            Law::Solid(law) => Some(law.elastic().longitudinal_speed(self.density)),
            Law::Fluid(law) => law.sound_speed,
            Law::Nothing => None,
        }
    }
}

/// A material as a scene names it: its fields are its parameters.
pub trait MaterialModel: DeserializeOwned + JsonSchema + 'static {
    /// Name in scenes.
    const NAME: &'static str;
    /// Source of the law.
    const REFERENCE: &'static str;

    /// Checks the parameters and makes the material.
    fn build(self) -> Result<Material, ParameterError>;
}

/// A block of particles of one material: deformation and state in, stress and state out. All slices have one
/// length.
pub struct StressRows<'a> {
    /// Time in which the deformation came about since the last call, s. Every accepted step makes one call.
    /// With 0, in the evaluation before the first step, state must stay as it is.
    pub dt: f64,
    /// Deformation gradient F at the end of the step; in plane strain F_33 = 1.
    pub deformation: &'a [DMat3],
    /// Share of what a particle makes of its stress that it carries, 1 as a rule, other beside what is held.
    /// The caller takes the outputs by that share; energy that a law books in columns of its own has to be
    /// multiplied with it.
    pub share: &'a [f64],
    /// First Piola-Kirchhoff stress P at the end of the last step, Pa; zero before the first. Empty for a law
    /// that does not ask for it by [`SolidLaw::reads_last_stress`].
    pub stress_before: &'a [DMat3],
    /// First Piola-Kirchhoff stress P, Pa: to be written. What stands there before the call is of no account,
    /// in this and in the other outputs, unless they say so.
    pub stress: &'a mut [DMat3],
    /// Strain energy per reference volume, J/m3: to be written.
    pub energy: &'a mut [f64],
    /// Young's modulus as it is now, Pa: to be written. Hourglass control resists with it.
    pub modulus: &'a mut [f64],
    /// Stress beyond which a particle that has yielded flows, Pa; infinite before the call, for all that has
    /// not.
    pub strength: &'a mut [f64],
    /// Plastic work done in this step per reference volume, J/m3; zero before the call. Heat that it turns
    /// into is part of it.
    pub plastic_work: &'a mut [f64],
    /// The columns that the law has declared in [`SolidLaw::state`].
    pub state: StateRows<'a>,
}

/// A solid law, called once for every block of particles.
pub trait SolidLaw: Send + Sync {
    /// Elastic constants at small strain.
    fn elastic(&self) -> &ElasticConstants;

    /// Whether the law has no meaning for a particle that is inverted (det F <= 0).
    fn needs_positive_volume(&self) -> bool;

    /// Whether the stress depends on the path to F, as with plastic flow: where the neighbourhood of a
    /// particle is cut, and its F measured anew, the law then goes on from the F that it knows.
    fn remembers_path(&self) -> bool {
        false
    }

    /// Whether the law reads the stress of the last step, which is then kept for it. A law around another
    /// asks for it if that one does.
    fn reads_last_stress(&self) -> bool {
        false
    }

    /// Stress at which plastic flow begins, Pa; none for laws without plasticity.
    fn initial_yield_stress(&self) -> Option<f64> {
        None
    }

    /// Specific heat, J/(kg K), of laws that have a temperature which heat changes.
    fn specific_heat(&self) -> Option<f64> {
        None
    }

    /// Factor of the stable time step at the extreme stretches of a body, as seen from the undeformed
    /// configuration.
    fn stable_step_factor(&self, stretches: &Stretches) -> f64;

    /// Largest speed of longitudinal waves in the deformed material, over present lengths and with the stress
    /// that it is under, over that of the undeformed one, at the extreme stretches of a body.
    fn wave_factor(&self, stretches: &Stretches) -> f64 {
        // Seen from the undeformed configuration it is 1 / stable_step_factor, and lengths have grown by the
        // stretch.
        stretches.largest.max(1.0) / self.stable_step_factor(stretches)
    }

    /// Adds the columns that hold the state of the law, at most [`MAX_STATE`](super::MAX_STATE).
    fn state(&self, _columns: &mut ColumnSet) {}

    /// Fills the state of undeformed particles, before the first step; it is zero before the call.
    fn start(&self, _state: StateRows<'_>) {}

    /// Computes stress, energy and modulus of a block, and advances its state by the step.
    fn stress(&self, rows: &mut StressRows<'_>);
}

/// A hyperelastic law: stress and energy are functions of the deformation gradient. Every such law is a
/// [`SolidLaw`].
pub trait Hyperelastic: Copy + Send + Sync + 'static {
    /// Whether the law has no meaning for det F <= 0.
    const NEEDS_POSITIVE_VOLUME: bool;

    /// Elastic constants at small strain.
    fn elastic(&self) -> &ElasticConstants;

    /// Factor of the stable time step at the smallest and largest principal stretch of a body. Lateral
    /// contraction raises the stiffness seen from the reference configuration as 1/stretch^2.
    fn stable_step_factor(&self, smallest: f64, _largest: f64) -> f64 {
        smallest.min(1.0)
    }

    /// Largest speed of longitudinal waves in the deformed material, over present lengths, over that of the
    /// undeformed one (see [`SolidLaw::wave_factor`]).
    fn wave_factor(&self, stretches: &Stretches) -> f64 {
        stretches.largest.max(1.0) / self.stable_step_factor(stretches.smallest, stretches.largest)
    }

    /// First Piola-Kirchhoff stress P = d psi / d F, Pa, and strain energy per reference volume psi, J/m3.
    ///
    /// Mark it `#[inline(always)]`: it is compiled into the hot loop of every instruction path.
    fn stress_and_energy(&self, f: &DMat3) -> (DMat3, f64);
}

struct StressLoop<'a, 'r, H> {
    law: H,
    rows: &'a mut StressRows<'r>,
}

impl<H: Hyperelastic> HotLoop for StressLoop<'_, '_, H> {
    type Output = ();

    #[inline(always)]
    fn run<A: FourLanes>(self, _: A) {
        let young = self.law.elastic().young;
        let StressRows { deformation, stress, energy, modulus, .. } = self.rows;
        let n = deformation.len();
        let (stress, energy) = (&mut stress[..n], &mut energy[..n]);
        for k in 0..n {
            (stress[k], energy[k]) = self.law.stress_and_energy(&deformation[k]);
        }
        modulus.fill(young);
    }
}

impl<H: Hyperelastic> SolidLaw for H {
    fn elastic(&self) -> &ElasticConstants {
        Hyperelastic::elastic(self)
    }

    fn needs_positive_volume(&self) -> bool {
        H::NEEDS_POSITIVE_VOLUME
    }

    fn stable_step_factor(&self, stretches: &Stretches) -> f64 {
        Hyperelastic::stable_step_factor(self, stretches.smallest, stretches.largest)
    }

    fn wave_factor(&self, stretches: &Stretches) -> f64 {
        Hyperelastic::wave_factor(self, stretches)
    }

    fn stress(&self, rows: &mut StressRows<'_>) {
        run_hot(StressLoop { law: *self, rows });
    }
}
