//! The spin of fluid particles: their local rotation, which must not cause friction.
//!
//! The rotation that fits the motion around a particle best, with the weights of friction, is
//!
//! `J_i w_i = sum_j c_ij x_ij x v_ij`, `J_i = sum_j c_ij (r_ij^2 I - x_ij (x) x_ij)`, `c_ij = mu_ij V_j w_ij`
//!
//! over fluids and the walls to which they stick. The friction of a pair is `4 c_ij (v_ij - omega_ij x x_ij)`
//! with the mean omega_ij of
//!
//! `J_i (omega_i - w_i) = 1/2 sum_j c_ij (r_ij^2 I - x_ij (x) x_ij) (w_i - w_j)` over fluids.
//!
//! Between fluids it is the derivative by the velocities of the power `2 sum_ij V_i c_ij |v_ij - (w_i +
//! w_j)/2 x x_ij|^2` of all pairs: it is dissipative for all velocities, and conserves momentum and angular
//! momentum to round-off, at free surfaces as well. Inside it is div(2 mu D) = mu (lap v + grad div v), and
//! at a free surface 2 mu D n is zero by nature. The second term sharpens what the fit has smoothed: without
//! it waves of number k decay by (k h)^2 / 7 too fast, with it the error on a lattice is of fourth order.
//! With omega_i = 0 and half of the factor it is the friction of Morris, Fox, Zhu (J. Comput. Phys. 136
//! (1997) 214-226), whose stress mu grad v is not zero in a rigid rotation.

use std::ops::Range;

use glam::DVec3;

use crate::correction::{SINGULAR, add_moment, moment_of};
use crate::formulations::fluid::cloud::{FlowCloud, NearPairs, RowPass, RowSums};
use crate::formulations::fluid::lanes::{Axial, pack_axial, unpack_axial};
use crate::linalg::Sym3;
use crate::parallel::{Arithmetic, Lanes4, Vector};
use crate::schedule::{Run, Step, StepError};

/// Finds the spins of all fluid particles.
#[derive(Default)]
pub struct Spin {
    fits: Vec<SpinFit>,
    sums: RowSums,
}

impl Run for Spin {
    fn run(&mut self, step: &mut Step<'_>) -> Result<(), StepError> {
        let mut cloud = step.resources.get_mut::<FlowCloud>();
        let mut spins = std::mem::take(&mut cloud.spins);
        self.fits.resize(cloud.fluid, SpinFit::default());
        let fluids = || cloud.groups.iter().filter(|group| group.fluid().is_some());
        for group in fluids() {
            let (rows, viscosities) = (group.cloud.clone(), cloud.viscosities.of(group));
            let pass = BestFit { cloud: &cloud, viscosities };
            cloud.for_each_row(rows.start, &mut self.fits[rows], &mut self.sums, &pass);
        }
        for group in fluids() {
            let (rows, viscosities) = (group.cloud.clone(), cloud.viscosities.of(group));
            let pass = Sharpened { cloud: &cloud, viscosities, fits: &self.fits };
            cloud.for_each_row(rows.start, &mut spins[rows], &mut self.sums, &pass);
        }
        cloud.spins = spins;
        Ok(())
    }
}

/// The best fit around a particle.
#[derive(Clone, Copy, Debug, Default)]
struct SpinFit {
    /// w_i, 1/s.
    spin: Lanes4,
    /// `sum_j c_ij x_ij (x) x_ij`, Pa s.
    moment: Sym3,
}

struct BestFit<'a> {
    cloud: &'a FlowCloud,
    /// Viscosities between the fluid and all groups, Pa s.
    viscosities: &'a [f64],
}

impl RowPass<1, 4> for BestFit<'_> {
    type Output = SpinFit;

    fn among(&self) -> Range<usize> {
        self.cloud.everything()
    }

    #[inline(always)]
    fn reads(&self, row: usize) -> [DVec3; 1] {
        [self.cloud.records[row].velocity()]
    }

    #[inline(always)]
    fn add<A: Arithmetic>(
        &self,
        near: &NearPairs<A>,
        [own]: &[Vector<A>; 1],
        [other]: &[Vector<A>; 1],
        [xx, yy, zz, angular]: &mut [Vector<A>; 4],
    ) {
        let weight = near.volume * near.weight * self.viscosities[near.group];
        add_moment([xx, yy, zz], weight, near.x_ij);
        *angular = Axial::product(near.x_ij, *other - *own).mul_add(weight, Axial::of(*angular)).into_row();
    }

    #[inline(always)]
    fn output(&self, _: usize, &[xx, yy, zz, angular]: &[DVec3; 4]) -> SpinFit {
        let plane = self.cloud.plane;
        let moment = *moment_of([xx, yy, zz], plane).matrix();
        SpinFit { spin: Lanes4::new(rotation(&moment, unpack_axial(angular, plane), plane), 0.0), moment }
    }
}

struct Sharpened<'a> {
    cloud: &'a FlowCloud,
    viscosities: &'a [f64],
    fits: &'a [SpinFit],
}

impl RowPass<1, 1> for Sharpened<'_> {
    type Output = Lanes4;

    fn among(&self) -> Range<usize> {
        0..self.cloud.fluid
    }

    #[inline(always)]
    fn reads(&self, row: usize) -> [DVec3; 1] {
        [pack_axial(self.fits[row].spin.xyz(), self.cloud.plane)]
    }

    #[inline(always)]
    fn add<A: Arithmetic>(
        &self,
        near: &NearPairs<A>,
        [own]: &[Vector<A>; 1],
        [other]: &[Vector<A>; 1],
        [torque]: &mut [Vector<A>; 1],
    ) {
        let weight = near.volume * near.weight * (0.5 * self.viscosities[near.group]);
        let apart = Axial::of(*own) - Axial::of(*other);
        *torque = apart.around(near.x_ij).mul_add(weight, Axial::of(*torque)).into_row();
    }

    #[inline(always)]
    fn output(&self, i: usize, &[torque]: &[DVec3; 1]) -> Lanes4 {
        let (SpinFit { spin, moment }, plane) = (&self.fits[i], self.cloud.plane);
        Lanes4::new(spin.xyz() + rotation(moment, unpack_axial(torque, plane), plane), 0.0)
    }
}

/// The rotation omega with `(tr M - M) omega = L`, for the moment matrix `M = sum m x (x) x` and `L = sum m x
/// x v` of some particles: that of their best rigid motion. Around the line on which all of them lie there is
/// none.
#[inline(always)]
pub fn rotation(moment: &Sym3, angular: DVec3, plane: bool) -> DVec3 {
    let trace = moment.trace();
    if trace <= 0.0 {
        return DVec3::ZERO;
    }
    if plane {
        return DVec3::new(0.0, 0.0, angular.z / trace);
    }
    let inertia = Sym3::from_diagonal(DVec3::splat(trace)) - *moment;
    if inertia.determinant() > SINGULAR * trace.powi(3) {
        inertia.inverse() * angular
    } else {
        angular / trace
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_rotation_of_points_that_rotate_is_theirs() {
        let omega = DVec3::new(0.3, -1.2, 0.7);
        let fit = |points: &[DVec3], plane| {
            let (mut moment, mut angular) = (Sym3::ZERO, DVec3::ZERO);
            for (k, &x) in points.iter().enumerate() {
                let mass = 1.0 + 0.3 * k as f64;
                moment += Sym3::dyad(x) * mass;
                angular += mass * x.cross(omega.cross(x));
            }
            rotation(&moment, angular, plane)
        };
        let cloud = [DVec3::new(1.0, 0.2, 0.0), DVec3::new(-0.3, 0.8, 0.5), DVec3::new(0.1, -0.4, 0.9)];
        assert!(fit(&cloud, false).distance(omega) < 1e-13);
        // On a line: only what is across it shows.
        let axis = DVec3::new(1.0, 2.0, -1.0).normalize();
        let across = omega - axis * omega.dot(axis);
        assert!(fit(&[axis, -0.7 * axis], false).distance(across) < 1e-13);
        assert_eq!(fit(&[], false), DVec3::ZERO);
        let turned = |x: DVec3| DVec3::new(-x.y, x.x, 0.0) * 2.0;
        let points = [DVec3::new(0.4, -0.1, 0.0), DVec3::new(0.2, 0.9, 0.0)];
        let moment = points.iter().fold(Sym3::ZERO, |sum, &x| sum + Sym3::dyad(x));
        let angular = points.iter().map(|&x| x.cross(turned(x))).sum();
        assert!((rotation(&moment, angular, true).z - 2.0).abs() < 1e-14);
    }
}
