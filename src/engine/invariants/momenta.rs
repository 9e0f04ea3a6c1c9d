//! Momentum and angular momentum of a body, and how far a free body is from keeping them.

use glam::DVec3;

use super::specimen::Specimen;
use crate::simulation::{RunError, Simulation};
use crate::world::{BodyId, Mass, MissingColumn, Position, Velocity};

/// Momenta of the first body.
#[derive(Clone, Copy, Debug)]
pub struct Momenta {
    /// Momentum, kg m/s.
    pub linear: DVec3,
    /// Angular momentum about the origin, kg m2/s.
    pub angular: DVec3,
    /// Sum of the sizes of the momenta of its particles, kg m/s.
    pub linear_size: f64,
    /// Sum of the sizes of the angular momenta of its particles, kg m2/s.
    pub angular_size: f64,
}

impl Momenta {
    /// Those of a simulation.
    ///
    /// # Errors
    /// The particles have no mass or velocity.
    pub fn of(simulation: &Simulation) -> Result<Self, MissingColumn> {
        let (view, rows) = simulation.world().body_view(BodyId(0));
        let (x, v, m) = (view.read::<Position>()?, view.read::<Velocity>()?, view.read::<Mass>()?);
        let momentum = |k: usize| m[k].0 * v[k].0;
        let spin = |k: usize| x[k].0.cross(momentum(k));
        Ok(Self {
            linear: rows.clone().map(momentum).sum(),
            angular: rows.clone().map(spin).sum(),
            linear_size: rows.clone().map(|k| momentum(k).length()).sum(),
            angular_size: rows.map(|k| spin(k).length()).sum(),
        })
    }
}

/// Largest changes of the conserved quantities of a free body during its run.
#[derive(Clone, Copy, Debug, Default)]
pub struct ConservationError {
    /// Of the momentum, over the sizes of the momenta of all particles.
    pub momentum: f64,
    /// Of the angular momentum, over the sizes of those of all particles.
    pub angular_momentum: f64,
    /// Of the stored energy, kinetic energy with it, over that at the start.
    pub energy: f64,
}

impl<E: From<RunError> + From<MissingColumn>> Specimen<'_, E> {
    /// Throws the specimen with a velocity at the start that is a function of place, and runs it to its end.
    ///
    /// # Errors
    /// The simulation cannot be built or fails.
    pub fn thrown(&self, velocity: impl Fn(DVec3) -> DVec3) -> Result<ConservationError, E> {
        let mut simulation = self.moved(|_, x| x, velocity)?;
        simulation.start()?;
        let start = Momenta::of(&simulation)?;
        let energy = simulation.ledger().stored();
        let mut found = ConservationError::default();
        while !simulation.is_finished() {
            simulation.step()?;
            found.energy = found.energy.max((simulation.ledger().stored() / energy - 1.0).abs());
            if simulation.clock().step % 100 == 0 {
                let now = Momenta::of(&simulation)?;
                let (linear, angular) = (now.linear - start.linear, now.angular - start.angular);
                found.momentum = found.momentum.max(linear.length() / start.linear_size);
                found.angular_momentum = found.angular_momentum.max(angular.length() / start.angular_size);
            }
        }
        Ok(found)
    }
}
