//! The interface of the phase to the rest of the engine.

use glam::{DMat3, DVec3};

use super::rows::EulerianRows;
use crate::linalg::dyad;
use crate::solids::{LocalMotion, SolidPhase};
use crate::symmetry::Ghosts;
use crate::world::{Mobility, Velocity};

impl SolidPhase for EulerianRows {
    fn ghosts(&self) -> &Ghosts {
        &self.lists.ghosts
    }

    fn neighbors(&self, row: usize, f: &mut dyn FnMut(usize, f64)) {
        let (neighbors, weights) = self.near.row(self.lists.offsets[row], row);
        neighbors.iter().zip(weights).for_each(|(&j, &weight)| f(j as usize, weight));
    }

    fn holds_together(&self, row: usize, other: usize) -> bool {
        let (neighbors, _) = self.near.row(self.lists.offsets[row], row);
        neighbors.iter().any(|&j| self.lists.ghosts.source(j as usize) == other)
    }

    fn local_motion(
        &self,
        row: usize,
        velocity: &[Velocity],
        mobility: Mobility,
        moving: bool,
    ) -> LocalMotion {
        let around = &self.near.around[row];
        let mut sum = DMat3::ZERO;
        if moving {
            let (ghosts, own) = (&self.lists.ghosts, self.points[row].place);
            self.neighbors(row, &mut |j, weight| {
                let signs = ghosts.mirror(j).unwrap_or(DVec3::ONE);
                let v_ij = velocity[ghosts.source(j)].0 * signs - velocity[row].0;
                let other = self.points[j].place;
                let arm = (other.xyz() - own.xyz()) * (weight * other.0[3]);
                sum += dyad(v_ij, arm);
            });
        }
        // A point A of the reference configuration lies at F A from the particle.
        let f = self.deformation[row];
        LocalMotion {
            velocity: velocity[row].0,
            rate: sum * around.inverse_moment.to_matrix() * f,
            mobility: mobility.0,
            own: f.transpose() * (around.inverse_moment * around.first_moment),
        }
    }

    fn add_couples(&mut self, first: usize, nodes: &[u32], couples: &[DMat3]) {
        for (&node, couple) in nodes.iter().zip(couples).filter(|(_, couple)| **couple != DMat3::ZERO) {
            let row = first + node as usize;
            let (volume, measure) = (self.points[row].place.0[3], self.stresses[row].traction.0[3]);
            if measure > 0.0 {
                let pulled = *couple * self.deformation[row].transpose();
                let corrected = pulled * self.near.around[row].inverse_moment.to_matrix();
                // On particles of like density the sums of the force take it as a stress of this volume.
                let stress = corrected * (-volume / (measure * measure));
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
