//! The bodies of a flow, and their roles in it.

use std::ops::Range;

use glam::DVec3;

use crate::materials::EquationOfState;
use crate::world::{BodyId, PhaseId};

/// The equation of state of a body, with its constants.
#[derive(Clone, Copy, Debug)]
pub struct FluidState {
    /// Density at zero pressure rho_0, kg/m3.
    pub density: f64,
    /// Speed of sound c_0, m/s.
    pub sound_speed: f64,
    /// Dynamic viscosity mu, Pa s.
    pub viscosity: f64,
    /// Pressure as a function of density.
    pub eos: EquationOfState,
}

impl FluidState {
    /// Bulk modulus rho_0 c_0^2, Pa.
    #[inline]
    pub fn bulk_modulus(&self) -> f64 {
        self.density * self.sound_speed * self.sound_speed
    }

    /// Harmonic mean of the viscosities of two fluids, Pa s.
    #[inline]
    pub fn viscosity_with(&self, other: &Self) -> f64 {
        let sum = self.viscosity + other.viscosity;
        if sum > 0.0 { 2.0 * self.viscosity * other.viscosity / sum } else { 0.0 }
    }
}

/// Role of the particles of a group in the flow.
#[derive(Clone, Copy, Debug)]
pub enum Role {
    /// They flow.
    Fluid(FluidState),
    /// They bound the flow.
    Boundary(BoundarySurface),
}

/// Surface properties of a boundary.
#[derive(Clone, Copy, Debug)]
pub struct BoundarySurface {
    /// Whether the fluid sticks to it.
    pub no_slip: bool,
    /// Whether its pressure may be negative.
    pub suction: bool,
    /// Velocity of the surface beside that of the particles, m/s.
    pub velocity: DVec3,
    /// Whether it is that of a body which the fluid moves.
    pub moved: bool,
    /// Whether it is that of a rigid body which nothing holds.
    pub falls: bool,
}

/// The particles of one body.
#[derive(Clone, Debug)]
pub struct Group {
    /// Body.
    pub body: BodyId,
    /// Its phase.
    pub phase: PhaseId,
    /// Its rows in the phase.
    pub rows: Range<usize>,
    /// Its rows in the cloud.
    pub cloud: Range<usize>,
    /// Role in the flow.
    pub role: Role,
    /// Whether someone holds particles by their rows, so that these must not be sorted.
    pub held: bool,
    /// Whether it takes sub-steps in those of the flow.
    pub short: bool,
}

impl Group {
    /// Whether it is a boundary whose pressure may be negative.
    pub fn has_suction(&self) -> bool {
        matches!(&self.role, Role::Boundary(surface) if surface.suction)
    }

    /// Whether it is a boundary to which the fluid sticks.
    pub fn sticks(&self) -> bool {
        matches!(&self.role, Role::Boundary(surface) if surface.no_slip)
    }

    /// Whether it is a boundary that no fluid moves.
    pub fn is_wall(&self) -> bool {
        matches!(&self.role, Role::Boundary(surface) if !surface.moved)
    }

    /// Whether it is a boundary that does not fall as a whole.
    pub fn stays(&self) -> bool {
        matches!(&self.role, Role::Boundary(surface) if !surface.falls)
    }

    /// The state of a fluid.
    pub fn fluid(&self) -> Option<&FluidState> {
        match &self.role {
            Role::Fluid(state) => Some(state),
            Role::Boundary(_) => None,
        }
    }
}
