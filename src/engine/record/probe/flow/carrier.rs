//! The motion of a wall or body that carries a gauge along.
//!
//! It is the affine map that fits the places of particles best, `x = x_0 + A (X - X_0)`: of those near the
//! gauge where it lies at the body, so that it follows a part that bends; else, such as for a gauge in the
//! middle of a tank, of all of them. Surfaces turn with the inverse transpose of A.

use glam::{DMat3, DVec3};

use crate::correction::MomentMatrix;
use crate::plugin::BodyPlan;
use crate::world::{BodyId, Column, MissingColumn, Position, Removed, World};

/// Reach of a gauge at a body, over the spacing of that.
const REACH: f64 = 3.0;
/// Distance from the nearest particle, over the spacing, beyond which a gauge does not lie at a body.
const APART: f64 = 1.5;

/// The particles that carry a gauge.
pub struct GaugeCarrier {
    body: BodyId,
    axes: usize,
    /// Numbers in the body, and places in the reference configuration from the gauge, m.
    particles: Vec<(u32, DVec3)>,
}

/// Where a gauge is now.
pub struct GaugeFrame {
    pub place: DVec3,
    /// A.
    gradient: DMat3,
}

impl GaugeCarrier {
    /// That of a gauge at a point; none if the particles of the body do not span the space.
    pub fn of(body: &BodyPlan, at: DVec3, axes: usize) -> Option<Self> {
        let offsets = body.sites.iter().map(|site| site.position - at);
        let all: Vec<(u32, DVec3)> = (0..).zip(offsets).collect();
        let within = |reach: f64| {
            let is_near = |particle: &&(u32, DVec3)| particle.1.length() < reach * body.spacing;
            all.iter().filter(is_near).copied().collect::<Vec<_>>()
        };
        let of = |particles: Vec<(u32, DVec3)>| {
            let carrier = Self { body: body.id, axes, particles };
            let there = carrier.particles.iter().map(|&(_, offset)| (offset, offset));
            affine(axes, there).is_some().then_some(carrier)
        };
        let near = if within(APART).is_empty() { None } else { of(within(REACH)) };
        near.or_else(|| of(all))
    }

    /// Names of the particle columns that it reads.
    pub const NEEDS: [&'static str; 2] = [Position::NAME, Removed::NAME];

    /// Where the gauge is now; none once too many particles have been removed.
    ///
    /// # Errors
    /// A column is missing.
    pub fn carried(&self, world: &World) -> Result<Option<GaugeFrame>, MissingColumn> {
        let (view, rows) = world.body_view(self.body);
        let (position, removed) = (view.read::<Position>()?, view.read::<Removed>()?);
        let (position, removed) = (&position[rows.clone()], &removed[rows]);
        let there = self.particles.iter().filter(|(k, _)| removed[*k as usize] == Removed::NO);
        Ok(affine(self.axes, there.map(|&(k, offset)| (offset, position[k as usize].0))))
    }
}

impl GaugeFrame {
    /// The unit vector along a direction of the reference configuration.
    pub fn along(&self, direction: DVec3) -> DVec3 {
        (self.gradient * direction).normalize_or(direction)
    }

    /// The unit normal of a surface that had this one.
    pub fn normal(&self, normal: DVec3) -> DVec3 {
        (self.gradient.inverse().transpose() * normal).normalize_or(normal)
    }

    /// The place of a point that lay at this offset from the gauge.
    pub fn point(&self, offset: DVec3) -> DVec3 {
        self.place + self.gradient * offset
    }
}

/// The map that fits pairs of offsets from the gauge in the reference configuration and places best.
fn affine(axes: usize, pairs: impl Iterator<Item = (DVec3, DVec3)> + Clone) -> Option<GaugeFrame> {
    let count = pairs.clone().count() as f64;
    let sum = pairs.clone().fold([DVec3::ZERO; 2], |sum, pair| [sum[0] + pair.0, sum[1] + pair.1]);
    let [reference, now] = [sum[0] / count, sum[1] / count];
    let mut moment = MomentMatrix::new(axes);
    pairs.clone().for_each(|(offset, _)| moment.add(1.0, offset - reference));
    let inverse = moment.inverse()?;
    let mut gradient = DMat3::ZERO;
    for (offset, place) in pairs {
        let (from, to) = (inverse * (offset - reference), place - now);
        gradient += DMat3::from_cols(to * from.x, to * from.y, to * from.z);
    }
    if axes == 2 {
        gradient.z_axis = DVec3::Z;
    }
    Some(GaugeFrame { place: now - gradient * reference, gradient })
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The corners of a rectangle that is turned by 30 degrees and moved, then also sheared along its lower
    /// side: normals of that side only turn, whatever the shear.
    #[test]
    fn normals_of_a_sheared_body_stay_at_right_angles_to_its_surface() {
        let (sine, cosine) = 30.0_f64.to_radians().sin_cos();
        let turn = |p: DVec3| DVec3::new(cosine * p.x - sine * p.y, sine * p.x + cosine * p.y, 0.0);
        let corners = [(0.1, 0.0), (0.7, 0.0), (0.7, 0.4), (0.1, 0.4)].map(|(x, y)| DVec3::new(x, y, 0.0));
        for shear in [0.0, 0.5] {
            let place = |p: DVec3| DVec3::new(2.0, -1.0, 0.0) + turn(DVec3::new(p.x + shear * p.y, p.y, 0.0));
            let found = affine(2, corners.iter().map(|&p| (p, place(p)))).unwrap();
            assert!((found.place - DVec3::new(2.0, -1.0, 0.0)).length() < 1e-14);
            assert!((found.normal(DVec3::Y) - turn(DVec3::Y)).length() < 1e-14);
            let up = turn(DVec3::new(shear, 1.0, 0.0)).normalize();
            assert!((found.along(DVec3::Y) - up).length() < 1e-14);
            assert!((found.point(DVec3::X) - place(DVec3::X)).length() < 1e-14);
        }
        assert!(affine(2, [(DVec3::X, DVec3::X), (DVec3::Y, DVec3::Y)].into_iter()).is_none());
    }
}
