//! Distance of fluid particles from the shape of a body that has moved and bent.
//!
//! A particle is taken back to where it would be in the body as the scene has it, by the affine map that fits the particles of the body around it, which is exact for
//! rigid motions, and is compared with the shape there.

use glam::{DMat3, DVec3};

use super::cloud::{FlowCloud, Group};
use super::near::part;
use super::repulsion::Shares;
use crate::shapes::Region;
use crate::world::ReferencePosition;

/// The shape of a boundary.
pub(super) struct Shape {
    pub group: Group,
    pub region: Box<dyn Region>,
    /// Stiffness of its repulsion of each fluid, N/m.
    pub stiffness: Vec<f64>,
    /// Spacing of its particles, m.
    pub spacing: f64,
    /// Distance of the nearest of its particles beyond which a particle is not beside it, m.
    pub reach: f64,
}

/// A fluid particle in the body as the scene has it.
pub(super) struct Place {
    /// Where it is there, m.
    at: DVec3,
    /// Distance from the shape, negative inside of it, m.
    pub distance: f64,
    /// Gradient of the place in the body with respect to that in space.
    map: DMat3,
    /// Shares of the particles around it in what acts on it.
    pub shares: Shares,
}

impl Shape {
    /// How far the body has moved if all of its particles have moved alike, m.
    pub fn shift(&self, cloud: &FlowCloud, reference: &[ReferencePosition]) -> Option<DVec3> {
        let mut moved =
            self.group.cloud.clone().zip(reference).map(|(j, x)| cloud.records[j].position() - x.0);
        let first = moved.next()?;
        let margin = 1e-9 * self.spacing;
        moved.all(|next| (next - first).abs().max_element() <= margin).then_some(first)
    }

    /// Whether particle `i` is farther than `range`, m, from a body that has moved by `shift`, m.
    pub fn is_beyond(&self, range: f64, cloud: &FlowCloud, i: usize, shift: DVec3) -> bool {
        self.distance(cloud, cloud.records[i].position() - shift) >= range
    }

    /// Where particle `i` is, none if it is beside no particle of the body; `reference` are the places of its particles in the scene.
    pub fn place(&self, cloud: &FlowCloud, i: usize, reference: &[ReferencePosition]) -> Option<Place> {
        let row = part(cloud.near.row(i), &self.group.cloud);
        let from = cloud.records[i].position();
        let offset = |j: u32| cloud.offset(from, cloud.records[j as usize].position());
        let weight = |j: u32| cloud.records[j as usize].volume() * cloud.kernel.value(offset(j).length());
        let nearest = row
            .iter()
            .copied()
            .filter(|&j| weight(j) > 0.0)
            .min_by(|a, b| offset(*a).length_squared().total_cmp(&offset(*b).length_squared()))?;
        if offset(nearest).length() > self.reach {
            return None;
        }
        let origin = reference[nearest as usize - self.group.cloud.start].0;
        let home = |j: u32| cloud.offset(origin, reference[j as usize - self.group.cloud.start].0);
        let (mut total, mut mean, mut mean_home) = (0.0, DVec3::ZERO, DVec3::ZERO);
        for &j in row {
            let weight = weight(j);
            total += weight;
            mean += weight * offset(j);
            mean_home += weight * home(j);
        }
        (mean, mean_home) = (mean / total, mean_home / total);
        let (mut moment, mut moved) = (DMat3::ZERO, DMat3::ZERO);
        for &j in row {
            let (weight, x) = (weight(j) / total, offset(j) - mean);
            moment += weight * dyad(x, x);
            moved += weight * dyad(home(j) - mean_home, x);
        }
        if cloud.plane {
            moment.z_axis.z = 1.0;
            moved.z_axis.z = 1.0;
        }
        // Particles in one line or plane fit no map: theirs is that of the nearest one.
        let powers = if cloud.plane { 4 } else { 6 };
        let fits = moment.determinant() > 1e-6 * self.spacing.powi(powers);
        let inverse = if fits { moment.inverse() } else { DMat3::ZERO };
        let map = if fits { moved * inverse } else { DMat3::IDENTITY };
        let at = if fits { origin + mean_home - map * mean } else { origin - offset(nearest) };
        let shares = Shares { total, mean, slope: -(inverse * mean) };
        Some(Place { at, distance: self.distance(cloud, at), map, shares })
    }

    /// Distance from the shape or from its periodic image, m.
    fn distance(&self, cloud: &FlowCloud, at: DVec3) -> f64 {
        let distance = self.region.distance(at);
        if !cloud.periods.any() {
            return distance;
        }
        distance.min(self.region.distance(cloud.pairs.periodic().wrap(at)))
    }

    /// Gradient of the distance with respect to the place in space, by central differences.
    pub fn direction(&self, cloud: &FlowCloud, place: &Place) -> DVec3 {
        let step = 1e-4 * self.spacing;
        let axes = if cloud.plane { 2 } else { 3 };
        let mut gradient = DVec3::ZERO;
        for (axis, unit) in DVec3::AXES.into_iter().enumerate().take(axes) {
            let at = |side: f64| self.distance(cloud, place.at + side * step * unit);
            gradient[axis] = (at(1.0) - at(-1.0)) / (2.0 * step);
        }
        place.map.transpose() * gradient
    }
}

/// `a (x) b`.
fn dyad(a: DVec3, b: DVec3) -> DMat3 {
    DMat3::from_cols(a * b.x, a * b.y, a * b.z)
}
