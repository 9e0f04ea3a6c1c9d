//! The packed rows of the phase, and its interface to the rest of the engine.

use glam::{DMat3, DVec3};

use super::control::Control;
use super::lists::ReferenceLists;
use crate::formulations::bonded::{
    AffineFrame, BodyKernel, BondedMotion, BondedRows, Bonds, Cracks, Ellipsoid, HeldParticles, HessianRows,
    PackedParticle, bodies_of, fill_ghosts, frame_of,
};
use crate::notation::quantity;
use crate::parallel::share_rows_of;
use crate::schedule::Step;
use crate::solids::{CorrectedStress, LocalMotion, SolidPhase};
use crate::symmetry::{Ghosts, Repeat};
use crate::world::{Force, Mobility, Velocity};

/// Shared data of the systems of the formulation.
pub(super) struct UpdatedRows {
    /// Neighbours, weights and moments of the reference.
    pub bonds: Bonds,
    /// Particles held behind an edge, which do not interact.
    pub held: HeldParticles,
    pub ghosts: Ghosts,
    /// Of every body, in the order of rows.
    pub repeats: Vec<Vec<Repeat>>,
    /// Where the positions of sites are measured from, m.
    pub origin: DVec3,
    /// Position in the reference with the volume V there, and displacement since.
    pub sites: Vec<PackedParticle>,
    /// Original position with the volume V, and displacement since the start: what pair terms see where a
    /// reference has been updated.
    pub pair_sites: Vec<PackedParticle>,
    /// Whether there are pair terms.
    pub has_pair_terms: bool,
    /// F_r of the real rows.
    pub gradient: Vec<DMat3>,
    /// Supports of the real rows.
    pub ellipsoids: Vec<Ellipsoid>,
    /// Volume V_0 det F_r of the real rows, m3; zero for removed ones.
    pub volume: Vec<f64>,
    /// Corrected stress A.
    pub stresses: Vec<CorrectedStress>,
    /// The part of the force on each particle that comes from its own corrected stress, over its volume.
    pub self_force: Vec<DVec3>,
    pub frames: Vec<AffineFrame>,
    /// The stabilizers of bodies whose reference has been updated.
    pub control: Control,
    /// None: particles that have failed leave the sums of the control.
    pub cracks: Cracks,
    pub hessian: HessianRows,
    pub kernels: Vec<BodyKernel>,
    /// Stable step of each body in the reference, s.
    pub stable_step: Vec<f64>,
    /// Of every body: whether the reference is another one than at the start.
    pub follows: Vec<bool>,
    /// Of every body: how many particles carry no stress for want of neighbours, from the start on.
    pub released_at_start: Vec<usize>,
    /// Kept for the next update.
    pub lists: ReferenceLists,
    /// Internal forces that the second kick of a step with an update uses, N, where no couple is added to the
    /// stresses.
    pub force: Vec<Force>,
    /// Whether they are those of the step.
    pub has_force: bool,
}

impl UpdatedRows {
    /// Whether a body has another reference than at the start.
    pub fn has_followed(&self) -> bool {
        self.follows.contains(&true) || self.control.has_sums()
    }

    /// Whether the sites of pair terms are needed beside those of the stabilizers.
    pub fn needs_pair_sites(&self) -> bool {
        self.has_pair_terms || !self.control.has_sums()
    }

    /// Original places and displacements since the start of every row; the volumes are those of the reference
    /// or of the stabilizers, and zero of what has been removed.
    pub fn original_sites(&self) -> &[PackedParticle] {
        if self.needs_pair_sites() { self.pair_sites() } else { &self.control.sites }
    }

    /// Says that body `k`, which gets another reference than at the start, is drawn unevenly from now on.
    pub fn warn_of_side(&self, k: usize, step: &mut Step<'_>) {
        let Some(text) = self.held.warning_of_update(self.kernels[k].body) else { return };
        if !step.warnings.iter().any(|told| told.starts_with(text)) {
            step.warnings.push(format!("{text} {}", quantity(step.clock.time, "s")));
        }
    }

    /// Gives all ranks the stresses that each has computed for its own rows.
    pub fn share_stresses(&mut self) {
        let Self { frames, stresses, control, .. } = self;
        share_rows_of(stresses, bodies_of(frames));
        if control.has_sums() {
            share_rows_of(&mut control.stresses, bodies_of(frames));
        }
    }

    /// Fills the stresses of the ghosts, which have their sites.
    pub fn fill_ghost_stresses(&mut self) {
        let Self { ghosts, frames, sites, stresses, control, hessian, .. } = self;
        let bond_force = |row: usize| hessian.bond_force_of(row);
        fill_ghosts(ghosts, frames, sites, stresses, |row| {
            let is_apart = control.is_apart[frame_of(frames, ghosts.source(row))];
            if is_apart { DVec3::ZERO } else { bond_force(row) }
        });
        control.fill_ghost_stresses(ghosts, bond_force);
    }
}

impl BondedRows for UpdatedRows {
    fn bonds(&self) -> &Bonds {
        &self.bonds
    }

    fn pair_sites(&self) -> &[PackedParticle] {
        if self.has_followed() { &self.pair_sites } else { &self.sites }
    }

    fn kernels(&self) -> &[BodyKernel] {
        &self.kernels
    }
}

impl SolidPhase for UpdatedRows {
    fn ghosts(&self) -> &Ghosts {
        &self.ghosts
    }

    fn neighbors(&self, row: usize, f: &mut dyn FnMut(usize, f64)) {
        self.bonds.for_each_present(&self.sites, row, f);
    }

    fn share(&self, row: usize) -> f64 {
        self.bonds.carried.get(row).map_or(1.0, |share| *share)
    }

    fn local_motion(
        &self,
        row: usize,
        velocity: &[Velocity],
        mobility: Mobility,
        moving: bool,
    ) -> LocalMotion {
        let Self { bonds, sites, ghosts, gradient, .. } = self;
        let motion = BondedMotion { bonds, sites, ghosts, gradient: Some(gradient) };
        motion.local_motion(row, velocity, mobility, moving)
    }

    fn add_couples(&mut self, first: usize, nodes: &[u32], couples: &[DMat3]) {
        self.has_force = false;
        let Self { bonds, sites, ghosts, gradient, stresses, self_force, .. } = self;
        let motion = BondedMotion { bonds, sites, ghosts, gradient: Some(gradient) };
        motion.add_couples(first, nodes, couples, stresses, self_force);
    }

    fn renew_ghosts(&mut self) {
        self.fill_ghost_stresses();
    }
}
