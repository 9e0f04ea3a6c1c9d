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
    /// A solid: stress from the deformation.
    Solid(Arc<dyn SolidLaw>),
    /// A fluid: stress from density and shear rate.
    Fluid(FluidLaw),
    /// None: walls, which are only a surface.
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

    /// Checks the parameters and creates the material. An error if a parameter is out of its range.
    fn build(self) -> Result<Material, ParameterError>;
}

/// A block of particles of one material: deformation and state in, stress and state out. All slices have one
/// length.
pub struct StressRows<'a> {
    /// Time since the last call, s. There is one call for every accepted step. With 0, in the evaluation
    /// before the first step, the state must not change.
    pub dt: f64,
    /// Deformation gradient F at the end of the step; in plane strain F_33 = 1.
    pub deformation: &'a [DMat3],
    /// Share of its stress that a particle carries: usually 1, different beside supports. The caller
    /// multiplies the outputs by this share; a law must multiply energies that it stores in its own columns.
    pub share: &'a [f64],
    /// First Piola-Kirchhoff stress P at the end of the last step, Pa; zero before the first. Empty for a law
    /// without [`SolidLaw::reads_last_stress`].
    pub stress_before: &'a [DMat3],
    /// First Piola-Kirchhoff stress P, Pa: to be written. Values before the call have no meaning, in this and
    /// in the other outputs, unless stated.
    pub stress: &'a mut [DMat3],
    /// Strain energy per reference volume, J/m3: to be written.
    pub energy: &'a mut [f64],
    /// Current Young's modulus, Pa: to be written. Hourglass control uses it as its stiffness.
    pub modulus: &'a mut [f64],
    /// Current flow stress of a particle that has yielded, Pa; infinite before the call, and to be left so
    /// for others.
    pub strength: &'a mut [f64],
    /// Plastic work in this step per reference volume, J/m3, heat included; zero before the call.
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

    /// Whether the stress depends on the path to F, as with plastic flow: where neighbours of a particle are
    /// lost and its F is fitted anew, the law then continues from the F that it knows.
    fn remembers_path(&self) -> bool {
        false
    }

    /// Whether the law reads the stress of the last step, which is then kept for it. A law that wraps another
    /// one returns true if that one does.
    fn reads_last_stress(&self) -> bool {
        false
    }

    /// Stress at which plastic flow begins, Pa; none for laws without plasticity.
    fn initial_yield_stress(&self) -> Option<f64> {
        None
    }

    /// Specific heat, J/(kg K), of laws whose temperature changes with heat.
    fn specific_heat(&self) -> Option<f64> {
        None
    }

    /// Rise of the temperature for each J/m3 of plastic work, K m3/J, of laws that heat by it; they have the
    /// column [`Temperature`](crate::world::Temperature).
    fn plastic_heating(&self) -> f64 {
        0.0
    }

    /// Factor of the stable time step at the extreme stretches of a body, as seen from the undeformed
    /// configuration.
    fn stable_step_factor(&self, stretches: &Stretches) -> f64;

    /// Largest speed of longitudinal waves in the deformed material, over present lengths and under the
    /// present stress, over that of the undeformed one, at the extreme stretches of a body.
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
