//! The motion of the material beside a particle with bonds, and the stress that has the effect of a force
//! there.

use glam::{DMat3, DVec3};

use super::bonds::Bonds;
use super::rows::PackedParticle;
use crate::parallel::{Picked, for_each_block, run_hot};
use crate::solids::{CorrectedStress, LocalFit, LocalMotion, RateSum};
use crate::symmetry::Ghosts;
use crate::world::{Mobility, Velocity};

/// Neighbours of the particles of a phase.
pub(in crate::formulations) struct BondedMotion<'a> {
    pub bonds: &'a Bonds,
    /// Places and volumes in the configuration of the weights.
    pub sites: &'a [PackedParticle],
    pub ghosts: &'a Ghosts,
    /// Gradients of that configuration, where it is not the reference.
    pub gradient: Option<&'a [DMat3]>,
}

impl BondedMotion<'_> {
    fn fit(&self, row: usize) -> LocalFit {
        let Self { bonds, gradient, .. } = *self;
        LocalFit {
            inverse: bonds.inverse_moment[row],
            first_moment: bonds.first_moment[row],
            gradient: gradient.map(|gradient| gradient[row]),
        }
    }

    /// [`SolidPhase::local_motion`](crate::solids::SolidPhase::local_motion).
    pub fn local_motion(
        &self,
        row: usize,
        velocity: &[Velocity],
        mobility: Mobility,
        moving: bool,
    ) -> LocalMotion {
        let Self { bonds, sites, ghosts, .. } = *self;
        let list = bonds.offsets[row] as usize..bonds.offsets[row + 1] as usize;
        let (neighbors, weights) = (&bonds.neighbors[list.clone()], &bonds.weights[list]);
        let sum = RateSum { row, neighbors, weights, points: sites, ghosts, velocity };
        self.fit(row).motion(if moving { run_hot(sum) } else { DMat3::ZERO }, velocity[row], mobility)
    }

    /// [`SolidPhase::add_couples`](crate::solids::SolidPhase::add_couples), to these stresses and self
    /// forces.
    pub fn add_couples(
        &self,
        first: usize,
        nodes: &[u32],
        couples: &[DMat3],
        stresses: &mut [CorrectedStress],
        self_force: &mut [DVec3],
    ) {
        let picked = Picked::new(nodes, &mut stresses[first..]);
        let rows = (picked, Picked::new(nodes, &mut self_force[first..]), couples);
        type Rows<'a> = (Picked<'a, CorrectedStress>, Picked<'a, DVec3>, &'a [DMat3]);
        for_each_block(rows, &mut Vec::new(), &|_, (mut stresses, mut self_force, couples): Rows<'_>| {
            for (k, couple) in couples.iter().enumerate().filter(|(_, couple)| **couple != DMat3::ZERO) {
                let row = first + self_force.number(k);
                let (fit, site) = (self.fit(row), &self.sites[row].reference);
                let stress = fit.corrected(couple) * (-1.0 / site.0[3]);
                stresses.row(k).add(&stress, site.xyz());
                *self_force.row(k) += stress * fit.first_moment;
            }
        });
    }
}
