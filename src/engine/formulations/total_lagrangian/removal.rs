//! Removed particles are left out of the bonds: the remaining neighbours are fitted again, and the energy of
//! the cut bonds is booked.

use glam::DMat3;

use super::phase::PackedRows;
use super::removed::RemovedRows;
use super::system::Deformation;
use crate::formulations::bonded::{Bonds, InternalForce, PackedParticle};
use crate::linalg::{Sym3, dyad};
use crate::removal::REMOVED_ENERGY;
use crate::schedule::{AccountKind, Step, StepError};
use crate::solids::{AppliedLosses, Loss, SolidPart, change_of_fit, count_rows};
use crate::world::{
    DeformationGradient, Force, Mass, MissingColumn, ReferencePosition, ReferenceVolume, Removed,
    SupportRadius, World,
};

impl Deformation {
    /// Restores the losses that the sums had left out at a checkpoint.
    pub(super) fn update_restored(
        &mut self,
        world: &World,
        packed: &mut PackedRows,
    ) -> Result<(), StepError> {
        if !std::mem::take(&mut self.is_restored) {
            return Ok(());
        }
        {
            let applied = world.phase(self.phase).read::<AppliedLosses>()?;
            self.removed.rows = AppliedLosses::rows(&applied, Loss::Removed);
            self.failed = AppliedLosses::rows(&applied, Loss::Failed);
        }
        if !self.removed.rows.is_empty() {
            self.cut(world, packed)?;
        }
        Ok(())
    }

    /// Takes up what has been removed since the last step; returns whether the pass has been run with it.
    ///
    /// The passes run twice from the same places, with the bonds that are gone and without them: what these
    /// held leaves the energy balance. The second kick of the step uses the new forces, the motion up to here
    /// has used the old ones: what that takes from the motion leaves the balance with it.
    pub(super) fn update_removed(
        &mut self,
        step: &mut Step<'_>,
        packed: &mut PackedRows,
    ) -> Result<bool, StepError> {
        let view = step.world.phase(self.phase);
        let removed = view.read_near::<Removed>()?;
        if count_rows(&removed, |row| *row != Removed::NO) == self.removed.rows.len() {
            return Ok(false);
        }
        // What follows looks at all rows.
        packed.has_places = false;
        self.pass(step.world, packed, SolidPart::of(step))?;
        self.solids.book(step)?;
        let held = self.solids.stored();
        let before = self.forces(step, packed)?;
        let known = std::mem::take(&mut self.removed.rows);
        self.removed.rows.extend((0..removed.len() as u32).filter(|&k| removed[k as usize] != Removed::NO));
        self.cut(step.world, packed)?;
        self.refit(step.world, packed, &known)?;
        packed.has_places = false;
        // States of laws have advanced by this step already.
        self.pass(step.world, packed, SolidPart::REPEATED)?;
        self.solids.book_repeated(step)?;
        let after = self.forces(step, packed)?;
        let account = step.ledger.account(REMOVED_ENERGY, AccountKind::Dissipated);
        self.solids.book_change(step, account, &held, &before, &after)?;
        Ok(true)
    }

    /// Takes in how the fits have changed beside rows that were not `known` to be removed. Rows of which no
    /// fit is left carry no stress from now on.
    fn refit(&mut self, world: &World, packed: &mut PackedRows, known: &[u32]) -> Result<(), MissingColumn> {
        let view = world.phase(self.phase);
        let gradient = view.read::<DeformationGradient>()?;
        let mut is_new = vec![false; view.len()];
        for &row in self.removed.rows.iter().filter(|row| known.binary_search(row).is_err()) {
            is_new[row as usize] = true;
            packed.sites[row as usize].reference.0[3] = 0.0;
        }
        packed.fill_ghost_sites();
        let PackedRows { bonds, ghosts, sites, .. } = packed;
        let RemovedRows { refits, released, .. } = &mut self.removed;
        for law in self.solids.iter() {
            for row in world.body(law.id).rows.clone() {
                let bonds_of = bonds.offsets[row] as usize..bonds.offsets[row + 1] as usize;
                let is_cut = bonds.neighbors[bonds_of].iter().any(|&j| is_new[ghosts.source(j as usize)]);
                if !is_cut || !sites[row].is_present() || bonds.inverse_moment[row] == Sym3::ZERO {
                    continue;
                }
                match change_of_fit(&gradient[row].0, &fit_of(row, bonds, sites)) {
                    Some(change) if law.law.remembers_path() => refits.take_in(row as u32, &change),
                    Some(_) => {}
                    None => {
                        released.push(row as u32);
                        bonds.release(row);
                    }
                }
            }
        }
        released.sort_unstable();
        Ok(())
    }

    /// The internal forces of the last pass.
    fn forces(&self, step: &Step<'_>, packed: &PackedRows) -> Result<Vec<Force>, MissingColumn> {
        let view = step.world.phase(self.phase);
        let mut force = vec![Force::default(); view.len()];
        let mass = view.read::<Mass>()?;
        let pass = InternalForce::of(packed, &mass, glam::DVec3::ZERO, self.plane);
        pass.write_own(&mut force);
        packed.hessian.add_vidal_force(&packed.bonds, &packed.sites, &mut force);
        pass.share(&mut force);
        Ok(force)
    }

    /// Takes the removed particles out of the moment matrices of their neighbours, and off the edges of
    /// cracks.
    fn cut(&mut self, world: &World, packed: &mut PackedRows) -> Result<(), MissingColumn> {
        let view = world.phase(self.phase);
        let reference = view.read_near::<ReferencePosition>()?;
        let volume = view.read_near::<ReferenceVolume>()?;
        let mut volume: Vec<f64> = volume.iter().map(|volume| volume.0).collect();
        self.removed.rows.iter().for_each(|&row| volume[row as usize] = 0.0);
        let dimension = world.dimension().count();
        let support = view.read_near::<SupportRadius>()?;
        let PackedRows { bonds, ghosts, cracks, stable_step, hessian, .. } = packed;
        hessian.is_stale = true;
        if !self.failed.is_empty() {
            self.failed.retain(|row| self.removed.rows.binary_search(row).is_err());
            cracks.rebuild(&self.failed, view.len(), bonds, ghosts);
        }
        let mut applied = view.write::<AppliedLosses>()?;
        AppliedLosses::write(&mut applied, Loss::Removed, &self.removed.rows);
        AppliedLosses::write(&mut applied, Loss::Failed, &self.failed);
        for (law, stable_step) in self.solids.iter().zip(stable_step) {
            let rows = world.body(law.id).rows.clone();
            bonds.correct(rows.clone(), dimension, bytemuck::cast_slice(&reference), &volume, ghosts);
            let released = self.removed.released.iter().map(|&row| row as usize);
            released.filter(|row| rows.contains(row)).for_each(|row| bonds.release(row));
            *stable_step =
                bonds.stable_step(rows, dimension, &law.estimate, bytemuck::cast_slice(&support), None);
        }
        Ok(())
    }
}

/// The fit F of one row.
fn fit_of(row: usize, bonds: &Bonds, sites: &[PackedParticle]) -> DMat3 {
    let site = &sites[row];
    let (x, u) = (site.reference.xyz(), site.displacement.xyz());
    let mut spread = DMat3::ZERO;
    let range = bonds.offsets[row] as usize..bonds.offsets[row + 1] as usize;
    for (&j, &weight) in bonds.neighbors[range.clone()].iter().zip(&bonds.weights[range]) {
        let other = &sites[j as usize];
        let arm = (other.reference.xyz() - x) * (f64::from(weight) * other.reference.0[3]);
        let change = other.displacement.xyz() - u;
        spread += dyad(change, arm);
    }
    DMat3::IDENTITY + spread * bonds.inverse_moment[row].to_matrix()
}
