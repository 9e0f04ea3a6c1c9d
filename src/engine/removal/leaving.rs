//! The motion of particles removed in this step.

use std::ops::Range;

use glam::DVec3;

use crate::schedule::Shareable;
use crate::world::{Force, sum_by_row};

/// Name of the velocities of particles that are removed in this step, in the access of systems.
pub(crate) const LEAVING: &str = "leaving_particles";

impl Shareable for LeavingParticles {
    const ROWS: &'static [&'static str] = &[LEAVING];
}

/// Velocities at mid-step of the particles of a phase that are removed in this step, m/s. The last kick of
/// their motion is one of forces that are only computed after they have gone, and the system that computes
/// such forces books what that kick would have taken from them: a formulation that puts this into its phase,
/// and contact.
#[derive(Debug, Default)]
pub(crate) struct LeavingParticles(Vec<(u32, DVec3)>);

impl LeavingParticles {
    /// Forgets those of the step before.
    pub fn clear(&mut self) {
        self.0.clear();
    }

    /// Takes in a row.
    pub fn push(&mut self, row: u32, velocity: DVec3) {
        self.0.push((row, velocity));
    }

    /// Ends the step, after all rules: rows ascend from now on.
    pub fn sort(&mut self) {
        self.0.sort_unstable_by_key(|entry| entry.0);
    }

    /// The velocity of a row, m/s; zero if it has not gone in this step.
    pub fn velocity(&self, row: usize) -> DVec3 {
        let found = self.0.binary_search_by_key(&row, |entry| entry.0 as usize);
        found.map_or(DVec3::ZERO, |k| self.0[k].1)
    }

    /// The power of forces on those among the rows of a body, W.
    pub fn power(&self, rows: &Range<usize>, force: &[Force]) -> f64 {
        let below = |end: usize| self.0.partition_point(|entry| (entry.0 as usize) < end);
        let gone = &self.0[below(rows.start)..below(rows.end)];
        sum_by_row(rows.len(), gone.len(), &|k| gone[k].0 as usize - rows.start, &|k| {
            let (row, velocity) = gone[k];
            force[row as usize].0.dot(velocity)
        })
    }
}
