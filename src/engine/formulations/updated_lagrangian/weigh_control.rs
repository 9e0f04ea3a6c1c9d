//! Which bodies need sums of their own for their stabilizers, and the bonds of these.

use glam::DVec3;

use super::phase::UpdatedRows;
use crate::formulations::bonded::{BodyKernel, PackedParticle};
use crate::neighbors::bounds;
use crate::solids::{CorrectedStress, fill_rows};
use crate::world::World;

impl UpdatedRows {
    /// Decides which bodies need sums for their stabilizers, and builds their bonds without `failed`
    /// particles, from places, m, and volumes, m3, of the start; the rows are ascending.
    pub fn weigh_control(&mut self, world: &World, original: &[DVec3], start: &[f64], failed: &[u32]) {
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
        if control.sites.is_empty() {
            control.origin = bounds(original).middle();
        }
        let measure = UndilatedMeasure { volume, start, axes: world.dimension().count() };
        control.volume.resize(volume.len(), 0.0);
        fill_rows(&mut control.volume, 0, |row| measure.volume(row));
        failed.iter().for_each(|&row| control.volume[row as usize] = 0.0);
        control.bonds.share_topology(bonds);
        let scale = |row| measure.scale(row);
        lists.begin_control(original, &control.volume, gradient, scale, ghosts);
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

/// Volumes and lengths that leave the stiffness of the stabilizers of a bond as it is while the material only
/// dilates. With J = V / V_0 on d axes, axes of ellipsoids are longer by the factor `J^(1/2d)` (see
/// `Ellipsoid::following`), so that `V_i V_j w_ij` at the moved pair vector would change with J.
#[derive(Clone, Copy)]
struct UndilatedMeasure<'a> {
    /// V, m3; zero of what has been removed.
    volume: &'a [f64],
    /// V_0, m3.
    start: &'a [f64],
    /// d.
    axes: usize,
}

impl UndilatedMeasure<'_> {
    fn dilatation(&self, row: usize) -> f64 {
        self.volume[row] / self.start[row]
    }

    /// Factor of pair vectors: they grow as the axes do, and the distance stays.
    fn scale(&self, row: usize) -> f64 {
        let dilatation = self.dilatation(row);
        let root = if dilatation > 0.0 { dilatation.sqrt() } else { 1.0 };
        (if self.axes == 3 { root.cbrt() } else { root.sqrt() }).recip()
    }

    /// Volume, m3: the factor `J^(-1/2)` of the kernel of a bond is taken back half by either end.
    fn volume(&self, row: usize) -> f64 {
        let dilatation = self.dilatation(row);
        if dilatation > 0.0 { self.start[row] * dilatation.sqrt().sqrt() } else { 0.0 }
    }
}
