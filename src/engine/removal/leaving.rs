//! How particles moved that are taken out in this step.

use std::ops::Range;

use glam::DVec3;

use crate::world::Force;

/// Velocities at mid-step of the particles of a phase that are taken out in this step, m/s. The last kick of their motion is one of forces that are
/// only made after they have gone, and whoever makes such forces books what that kick would have taken from them: a formulation that puts this into its phase,
/// and contact.
#[derive(Debug, Default)]
pub(crate) struct Leaving(Vec<(u32, DVec3)>);

impl Leaving {
    /// Forgets those of the step before.
    pub fn clear(&mut self) {
        self.0.clear();
    }

    /// Takes in a row.
    pub fn push(&mut self, row: u32, velocity: DVec3) {
        self.0.push((row, velocity));
    }

    /// The velocity of a row, m/s; zero if it has not gone in this step.
    pub fn velocity(&self, row: usize) -> DVec3 {
        self.0.iter().find(|entry| entry.0 as usize == row).map_or(DVec3::ZERO, |entry| entry.1)
    }

    /// The power of forces on those among some rows, W.
    pub fn power(&self, rows: &Range<usize>, force: &[Force]) -> f64 {
        let gone = self.0.iter().filter(|(row, _)| rows.contains(&(*row as usize)));
        gone.map(|(row, velocity)| force[*row as usize].0.dot(*velocity)).sum()
    }
}
