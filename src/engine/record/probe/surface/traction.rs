//! The traction on a surface, from the forces on the particles that carry it.

use glam::DVec3;

/// A particle at a surface.
#[derive(Clone, Copy)]
pub(super) struct LoadedParticle {
    /// What it carries of the surface now, outwards, m2 (m in two dimensions).
    pub surface: DVec3,
    /// Force from outside, N.
    pub force: DVec3,
}

/// The traction that fits the forces on particles best, `f_i = (-p A_i / |A_i| + t) |A_i|`: first its
/// pressure p, which follows a curved surface, then the rest t, which has one direction.
pub(super) struct SurfaceTraction {
    /// Pa.
    pressure: f64,
    /// Pa.
    along: DVec3,
}

impl SurfaceTraction {
    /// That on these particles.
    pub fn of(particles: &[LoadedParticle]) -> Self {
        let squares: f64 = particles.iter().map(|of| of.surface.length_squared()).sum();
        if squares == 0.0 {
            return Self { pressure: 0.0, along: DVec3::ZERO };
        }
        let pressure = -particles.iter().map(|of| of.force.dot(of.surface)).sum::<f64>() / squares;
        let left = |of: &LoadedParticle| (of.force + pressure * of.surface) * of.surface.length();
        Self { pressure, along: particles.iter().map(left).sum::<DVec3>() / squares }
    }

    /// The traction at a place with that outward normal, Pa.
    pub fn on(&self, normal: DVec3) -> DVec3 {
        self.along - self.pressure * normal
    }

    /// What it leaves of the force on a particle, N.
    pub fn left(&self, of: &LoadedParticle) -> DVec3 {
        of.force + self.pressure * of.surface - self.along * of.surface.length()
    }
}
