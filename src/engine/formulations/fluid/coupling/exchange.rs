//! Force, impulse and motion exchanged between a flow and bodies that take sub-steps beside it.

use crate::formulations::fluid::cloud::PARTS;
use crate::parallel::BlockSum;

crate::column! {
    /// Force of the flow in the last long step.
    pub struct CouplingForce(glam::DVec3) = "coupling_force", "f_c", "N";
}
crate::column! {
    /// Viscous part of the force of the flow.
    pub struct CouplingFriction(glam::DVec3) = "coupling_friction", "f_v", "N";
}
crate::column! {
    /// Part of the force of the flow that is due to the pressure of the boundary.
    pub struct CouplingPressure(glam::DVec3) = "coupling_pressure", "f_w", "N";
}

/// Work of the change of the force, J.
#[derive(Clone, Copy, Debug, Default)]
pub struct Exchange {
    /// Gain of kinetic energy.
    pub kinetic: f64,
    /// Work of constraints.
    pub constraints: f64,
    /// Correction of the energy that removed particles took along.
    pub removed: f64,
    /// Work of the parts of the force over the long step.
    pub parts: [f64; PARTS],
}

impl BlockSum for Exchange {
    fn add(&mut self, next: &Self) {
        self.kinetic += next.kinetic;
        self.constraints += next.constraints;
        self.removed += next.removed;
        (0..PARTS).for_each(|part| self.parts[part] += next.parts[part]);
    }
}
