//! The box of a relaxation zone, and its strength from place to place.

use glam::DVec3;

use crate::neighbors::Periodic;
use crate::notation::place;
use crate::plugin::SetupError;

/// A box in which a zone grows stronger along a direction.
#[derive(Clone, Debug)]
pub(super) struct ZoneBox {
    low: DVec3,
    high: DVec3,
    /// Number of axes of the scene.
    dimensions: usize,
    /// Direction of length one.
    pub along: DVec3,
    /// Coordinate along it at which the zone begins, m.
    start: f64,
    /// Length of the zone, m.
    pub length: f64,
    periodic: Periodic,
}

/// Distance over a period by which a box may miss the end of the domain, for rounding.
const NEAR: f64 = 1e-9;

impl ZoneBox {
    /// The box between two corners, m, which grows stronger in the direction of `along`, of any length.
    ///
    /// # Errors
    /// The box has no content or reaches past the ends of the period, or the direction is zero.
    pub fn new(
        [low, high]: [DVec3; 2],
        along: DVec3,
        dimensions: usize,
        periodic: Periodic,
    ) -> Result<Self, SetupError> {
        let is_open = |axis: usize| low[axis] < high[axis];
        if !(0..dimensions).all(is_open) {
            let message =
                format!("`max` must exceed `min` on every axis, found {} and {}", place(high), place(low));
            return Err(SetupError::parameter("max", message, "they are opposite corners of a box"));
        }
        let in_scene =
            DVec3::from_array([0, 1, 2].map(|axis| if axis < dimensions { along[axis] } else { 0.0 }));
        let Some(along) = in_scene.try_normalize() else {
            let help = "give the direction of the flow, such as `(1, 0)`";
            return Err(SetupError::parameter("along", "`along` must not be zero", help));
        };
        for axis in (0..dimensions).filter(|&axis| periodic.axes()[axis] && along[axis] != 0.0) {
            let (min, length) = (periodic.min()[axis], periodic.lengths()[axis]);
            let (before, after) = (low[axis] < min - NEAR * length, high[axis] > min + (1.0 + NEAR) * length);
            if before || after {
                let message = "the box must not reach past the ends of the periodic domain";
                let help = "move the ends of the domain to those of the zone: it begins at an outlet and ends at an inlet";
                return Err(SetupError::parameter(if before { "min" } else { "max" }, message, help));
            }
        }
        // The corners of the box that are first and last in this direction.
        let ends = (0..dimensions).map(|axis| (along[axis] * low[axis], along[axis] * high[axis]));
        let (start, end) = ends.fold((0.0, 0.0), |(start, end), (a, b)| (start + a.min(b), end + a.max(b)));
        Ok(Self { low, high, dimensions, along, start, length: end - start, periodic })
    }

    /// The image of a position in the domain, m.
    pub fn image(&self, position: DVec3) -> DVec3 {
        self.periodic.wrap(position)
    }

    /// Whether the direction has a part along this axis, which is periodic.
    pub fn repeats(&self, axis: usize) -> bool {
        self.periodic.axes()[axis] && self.along[axis] != 0.0
    }

    /// Period along the direction, m; zero without one.
    pub fn period(&self) -> f64 {
        self.periodic.lengths().dot(self.along.abs())
    }

    /// Place along the zone: 0 where it begins, 1 at its end.
    pub fn depth(&self, position: DVec3) -> f64 {
        (self.image(position).dot(self.along) - self.start) / self.length
    }

    /// Whether a position is in the box.
    pub fn contains(&self, position: DVec3) -> bool {
        let place = self.image(position);
        (0..self.dimensions).all(|axis| (self.low[axis]..=self.high[axis]).contains(&place[axis]))
    }

    /// Rate at a position over that at the end of the zone: 0 outside of the box, 1 at most.
    pub fn strength(&self, position: DVec3) -> f64 {
        if self.contains(position) { self.depth(position).clamp(0.0, 1.0).powi(2) } else { 0.0 }
    }

    /// The box in words.
    pub fn words(&self) -> String {
        format!("from {} to {}", place(self.low), place(self.high))
    }
}
