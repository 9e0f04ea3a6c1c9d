//! The shapes of particles in contact: ellipsoids, into which the deformation gradients map spheres of half a
//! spacing.
//!
//! Overlaps are measured in the reference configuration, d = r (1 - s), where s is the distance of the other
//! side over its distance at first contact. Contact is thus at the surface of the body however flat its
//! particles are, a rotating particle keeps its shape, and the spring of a particle stiffens as it gets
//! thinner, as its bonds do. The potential depends on deformation gradients: its force acts at the point of
//! contact `x_i + F_i A_i` and not at the particle (see [`LocalMotion`](crate::solids::LocalMotion)).

use glam::{DMat3, DVec3};

use crate::world::DeformationGradient;

/// The shape of a particle.
#[derive(Clone, Copy, Debug)]
pub(in crate::contact) struct ParticleShape {
    /// Radius in the reference configuration, m.
    pub radius: f64,
    /// Deformation gradient; without one it stays a sphere.
    pub gradient: Option<DMat3>,
}

/// Distance and normal of two sides near each other.
#[derive(Clone, Copy, Debug, Default)]
pub(in crate::contact) struct Proximity {
    /// Overlap d, m; negative where there is none.
    pub overlap: f64,
    /// Unit vector from the second side to the first.
    pub normal: DVec3,
    /// d(overlap)/d(normal approach).
    pub scale: f64,
    /// From the particles to the point of contact, in the reference configuration, m: A_i.
    pub arms: [DVec3; 2],
}

/// The ellipsoids of two particles; `x_ij` leads from the first to the second. The sum of both is taken for
/// the ellipsoid of `Q = (r_i + r_j) (r_i F_i F_i^T + r_j F_j F_j^T)`, which is exact where both have one
/// deformation gradient, and s^2 = x . Q^-1 x. The point of contact is the same seen from both: F_i A_i - F_j
/// A_j = Q Q^-1 x = x.
pub(in crate::contact) fn of_pair(x_ij: DVec3, first: ParticleShape, second: ParticleShape) -> Proximity {
    let reach = first.radius + second.radius;
    let square =
        |of: ParticleShape| of.gradient.map_or(DMat3::IDENTITY, |f| f * f.transpose()) * (reach * of.radius);
    let y = (square(first) + square(second)).inverse() * x_ij;
    let (s, length) = (x_ij.dot(y).sqrt(), y.length());
    let arm =
        |of: ParticleShape| of.gradient.map_or(DVec3::ZERO, |f| f.transpose() * y * (reach * of.radius));
    Proximity {
        overlap: reach * (1.0 - s),
        normal: -y / length,
        scale: reach * length / s,
        arms: [arm(first), -arm(second)],
    }
}

/// The ellipsoid of a particle and a surface at a signed distance along its outward normal: s = distance /
/// (r |F^T n|). The point of contact is on the surface.
pub(in crate::contact) fn on_surface(distance: f64, normal: DVec3, shape: ParticleShape) -> Proximity {
    let ParticleShape { radius, gradient: f } = shape;
    let along = f.map_or(normal, |f| f.transpose() * normal);
    let stretch = along.length();
    let arm = if f.is_some() { -along * (distance / (stretch * stretch)) } else { DVec3::ZERO };
    Proximity { overlap: radius - distance / stretch, normal, scale: 1.0 / stretch, arms: [arm, DVec3::ZERO] }
}

/// A bound of the squared stretches of a particle: the largest sum over a row of F F^T, exact without shear.
pub(in crate::contact) fn squared_stretch(gradient: &DeformationGradient) -> f64 {
    let f = gradient.0.transpose();
    let (xy, xz, yz) = (f.x_axis.dot(f.y_axis), f.x_axis.dot(f.z_axis), f.y_axis.dot(f.z_axis));
    let diagonal =
        DVec3::new(f.x_axis.length_squared(), f.y_axis.length_squared(), f.z_axis.length_squared());
    let (xy, xz, yz) = (xy.abs(), xz.abs(), yz.abs());
    (diagonal + DVec3::new(xy + xz, xy + yz, xz + yz)).max_element()
}
