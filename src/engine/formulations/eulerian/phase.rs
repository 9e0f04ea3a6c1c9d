//! The interface of the phase to the rest of the engine.

use glam::DMat3;

use super::near::NearbyMotion;
use super::particle::EulerianParticle;
use super::rows::EulerianRows;
use crate::parallel::{Lanes4, run_hot};
use crate::solids::{HasPlace, LocalFit, LocalMotion, RateSum, SolidPhase};
use crate::symmetry::Ghosts;
use crate::world::{Mobility, Velocity};

impl HasPlace for EulerianParticle {
    #[inline(always)]
    fn place(&self) -> Lanes4 {
        self.place
    }
}

impl EulerianRows {
    fn fit(&self, row: usize) -> LocalFit {
        let NearbyMotion { inverse_moment, first_moment, .. } = self.near.around[row];
        LocalFit { inverse: inverse_moment, first_moment, gradient: Some(self.deformation[row]) }
    }
}

impl SolidPhase for EulerianRows {
    fn ghosts(&self) -> &Ghosts {
        &self.lists.ghosts
    }

    fn neighbors(&self, row: usize, f: &mut dyn FnMut(usize, f64)) {
        let (neighbors, weights) = self.near.row(self.lists.pairs.offsets()[row], row);
        neighbors.iter().zip(weights).for_each(|(&j, &weight)| f(j as usize, weight));
    }

    fn holds_together(&self, row: usize, other: usize) -> bool {
        let (neighbors, _) = self.near.row(self.lists.pairs.offsets()[row], row);
        neighbors.iter().any(|&j| self.lists.ghosts.source(j as usize) == other)
    }

    fn local_motion(
        &self,
        row: usize,
        velocity: &[Velocity],
        mobility: Mobility,
        moving: bool,
    ) -> LocalMotion {
        let (neighbors, weights) = self.near.row(self.lists.pairs.offsets()[row], row);
        let (points, ghosts) = (&self.points[..], &self.lists.ghosts);
        let sum = RateSum { row, neighbors, weights, points, ghosts, velocity };
        self.fit(row).motion(if moving { run_hot(sum) } else { DMat3::ZERO }, velocity[row], mobility)
    }

    fn add_couples(&mut self, first: usize, nodes: &[u32], couples: &[DMat3]) {
        for (&node, couple) in nodes.iter().zip(couples).filter(|(_, couple)| **couple != DMat3::ZERO) {
            let row = first + node as usize;
            let (volume, measure) = (self.points[row].place.0[3], self.stresses[row].traction.0[3]);
            if measure > 0.0 {
                // On particles of like density the sums of the force take it as a stress of this volume.
                let stress = self.fit(row).corrected(couple) * (-volume / (measure * measure));
                for (column, add) in
                    self.stresses[row].columns.iter_mut().zip([stress.x_axis, stress.y_axis, stress.z_axis])
                {
                    (0..3).for_each(|axis| column.0[axis] += add[axis]);
                }
            }
        }
    }

    fn renew_ghosts(&mut self) {
        self.fill_ghost_stresses();
    }
}
