//! How the shares of the carriers of a vertex decrease with their present distances.

/// How far from a vertex particles may be at the start to become its carriers, over the reach: three layers.
pub(super) const CANDIDATES: f64 = 1.6;

/// Minimum reach over the distance of the nearest carrier, so that a vertex always has one.
const MIN_REACH: f64 = 2.0;

/// The present reach of a vertex, m, and the sum of the weights of its carriers.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Scale {
    reach: f64,
    sum: f64,
}

impl Scale {
    /// From the present distances of the carriers, m, for a reach, m, of the undeformed body.
    pub fn of(distances: impl Iterator<Item = f64> + Clone, reach: f64) -> Self {
        let nearest = distances.clone().fold(f64::INFINITY, f64::min);
        let reach = reach.max(MIN_REACH * nearest);
        Self { reach, sum: distances.map(|distance| weight(distance / reach)).sum() }
    }

    /// The share of a carrier at a distance, m.
    pub fn share(&self, distance: f64) -> f64 {
        weight(distance / self.reach) / self.sum
    }

    /// Change of the share with the distance over the distance, 1/m2.
    pub fn slope(&self, distance: f64) -> f64 {
        let rest = (1.0 - distance / self.reach).max(0.0);
        -3.0 * rest * rest / (self.reach * self.sum * distance.max(f64::MIN_POSITIVE))
    }
}

fn weight(distance: f64) -> f64 {
    (1.0 - distance).max(0.0).powi(3)
}
