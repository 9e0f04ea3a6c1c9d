//! The support of a particle: a sphere, or an ellipsoid that stretches with the material.
//!
//! Where material is stretched along one direction and compressed along another, particles are far apart
//! along the one and close together along the other, and a sphere contains neighbours in few directions only.
//! An ellipsoid measures distances by a tensor G before they enter the kernel, `|r|^2 = r . G r`. A pair uses
//! the mean of the tensors of both particles, and the kernel is multiplied by the inverse volume ratio of its
//! ellipsoid: `w_ij = (det G)^(1/2) |W'(|r|)| / |r|`.

use glam::{DMat3, DVec3};

use crate::linalg::{Eigen, Sym3, extreme_eigenvalues};
use crate::symmetry::Ghosts;

/// Longest half axis of an ellipsoid, and shortest one's inverse.
const LONGEST: f64 = 20.0;
/// Share of a stretch that it follows in any case, beyond its root: a support of 2.4 spacings then reaches
/// over 1.6 of those that the stretch makes of them.
const MIN_SHARE: f64 = 2.0 / 3.0;
/// Trace of F F^T up to which no stretch is so large that more than its root counts.
const WIDE: f64 = 1.0 / (MIN_SHARE * MIN_SHARE * MIN_SHARE * MIN_SHARE);
/// Determinant of F F^T down to which, with such a trace, no stretch is below 1/20, far above the limit.
const FLAT: f64 = 0.02;

/// Safety margin of a bound of an eigenvalue against rounding.
const ROUNDING: f64 = 1e-6;
/// Minimum bound of the eigenvalues of G, over their mean, from which on it is taken for the smallest: that
/// is then no more than half as far from the mean.
const ROUND: f64 = 0.9;

/// The ellipsoid r . G r = 1 of a particle.
#[derive(Clone, Copy)]
pub(in crate::formulations) struct Ellipsoid {
    /// G.
    pub tensor: Sym3,
    /// G^-1.
    inverse: Sym3,
    /// A bound of the longest half axis: 3 % above it at most.
    pub longest: f64,
    /// (det G)^(1/2), one over its volume.
    pub density: f64,
}

impl Ellipsoid {
    /// The unit sphere.
    pub const SPHERE: Self =
        Self { tensor: Sym3::IDENTITY, inverse: Sym3::IDENTITY, longest: 1.0, density: 1.0 };

    /// G of the ellipsoid that follows a deformation F half way, in the logarithm of the stretches, between a
    /// sphere and what a sphere becomes: the inverse of the left stretch tensor, as long as no stretch is
    /// large.
    pub fn following(f: &DMat3) -> Sym3 {
        let squares = Sym3::gram(f.transpose());
        if squares.trace() <= WIDE && squares.determinant() >= FLAT {
            return squares.inverse_root();
        }
        let axis = |stretch: f64| stretch.sqrt().max(MIN_SHARE * stretch);
        Eigen::new(&squares).map(|square| axis(square.sqrt()).clamp(LONGEST.recip(), LONGEST).powi(-2))
    }

    /// The ellipsoid of G.
    pub fn new(tensor: Sym3) -> Self {
        let inverse = tensor.inverse();
        Self { tensor, inverse, longest: longest(&tensor, &inverse), density: tensor.determinant().sqrt() }
    }

    /// The matrix A of a quadratic form, seen in the coordinates in which the ellipsoid is the unit sphere.
    pub fn rounded(&self, a: &Sym3) -> Sym3 {
        let axes = Eigen::new(&self.tensor).map(|value| value.sqrt().recip()).to_matrix();
        Sym3::symmetric_part(axes * a.to_matrix() * axes)
    }

    /// Trace of [`Ellipsoid::rounded`].
    #[inline]
    pub fn rounded_trace(&self, a: &Sym3) -> f64 {
        self.inverse.double_dot(a)
    }

    /// Shortest half axis, to 1e-7.
    pub fn shortest(&self) -> f64 {
        extreme_eigenvalues(&self.tensor).largest.sqrt().recip()
    }

    /// A bound below the shortest half axis.
    pub fn axis_bound(&self) -> f64 {
        let deviator = self.tensor.deviator();
        let most = self.tensor.trace() / 3.0 + 2.0 * (deviator.double_dot(&deviator) / 6.0).sqrt();
        ((1.0 + ROUNDING) * most).sqrt().recip()
    }

    /// Trace of an inverse moment matrix as waves along an axis of that length feel it, which is the shortest
    /// one.
    pub fn trace(&self, inverse: &Sym3, axis: f64) -> f64 {
        self.rounded_trace(inverse) / (axis * axis)
    }
}

/// A bound of the longest half axis of the ellipsoid of G: that of the widest G with such a trace and such a
/// deviator, where this is nearly a sphere.
fn longest(tensor: &Sym3, inverse: &Sym3) -> f64 {
    let (mean, deviator) = (tensor.trace() / 3.0, tensor.deviator());
    let least = mean - 2.0 * (deviator.double_dot(&deviator) / 6.0).sqrt();
    let square = if least > ROUND * mean { 1.0 / least } else { extreme_eigenvalues(inverse).largest };
    square.sqrt()
}

/// The ellipsoids of the real rows of a phase.
#[derive(Clone, Copy)]
pub(in crate::formulations) struct Ellipsoids<'a>(pub &'a [Ellipsoid]);

impl Ellipsoids<'_> {
    /// Distance r_ij of row `j` from row `i` as both measure it, m.
    #[inline]
    pub fn distance(&self, ghosts: &Ghosts, i: usize, j: usize, r_ij: DVec3) -> f64 {
        let seen = ghosts.mirror(j).map_or(r_ij, |signs| signs * r_ij);
        let theirs = square(&self.0[ghosts.source(j)].tensor, seen);
        (0.5 * (square(&self.0[i].tensor, r_ij) + theirs)).sqrt()
    }
}

/// r . G r.
#[inline(always)]
fn square(g: &Sym3, r: DVec3) -> f64 {
    let own = g.xx * r.x * r.x + g.yy * r.y * r.y + g.zz * r.z * r.z;
    own + 2.0 * (g.xy * r.x * r.y + g.xz * r.x * r.z + g.yz * r.y * r.z)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_ellipsoid_is_between_the_sphere_and_what_a_deformation_makes_of_it() {
        let turn = DMat3::from_rotation_x(0.4) * DMat3::from_rotation_z(1.1);
        let f = turn * DMat3::from_diagonal(DVec3::new(1.44, 0.25, 9.0)) * DMat3::from_rotation_y(0.7);
        let own = Ellipsoid::new(Ellipsoid::following(&f));
        assert!((own.longest - 6.0).abs() < 1e-12 && (own.shortest() - 0.5).abs() < 1e-12);
        assert!((own.density * 1.2 * 0.5 * 6.0 - 1.0).abs() < 1e-12);
        assert!((own.rounded(&own.tensor) - Sym3::IDENTITY).norm() < 1e-12);
        let other = Sym3 { xx: 0.3, yy: 2.0, zz: 1.1, xy: 0.2, xz: -0.4, yz: 0.1 };
        let trace = own.rounded(&other).trace();
        assert!((own.rounded_trace(&other) - trace).abs() < 1e-12 * trace);
        let (ghosts, both) = (Ghosts::new(2), [own; 2]);
        for (axis, length) in [(DVec3::X, 1.2), (DVec3::Y, 0.5), (DVec3::Z, 6.0)] {
            let found = Ellipsoids(&both).distance(&ghosts, 0, 1, turn * axis * length);
            assert!((found - 1.0).abs() < 1e-12, "{found} along {axis}");
        }
        let round = [Ellipsoid::new(Ellipsoid::following(&turn)); 2];
        // On both sides of the strain from which on the stretches are computed one by one.
        for stretch in [1.99_f64, 2.01] {
            let f = turn * DMat3::from_diagonal(DVec3::new(stretch, 0.5, 0.9));
            let longest = Ellipsoid::new(Ellipsoid::following(&f)).longest;
            assert!((longest - stretch.sqrt()).abs() < 1e-12, "{longest}");
        }
        for stretch in [0.9, 0.96, 1.02, 1.05, 1.2] {
            let f = turn * DMat3::from_diagonal(DVec3::new(1.0, 1.0 / stretch, stretch));
            let found = Ellipsoid::new(Ellipsoid::following(&f)).longest;
            let longest = stretch.max(1.0 / stretch).sqrt();
            assert!(found > longest * (1.0 - 1e-12) && found < 1.03 * longest, "{found} for {longest}");
            let shortest = stretch.min(1.0 / stretch).sqrt();
            let least = Ellipsoid::new(Ellipsoid::following(&f)).axis_bound();
            assert!(least <= shortest && least > 0.9 * shortest, "{least} for {shortest}");
        }
        let r = DVec3::new(0.3, -1.0, 2.0);
        assert!((Ellipsoids(&round).distance(&ghosts, 0, 1, r) - r.length()).abs() < 1e-12);
    }
}
