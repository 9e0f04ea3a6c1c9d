//! The packed rows of the phase, and its interface to the rest of the engine.

use std::ops::Range;

use glam::{DMat3, DVec3};

use crate::formulations::bonded::{
    AffineFrame, BodyKernel, BondedRows, Bonds, Cracks, HessianRows, PackedParticle, fill_ghosts,
};
use crate::parallel::{BLOCK, FourLanes, HotLoop, Lanes4, Picked, for_each_block, own_rows, run_hot};
use crate::ranks::Halo;
use crate::solids::{CorrectedStress, LocalMotion, SolidPhase};
use crate::symmetry::Ghosts;
use crate::world::{Mobility, Velocity};

/// Shared data of the systems of the formulation.
pub(in crate::formulations) struct PackedRows {
    pub bonds: Bonds,
    pub ghosts: Ghosts,
    /// Where the reference positions of sites are measured from, m.
    pub origin: DVec3,
    pub sites: Vec<PackedParticle>,
    pub stresses: Vec<CorrectedStress>,
    /// The part of the force on each particle that comes from its own corrected stress, over its volume.
    pub self_force: Vec<DVec3>,
    /// Of every body, in the order of rows.
    pub frames: Vec<AffineFrame>,
    pub cracks: Cracks,
    /// Rows of other ranks that the passes read.
    pub halo: Halo,
    pub hessian: HessianRows,
    pub kernels: Vec<BodyKernel>,
    /// Stable step of each body in its reference configuration, s.
    pub stable_step: Vec<f64>,
    /// Whether the sites of all rows have their reference positions and volumes.
    pub has_places: bool,
}

/// The row in the middle of a body, whose motion is the frame of the body.
pub(super) fn middle(body: &Range<usize>) -> usize {
    body.start + body.len() / 2
}

impl PackedRows {
    /// Makes the halo of the present cut among ranks: rows of bonds of the own rows, and the middles of
    /// `bodies`, whose motion all ranks take as frames.
    pub fn make_halo(&mut self, bodies: &[Range<usize>]) {
        let Self { bonds, ghosts, .. } = self;
        let mut wanted = vec![false; bodies.last().map_or(0, |body| body.end)];
        for body in bodies {
            wanted[middle(body)] = true;
            for row in own_rows(body) {
                bonds.row(row).for_each(|(j, _)| wanted[ghosts.source(j)] = true);
            }
        }
        self.halo = Halo::of(bodies, BLOCK, &wanted);
        self.has_places = false;
    }

    /// Fills the sites of the ghosts.
    pub fn fill_ghost_sites(&mut self) {
        let Self { ghosts, sites, origin, .. } = self;
        ghosts.fill(sites, |ghost, site: &PackedParticle| {
            let reference = ghost.map.place(site.reference.xyz() + *origin) - *origin;
            PackedParticle::new(reference, ghost.map.vector(site.displacement.xyz()), site.reference.0[3])
        });
    }

    /// Fills the stresses of the ghosts, which have their sites.
    pub fn fill_ghost_stresses(&mut self) {
        let Self { ghosts, frames, sites, stresses, hessian, .. } = self;
        fill_ghosts(ghosts, frames, sites, stresses, |row| hessian.bond_force_of(row));
    }
}

impl BondedRows for PackedRows {
    fn bonds(&self) -> &Bonds {
        &self.bonds
    }

    fn pair_sites(&self) -> &[PackedParticle] {
        &self.sites
    }

    fn kernels(&self) -> &[BodyKernel] {
        &self.kernels
    }
}

impl SolidPhase for PackedRows {
    fn ghosts(&self) -> &Ghosts {
        &self.ghosts
    }

    fn neighbors(&self, row: usize, f: &mut dyn FnMut(usize, f64)) {
        self.bonds.for_each_present(&self.sites, row, f);
    }

    fn local_motion(
        &self,
        row: usize,
        velocity: &[Velocity],
        mobility: Mobility,
        moving: bool,
    ) -> LocalMotion {
        let inverse = &self.bonds.inverse_moment[row];
        let sum = if moving { run_hot(RateSum { packed: self, row, velocity }) } else { DMat3::ZERO };
        LocalMotion {
            velocity: velocity[row].0,
            rate: sum * inverse.to_matrix(),
            mobility: mobility.0,
            own: *inverse * self.bonds.first_moment[row],
        }
    }

    fn add_couples(&mut self, first: usize, nodes: &[u32], couples: &[DMat3]) {
        let Self { bonds, sites, stresses, self_force, .. } = self;
        let picked = Picked::new(nodes, &mut stresses[first..]);
        let rows = (picked, Picked::new(nodes, &mut self_force[first..]), couples);
        type Rows<'a> = (Picked<'a, CorrectedStress>, Picked<'a, DVec3>, &'a [DMat3]);
        for_each_block(rows, &mut Vec::new(), &|_, (mut stresses, mut self_force, couples): Rows<'_>| {
            for (k, couple) in couples.iter().enumerate().filter(|(_, couple)| **couple != DMat3::ZERO) {
                let row = first + self_force.number(k);
                let site = &sites[row].reference;
                let stress = *couple * bonds.inverse_moment[row].to_matrix() * (-1.0 / site.0[3]);
                stresses.row(k).add(&stress, site.xyz());
                *self_force.row(k) += stress * bonds.first_moment[row];
            }
        });
    }

    fn keeps_reference(&self) -> bool {
        true
    }

    fn renew_ghosts(&mut self) {
        self.fill_ghost_stresses();
    }
}

/// The sum of V_j w_ij v_ij (x) X_ij over the neighbours of a particle.
struct RateSum<'a> {
    packed: &'a PackedRows,
    row: usize,
    velocity: &'a [Velocity],
}

impl HotLoop for RateSum<'_> {
    type Output = DMat3;

    #[inline(always)]
    fn run<A: FourLanes>(self, a: A) -> DMat3 {
        let Self { packed, row, velocity } = self;
        let (bonds, sites, ghosts) = (&packed.bonds, &packed.sites, &packed.ghosts);
        let (own, v) = (sites[row].reference, Lanes4::new(velocity[row].0, 0.0));
        let mut sum = [Lanes4::ZERO; 3];
        for k in bonds.offsets[row] as usize..bonds.offsets[row + 1] as usize {
            let j = bonds.neighbors[k] as usize;
            let other = sites[j].reference;
            let there = match velocity.get(j) {
                Some(there) if ghosts.is_empty() => there.0,
                _ => velocity[ghosts.source(j)].0 * ghosts.mirror(j).unwrap_or(DVec3::ONE),
            };
            let v_ij = a.minus(Lanes4::new(there, 0.0), v);
            let weighted = a.scale(f64::from(bonds.weights[k]) * other.0[3], v_ij);
            let x_ij = a.minus(other, own);
            for (axis, sum) in sum.iter_mut().enumerate() {
                *sum = a.scale_add(x_ij.0[axis], weighted, *sum);
            }
        }
        DMat3::from_cols(sum[0].xyz(), sum[1].xyz(), sum[2].xyz())
    }
}
