//! A set of particles as the input of the search.

use super::NeighborError;
use glam::DVec3;
use rayon::prelude::*;

/// Support radii of a set of particles.
#[derive(Debug, Clone, Copy)]
pub enum SupportRadii<'a> {
    /// One support radius (m) for all particles, the faster case.
    Uniform(f64),
    /// One support radius (m) per particle. Cells are as large as the largest, so the cost grows with the
    /// cube of the ratio of largest to usual support.
    PerParticle(&'a [f64]),
}

/// Positions (m) and support radii of a set of particles, in row order.
#[derive(Debug, Clone, Copy)]
pub struct Cloud<'a> {
    /// Positions (m).
    pub positions: &'a [DVec3],
    /// Support radii (m).
    pub support: SupportRadii<'a>,
}

impl<'a> Cloud<'a> {
    /// Particles with one common support radius (m).
    pub const fn uniform(positions: &'a [DVec3], support_radius: f64) -> Self {
        Self { positions, support: SupportRadii::Uniform(support_radius) }
    }

    /// Particles with individual support radii (m).
    pub const fn per_particle(positions: &'a [DVec3], support_radii: &'a [f64]) -> Self {
        Self { positions, support: SupportRadii::PerParticle(support_radii) }
    }

    /// The first `count` particles.
    pub(super) fn first(&self, count: usize) -> Self {
        let support = match self.support {
            SupportRadii::PerParticle(radii) => {
                SupportRadii::PerParticle(radii.get(..count).unwrap_or(radii))
            }
            uniform @ SupportRadii::Uniform(_) => uniform,
        };
        Self { positions: &self.positions[..count], support }
    }

    #[inline]
    pub(super) fn support_of(&self, index: usize) -> f64 {
        match self.support {
            SupportRadii::Uniform(radius) => radius,
            SupportRadii::PerParticle(radii) => radii[index],
        }
    }

    /// Largest support radius, zero for an empty set.
    pub(super) fn largest_support(&self) -> f64 {
        match self.support {
            SupportRadii::Uniform(radius) => radius,
            SupportRadii::PerParticle(radii) => radii.par_iter().copied().reduce(|| 0.0, f64::max),
        }
    }

    /// Bounding box of the positions; an inverted box for an empty set.
    pub(super) fn bounds(&self) -> PointBounds {
        bounds(self.positions)
    }

    pub(super) fn check(&self, set: &'static str) -> Result<(), NeighborError> {
        let count = self.positions.len();
        if count >= u32::MAX as usize {
            return Err(NeighborError::TooMany(count));
        }
        if let Some(index) = self.positions.par_iter().with_min_len(4096).position_first(|x| !x.is_finite()) {
            return Err(NeighborError::Position { set, index, position: self.positions[index] });
        }
        let bad = |radius: &f64| !(*radius > 0.0 && radius.is_finite());
        let wrong = match self.support {
            SupportRadii::Uniform(radius) => bad(&radius).then_some((0, radius)),
            SupportRadii::PerParticle(radii) if radii.len() != count => {
                return Err(NeighborError::Length { set, positions: count, supports: radii.len() });
            }
            SupportRadii::PerParticle(radii) => radii.iter().position(bad).map(|index| (index, radii[index])),
        };
        wrong.map_or(Ok(()), |(index, value)| Err(NeighborError::SupportRadius { set, index, value }))
    }
}

/// A bounding box.
#[derive(Clone, Copy, Debug, Default)]
pub struct PointBounds {
    /// Minimum coordinates, m.
    pub low: DVec3,
    /// Maximum coordinates, m.
    pub high: DVec3,
}

impl PointBounds {
    /// Its centre, m.
    pub fn middle(&self) -> DVec3 {
        0.5 * (self.low + self.high)
    }
}

/// Bounding box of positions, m; an inverted box where there are none.
pub fn bounds(positions: &[DVec3]) -> PointBounds {
    let empty = || (DVec3::INFINITY, DVec3::NEG_INFINITY);
    let (low, high) = positions
        .par_iter()
        .with_min_len(4096)
        .fold(empty, |(lo, hi), x| (lo.min(*x), hi.max(*x)))
        .reduce(empty, |a, b| (a.0.min(b.0), a.1.max(b.1)));
    PointBounds { low, high }
}
