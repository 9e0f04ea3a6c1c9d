//! The rigid and affine motion of a body as a whole, which the second pass leaves out of its sums.

use std::ops::Range;

use glam::{DMat3, DVec3};

use super::rows::PackedParticle;
use crate::parallel::Lanes4;
use crate::solids::CorrectedStress;
use crate::symmetry::Ghosts;

/// An affine motion near that of the body, u = u_0 + H X: what its middle particle did in the last step.
///
/// The force between two particles does not change if k H is added to A and this motion is taken off u. What is left
/// of both is as small as the strains are, and so is what rounding makes of the sums: momentum stays exact for a
/// body that has gone far and turned.
#[derive(Clone, Copy, Debug)]
pub(in crate::formulations) struct AffineFrame {
    /// First row behind the body.
    pub end: usize,
    /// H.
    pub gradient: DMat3,
    /// u_0, m.
    pub displacement: DVec3,
}

impl AffineFrame {
    /// No motion, for the body that ends before row `end`.
    pub fn at_rest(end: usize) -> Self {
        Self { end, gradient: DMat3::ZERO, displacement: DVec3::ZERO }
    }

    /// The motion of a particle and its neighbourhood, for the body that ends before row `end`.
    pub fn of(end: usize, deformation: &DMat3, site: &PackedParticle) -> Self {
        let gradient = *deformation - DMat3::IDENTITY;
        let displacement = site.displacement.xyz() - gradient * site.reference.xyz();
        Self { end, gradient, displacement }
    }

    /// The displacement of a particle without this motion, m.
    #[inline(always)]
    pub fn rest(&self, site: &PackedParticle) -> DVec3 {
        site.displacement.xyz() - self.displacement - self.gradient * site.reference.xyz()
    }
}

impl AffineFrame {
    /// Takes the stress of a particle into the frame, and completes it by its affine traction.
    #[inline(always)]
    pub fn complete(&self, stress: &mut CorrectedStress, site: &PackedParticle) {
        let stiffness = stress.stiffness();
        let Self { gradient, .. } = self;
        for (column, add) in
            stress.columns.iter_mut().zip([gradient.x_axis, gradient.y_axis, gradient.z_axis])
        {
            column.0[0] += stiffness * add.x;
            column.0[1] += stiffness * add.y;
            column.0[2] += stiffness * add.z;
        }
        stress.traction =
            Lanes4::new(stress.times(site.reference.xyz(), self.rest(site)), site.reference.0[3]);
    }
}

/// Rows of the bodies that have these frames.
pub(in crate::formulations) fn bodies_of(
    frames: &[AffineFrame],
) -> impl Iterator<Item = Range<usize>> + Clone {
    let starts = std::iter::once(0).chain(frames.iter().map(|frame| frame.end));
    starts.zip(frames).map(|(start, frame)| start..frame.end)
}

/// Index of the frame of a row.
pub(in crate::formulations) fn frame_of(frames: &[AffineFrame], row: usize) -> usize {
    frames.partition_point(|frame| frame.end <= row)
}

/// Fills the stresses of the ghosts, which have their sites. `pull` is the force per volume squared and weight that a row has beside its stress.
pub(in crate::formulations) fn fill_ghosts(
    ghosts: &Ghosts,
    frames: &[AffineFrame],
    sites: &[PackedParticle],
    stresses: &mut [CorrectedStress],
    pull: impl Fn(usize) -> DVec3 + Sync,
) {
    ghosts.fill(stresses, |ghost, own: &CorrectedStress| {
        // A of the source is in the frame already; that of the ghost needs its mirror image, and then the frame.
        let frame = &frames[frame_of(frames, ghost.source)];
        let moved = [frame.gradient.x_axis, frame.gradient.y_axis, frame.gradient.z_axis];
        let mut plain = *own;
        for (column, moved) in plain.columns.iter_mut().zip(moved) {
            *column = Lanes4::new(column.xyz() - own.stiffness() * moved, column.0[3]);
        }
        let mut stress = plain.image(ghost.map);
        frame.complete(&mut stress, &sites[ghost.row]);
        stress.add_traction(-pull(ghost.row));
        stress
    });
}
