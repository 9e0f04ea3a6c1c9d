//! The packed rows of the phase, and its interface to the rest of the engine.

use std::ops::Range;

use glam::{DMat3, DVec3};

use crate::formulations::bonded::{
    AffineFrame, BodyKernel, BondedMotion, BondedRows, Bonds, Cracks, HessianRows, PackedParticle,
    fill_ghosts,
};
use crate::linalg::Sym3;
use crate::parallel::{BLOCK, own_rows};
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

    fn share(&self, row: usize) -> f64 {
        self.bonds.carried.get(row).map_or(1.0, |share| *share)
    }

    fn has_lost_its_fit(&self, row: usize) -> bool {
        self.bonds.inverse_moment[row] == Sym3::ZERO
            && self.bonds.row(row).any(|(j, _)| !self.sites[j].is_present())
    }

    fn local_motion(
        &self,
        row: usize,
        velocity: &[Velocity],
        mobility: Mobility,
        moving: bool,
    ) -> LocalMotion {
        let Self { bonds, sites, ghosts, .. } = self;
        let motion = BondedMotion { bonds, sites, ghosts, gradient: None };
        motion.local_motion(row, velocity, mobility, moving)
    }

    fn add_couples(&mut self, first: usize, nodes: &[u32], couples: &[DMat3]) {
        let Self { bonds, sites, ghosts, stresses, self_force, .. } = self;
        let motion = BondedMotion { bonds, sites, ghosts, gradient: None };
        motion.add_couples(first, nodes, couples, stresses, self_force);
    }

    fn keeps_reference(&self) -> bool {
        true
    }

    fn renew_ghosts(&mut self) {
        self.fill_ghost_stresses();
    }
}
