//! A body between scene and world: its particles are placed, its columns do not exist yet.

use std::ops::Range;
use std::sync::Arc;

use glam::DVec3;

use super::distances::Distances;
use super::error::SetupError;
use super::offers::{BodyKind, Offer};
use crate::kernels::KernelName;
use crate::materials::{FluidLaw, Law, Material, SolidLaw};
use crate::notation::number;
use crate::scene::{Problem, Vec3};
use crate::shapes::{Aabb, Site};
use crate::world::{BodyId, Column, ColumnSet, Damage, PhaseId};

/// How a side is held beside which particles carry shares of their stress.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum SideHold {
    /// Along its normal, and free along another axis.
    Drawn,
    /// Along its normal and perhaps others; the body continues beyond all of its edges, in mirror images or
    /// periods.
    Endless,
    /// Along all axes, where the body yields.
    Clamped,
}

/// A plane side of a body whose particles are held along its normal: they have been moved onto it.
#[derive(Clone, Debug)]
pub struct HeldSide {
    /// Unit normal out of the body.
    pub normal: DVec3,
    /// Axis and coordinate, m, of the plane.
    pub plane: (usize, f64),
    /// The particles, by their numbers, ascending, and how far they have been moved, m.
    pub moved: Vec<(u32, DVec3)>,
    /// How it is held.
    pub hold: SideHold,
}

impl HeldSide {
    /// Warning of a load or a contact that reaches the side across its normal, such as "`Pressure` on the
    /// body `b`", where it is not clamped.
    pub fn reached_by(&self, what: &str) -> Option<String> {
        if self.hold == SideHold::Clamped {
            return None;
        }
        let (axis, at) = (["X", "Y", "Z"][self.plane.0], number(self.plane.1));
        Some(format!(
            "{what} reaches its side at {} = {at} m, which is held along its normal alone: stresses in the two particles beside that edge are some 20 % off, however fine they are; `Symmetry(plane: {axis}, at: {at})` in the place of that support has 1 %",
            axis.to_lowercase()
        ))
    }
}

/// A body whose particles are placed.
#[derive(Clone)]
pub struct BodyPlan {
    /// Index in the scene.
    pub id: BodyId,
    /// Name in the scene.
    pub name: String,
    /// Phase of its formulation.
    pub phase: PhaseId,
    /// Name of its formulation.
    pub formulation: &'static str,
    /// Kind of the body for the rest of the scene.
    pub kind: BodyKind,
    /// Offers of its formulation to plugins, conditions and contacts.
    pub offers: &'static [Offer],
    /// Mean support radius of its particles, m; none where these have no neighbours of their own.
    pub support: Option<f64>,
    /// Kernel by which its formulation fits deformation gradients; none if it does so by other means.
    pub kernel: Option<KernelName>,
    /// Distances from which the weights of its formulation follow.
    pub distances: Distances,
    /// Rows in the phase.
    pub rows: Range<usize>,
    /// Distance of neighbouring particles, m.
    pub spacing: f64,
    /// Name of its material in the scene.
    pub material_name: String,
    /// Material.
    pub material: Material,
    /// Places and volumes of the particles, in row order.
    pub sites: Vec<Site>,
    /// Shares of their stress that particles beside the edge of a support carry, by their numbers; for all
    /// others the share is one.
    pub carried: Vec<(u32, f64)>,
    /// Held particles behind that edge, which do not interact, by their numbers, ascending.
    pub hidden: Vec<u32>,
    /// Sides beside which particles carry shares of their stress.
    pub sides: Vec<HeldSide>,
    /// Box around its shape, m.
    pub bounds: Aabb,
    /// Velocity at the start, m/s.
    pub velocity: Option<Vec3>,
}

impl BodyPlan {
    /// Whether its formulation offers this.
    pub fn offers(&self, offer: Offer) -> bool {
        self.offers.contains(&offer)
    }

    /// Sum of the volumes of its particles, m3 (m2 in two dimensions).
    pub fn volume(&self) -> f64 {
        self.sites.iter().map(|site| site.volume).sum()
    }

    /// Mass of its particles, by the density of its material, kg (kg/m in two dimensions).
    pub fn mass(&self) -> f64 {
        self.material.density * self.volume()
    }

    /// The law of the solid that the body is made of.
    ///
    /// # Errors
    /// Its material is not a solid.
    pub fn solid_law(&self) -> Result<&Arc<dyn SolidLaw>, SetupError> {
        match &self.material.law {
            Law::Solid(law) => Ok(law),
            _ => Err(self.wrong_material("a solid")),
        }
    }

    /// Whether it is a solid that can yield.
    pub fn yields(&self) -> bool {
        self.solid_law().is_ok_and(|law| law.initial_yield_stress().is_some_and(f64::is_finite))
    }

    /// Whether its particles can fail.
    pub fn can_fail(&self) -> bool {
        let mut state = ColumnSet::default();
        if let Ok(law) = self.solid_law() {
            law.state(&mut state);
        }
        state.get(Damage::NAME).is_some()
    }

    /// The specific heat of a solid whose material has one, J/(kg K).
    pub fn specific_heat(&self) -> Option<f64> {
        self.solid_law().ok()?.specific_heat()
    }

    /// The law of the fluid that the body is made of.
    ///
    /// # Errors
    /// Its material is not a fluid.
    pub fn fluid_law(&self) -> Result<&FluidLaw, SetupError> {
        match &self.material.law {
            Law::Fluid(law) => Ok(law),
            _ => Err(self.wrong_material("a fluid")),
        }
    }

    fn wrong_material(&self, wanted: &str) -> SetupError {
        let Self { name, material_name, formulation, .. } = self;
        let message = format!(
            "body `{name}` moves by `{formulation}`, and its material `{material_name}` is {}, not {wanted}",
            self.material.word()
        );
        let help = format!("give {wanted} as `material`, or another `formulation`");
        let problem = Problem::at_path(format!("bodies[{}].material", self.id.0), message).help(help);
        SetupError::Problems(vec![problem])
    }
}
