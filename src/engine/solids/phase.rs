//! The interface of a phase of solids to contact, fields and the command line.

use std::any::Any;
use std::cell::{Ref, RefMut};

use glam::DMat3;

use super::local_motion::LocalMotion;
use crate::schedule::{Resources, Shareable};
use crate::symmetry::Ghosts;
use crate::world::{Mobility, PhaseId, Velocity};

/// Packed data of the particles of a solid: pair vectors, weights, lists, fits. In the access of
/// systems.
pub const PACKED_SOLID: &str = "packed_solid";
/// Record of the stress of a particle for its neighbours, A = P M^-1
/// ([`CorrectedStress`](super::CorrectedStress)). In the access of systems.
pub const CORRECTED_STRESS: &str = "corrected_stress";

impl Shareable for Box<dyn SolidPhase> {
    const ROWS: &'static [&'static str] = &[PACKED_SOLID, CORRECTED_STRESS];
}

/// The packed rows of a solid formulation, one object per phase. The formulation puts it into the resources
/// at set-up ([`Resources::insert_solid`]) and borrows it there for its passes
/// ([`Resources::solid_rows_mut`]).
pub trait SolidPhase: Any + Send + Sync {
    /// The ghosts behind the real rows: [`Ghosts::pair`] gives X_ij and x_ij from reference and current
    /// positions.
    fn ghosts(&self) -> &Ghosts;

    /// Calls `f` with the packed row and the pair weight w_ij of every neighbour of a row that has not been
    /// removed.
    fn neighbors(&self, row: usize, f: &mut dyn FnMut(usize, f64));

    /// The weight of the place of a particle in integrals over its body, such as those of energy and heat:
    /// usually 1, different beside supports.
    fn share(&self, _row: usize) -> f64 {
        1.0
    }

    /// Whether a particle has no deformation gradient since it has lost neighbours: it is no part of a solid.
    fn has_lost_its_fit(&self, _row: usize) -> bool {
        false
    }

    /// Whether two particles that are near each other now are neighbours by kernels of the present
    /// configuration, so that contact of a body with itself must leave them out. For kernels of a reference
    /// configuration the distance there decides.
    fn holds_together(&self, _row: usize, _other: usize) -> bool {
        false
    }

    /// Motion of the material points beside a particle, with the velocities of all rows; where velocities
    /// beside the particle are not requested (`moving`), they are not computed.
    fn local_motion(
        &self,
        row: usize,
        velocity: &[Velocity],
        mobility: Mobility,
        moving: bool,
    ) -> LocalMotion;

    /// Adds forces on points of the material beside particles, before the pass of the force: the sums `f (x)
    /// A`, N m, over the points A in the reference configuration. The particles are `nodes`, ascending, of
    /// the body whose first row is `first`. On a particle of volume V the stress is `P = -f (x) A / V`.
    fn add_couples(&mut self, first: usize, nodes: &[u32], couples: &[DMat3]);

    /// Whether the reference configuration is never updated: contact then keeps its reference from step to
    /// step.
    fn keeps_reference(&self) -> bool {
        false
    }

    /// Copies stress that was added to the ghosts.
    fn renew_ghosts(&mut self);
}

impl Resources {
    /// Puts the packed rows of a phase of solids in their place.
    pub fn insert_solid(&mut self, phase: PhaseId, rows: impl SolidPhase) {
        let rows: Box<dyn SolidPhase> = Box::new(rows);
        self.insert_of(phase, rows);
    }

    /// A phase of solids for reading; none where the phase is not one of solids.
    pub fn solid(&self, phase: PhaseId) -> Option<Ref<'_, dyn SolidPhase>> {
        Some(Ref::map(self.try_get_of::<Box<dyn SolidPhase>>(phase)?, |rows| &**rows))
    }

    /// A phase of solids for writing; none where the phase is not one of solids.
    pub fn solid_mut(&self, phase: PhaseId) -> Option<RefMut<'_, dyn SolidPhase>> {
        Some(RefMut::map(self.try_get_mut_of::<Box<dyn SolidPhase>>(phase)?, |rows| &mut **rows))
    }

    /// The packed rows of a formulation for reading. Panics where the phase has none of that type.
    pub fn solid_rows<T: SolidPhase>(&self, phase: PhaseId) -> Ref<'_, T> {
        let rows = self.solid(phase).and_then(|rows| {
            Ref::filter_map(rows, |rows| {
                let any: &dyn Any = rows;
                any.downcast_ref()
            })
            .ok()
        });
        rows.unwrap_or_else(|| panic!("no packed rows of type {}", std::any::type_name::<T>()))
    }

    /// The packed rows of a formulation for writing. Panics where the phase has none of that type.
    pub fn solid_rows_mut<T: SolidPhase>(&self, phase: PhaseId) -> RefMut<'_, T> {
        let rows = self.solid_mut(phase).and_then(|rows| {
            RefMut::filter_map(rows, |rows| {
                let any: &mut dyn Any = rows;
                any.downcast_mut()
            })
            .ok()
        });
        rows.unwrap_or_else(|| panic!("no packed rows of type {}", std::any::type_name::<T>()))
    }
}
