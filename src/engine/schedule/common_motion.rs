//! What a uniform motion of the whole scene adds to its energies.
//!
//! A scene that moves as a whole is the same scene, but its energies are not the same: kinetic energy, and
//! the work of every force that does not act between its parts, depend on the velocity of who measures them.
//! Criteria that compare energies take those in the frame of the [`CommonMotion`], in which the boundaries,
//! or else the centre of mass, were at rest at the start. In that frame the balance has the same error,
//! because forces and the change of momentum agree: the work of forces other than gravity follows from it.

use glam::DVec3;
use serde::{Deserialize, Serialize};

/// Energies over that of the uniform motion below which they are round-off.
const DIGITS: f64 = 1e-9;

/// The uniform motion of a scene, and what it adds to the energies.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct CommonMotion {
    /// Velocity of the frame, m/s.
    pub velocity: DVec3,
    /// What it adds to the kinetic energy of each body, J.
    pub kinetic: Vec<f64>,
    /// The same of all bodies at the start, J.
    at_start: f64,
    /// What it adds to the work of gravity since the start, J.
    pub gravity: f64,
}

impl CommonMotion {
    /// A motion with that velocity, m/s, which adds so much to the kinetic energy of each body, J.
    pub fn new(velocity: DVec3, kinetic: Vec<f64>) -> Self {
        let at_start = kinetic.iter().sum();
        Self { velocity, kinetic, at_start, gravity: 0.0 }
    }

    /// What it adds to the kinetic energy of all bodies, J.
    pub fn total(&self) -> f64 {
        self.kinetic.iter().sum()
    }

    /// What it adds to the work of all forces but gravity, J.
    pub fn others(&self) -> f64 {
        self.total() - self.at_start - self.gravity
    }

    /// Energies below this are round-off, J.
    pub fn resolution(&self) -> f64 {
        DIGITS * self.total().abs()
    }
}
