//! The rigid and affine motion of a body as a whole, which the second pass leaves out of its sums.

use std::ops::Range;

use glam::{DMat3, DVec3};

use super::bonds::Bonds;
use super::rows::PackedParticle;
use crate::parallel::{FourLanes, HotLoop, Lanes4, run_hot};
use crate::solids::CorrectedStress;
use crate::symmetry::Ghosts;

/// An affine motion near that of the body, u = u_0 + H X: what its middle particle did in the last step.
///
/// The force between two particles does not change if k H is added to A and this motion is taken off u. What
/// is left of both is as small as the strains are, and so is what rounding makes of the sums: momentum stays
/// exact for a body that has gone far and turned.
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

    /// [`AffineFrame::rest`] in a hot loop, with the same bits: the record of a particle for its neighbours
    /// must cancel with its own terms.
    #[inline(always)]
    pub fn rest_in<A: FourLanes>(&self, a: A, site: &PackedParticle) -> Lanes4 {
        let [x, y, z] = self.columns();
        let [along_x, along_y, along_z, _] = site.reference.0;
        let of_two = a.add(a.scale(along_x, x), a.scale(along_y, y));
        let affine = a.add(of_two, a.scale(along_z, z));
        a.sub(a.sub(site.displacement, Lanes4::new(self.displacement, 0.0)), affine)
    }

    /// Takes the stress of a particle into the frame, and completes it by its affine traction.
    #[inline(always)]
    fn complete<A: FourLanes>(&self, a: A, stress: &mut CorrectedStress, site: &PackedParticle) {
        let stiffness = stress.stiffness();
        let columns = self.columns();
        let mut traction = Lanes4::ZERO;
        for axis in 0..3 {
            stress.columns[axis] = a.scale_add(stiffness, columns[axis], stress.columns[axis]);
            traction = a.scale_add(site.reference.0[axis], stress.columns[axis], traction);
        }
        traction = a.scale_add(stiffness, self.rest_in(a, site), traction);
        stress.traction = Lanes4([traction.0[0], traction.0[1], traction.0[2], site.reference.0[3]]);
    }

    /// The columns of H.
    #[inline(always)]
    fn columns(&self) -> [Lanes4; 3] {
        let DMat3 { x_axis, y_axis, z_axis } = self.gradient;
        [Lanes4::new(x_axis, 0.0), Lanes4::new(y_axis, 0.0), Lanes4::new(z_axis, 0.0)]
    }
}

/// Completes the stresses of a block, and makes the part of the force that knows no stress but a particle's
/// own.
pub(in crate::formulations) struct CompleteStress<'a> {
    pub frame: &'a AffineFrame,
    pub bonds: &'a Bonds,
    pub sites: &'a [PackedParticle],
    /// First row of the block in the phase.
    pub first: usize,
    /// `sum_j V_j w_ij u_ij`.
    pub stretch: &'a [DVec3],
    pub stresses: &'a mut [CorrectedStress],
    /// `A_i sum_j V_j w_ij X_ij + k_i sum_j V_j w_ij u_ij`.
    pub self_force: &'a mut [DVec3],
}

impl HotLoop for CompleteStress<'_> {
    type Output = ();

    #[inline(always)]
    fn run<A: FourLanes>(self, a: A) {
        let Self { frame, bonds, sites, first, stretch, stresses, self_force } = self;
        let columns = frame.columns();
        let sites = &sites[first..first + stresses.len()];
        let first_moments = &bonds.first_moment[first..first + stresses.len()];
        for k in 0..stresses.len() {
            let stress = &mut stresses[k];
            frame.complete(a, stress, &sites[k]);
            let moment = first_moments[k].to_array();
            let (mut rest, mut force) = (Lanes4::new(stretch[k], 0.0), Lanes4::ZERO);
            for axis in 0..3 {
                rest = a.scale_add(-moment[axis], columns[axis], rest);
                force = a.scale_add(moment[axis], stress.columns[axis], force);
            }
            self_force[k] = a.scale_add(stress.stiffness(), rest, force).xyz();
        }
    }
}

/// The stress of a ghost, to be completed.
struct CompleteGhost<'a> {
    frame: &'a AffineFrame,
    stress: &'a mut CorrectedStress,
    site: &'a PackedParticle,
}

impl HotLoop for CompleteGhost<'_> {
    type Output = ();

    #[inline(always)]
    fn run<A: FourLanes>(self, a: A) {
        self.frame.complete(a, self.stress, self.site);
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

/// Fills the stresses of the ghosts, which have their sites. `bond_force` is the force per volume squared and
/// weight that a row has beside its stress.
pub(in crate::formulations) fn fill_ghosts(
    ghosts: &Ghosts,
    frames: &[AffineFrame],
    sites: &[PackedParticle],
    stresses: &mut [CorrectedStress],
    bond_force: impl Fn(usize) -> DVec3 + Sync,
) {
    ghosts.fill(stresses, |ghost, own: &CorrectedStress| {
        // A of the source is in the frame already; that of the ghost needs its mirror image, and then the
        // frame.
        let frame = &frames[frame_of(frames, ghost.source)];
        let moved = [frame.gradient.x_axis, frame.gradient.y_axis, frame.gradient.z_axis];
        let mut plain = *own;
        for (column, moved) in plain.columns.iter_mut().zip(moved) {
            *column = Lanes4::new(column.xyz() - own.stiffness() * moved, column.0[3]);
        }
        let mut stress = plain.image(ghost.map);
        run_hot(CompleteGhost { frame, stress: &mut stress, site: &sites[ghost.row] });
        stress.add_traction(-bond_force(ghost.row));
        stress
    });
}
