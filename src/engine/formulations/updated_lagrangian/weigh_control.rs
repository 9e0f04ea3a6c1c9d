//! Which bodies need sums of their own for their stabilizers, and the bonds of these.

use glam::DVec3;

use super::phase::UpdatedRows;
use crate::formulations::bonded::{BodyKernel, PackedParticle};
use crate::neighbors::bounds;
use crate::solids::CorrectedStress;
use crate::world::World;

impl UpdatedRows {
    /// Decides which bodies need sums for their stabilizers, and builds their bonds without `failed`
    /// particles; the rows are ascending.
    pub fn weigh_control(&mut self, world: &World, original: &[DVec3], failed: &[u32]) {
        let Self { bonds, ghosts, gradient, kernels, control, volume, lists, follows, .. } = self;
        control.is_apart.clear();
        for (k, BodyKernel { body, .. }) in kernels.iter().enumerate() {
            let rows = world.body(*body).rows.clone();
            let has_failed = failed.iter().any(|&row| rows.contains(&(row as usize)));
            // Those that carry no stress for want of neighbours may still be held together.
            let is_released = |row: &usize| volume[*row] > 0.0 && bonds.row(*row).next().is_some();
            let free = bonds.free.iter().map(|&row| row as usize);
            let has_released = free.filter(|row| rows.contains(row)).any(|row| is_released(&row));
            control.is_apart.push(control.is_stabilized[k] && (follows[k] || has_failed || has_released));
        }
        if !control.has_sums() {
            return;
        }
        control.origin = bounds(original).middle();
        control.volume.clone_from(volume);
        failed.iter().for_each(|&row| control.volume[row as usize] = 0.0);
        control.bonds.share_topology(bonds);
        lists.begin_control(original, &control.volume, gradient, ghosts);
        let apart = kernels.iter().zip(&control.is_apart).filter(|(_, is_apart)| **is_apart);
        for (BodyKernel { body, kernel, .. }, _) in apart {
            lists.weigh_control(&world.body(*body).rows, kernel, &mut control.bonds);
        }
        let (real, all) = (volume.len(), volume.len() + ghosts.len());
        control.sites.resize(all, PackedParticle::default());
        control.stresses.resize(all, CorrectedStress::default());
        control.self_force.resize(real, DVec3::ZERO);
    }
}
