//! Values at points of a body, from the particles near them in the reference configuration.

use glam::DVec3;

use super::shares::shares;
use crate::neighbors::{Cloud, NeighborList, NeighborSearch, Periodic};
use crate::plugin::BodyPlan;
use crate::shapes::Aabb;
use crate::symmetry::Map;

/// Reach of a point over the spacing of its body.
const REACH: f64 = 2.0;
/// By how much the reach grows for points with too few particles near them.
const WIDER: f64 = 1.25;
/// Searches for particles near a point.
const SEARCHES: i32 = 3;
/// Distance from the nearest particle over the spacing, beyond which a point is not of the body.
const OUTSIDE: f64 = 1.5;

/// A particle near a point of a body.
#[derive(Clone, Copy, Debug)]
struct StencilParticle {
    /// Number of the particle in its body.
    particle: u32,
    /// Number of the map of which this is the image of the particle.
    map: u32,
    weight: f64,
    /// From the point to the particle in the reference configuration, m.
    offset: DVec3,
}

/// The particles near a point of a body.
#[derive(Clone, Debug)]
pub(super) struct Stencil(Vec<StencilParticle>);

impl Stencil {
    /// Those of points in the reference configuration; none for points that are not of the body.
    pub fn of_points(points: &[DVec3], body: &BodyPlan, axes: usize) -> Vec<Option<Self>> {
        Self::with_images(points, body, axes, &[Map::IDENTITY])
    }

    /// The same with the images of particles in these maps, by which the body goes on.
    pub fn with_images(points: &[DVec3], body: &BodyPlan, axes: usize, maps: &[Map]) -> Vec<Option<Self>> {
        let reach = |search: i32| REACH * body.spacing * WIDER.powi(search);
        let around = Aabb::around(points.iter().copied());
        let (low, high) = (around.min - reach(SEARCHES - 1), around.max + reach(SEARCHES - 1));
        let mut images: Vec<(DVec3, u32, u32)> = Vec::new();
        for (number, map) in (0..).zip(maps) {
            let all =
                (0..).zip(&body.sites).map(|(particle, site)| (map.place(site.position), particle, number));
            images.extend(all.filter(|(place, ..)| (place.cmpge(low) & place.cmple(high)).all()));
        }
        let places: Vec<DVec3> = images.iter().map(|image| image.0).collect();
        let mut list = NeighborList::default();
        let cloud = |positions| Cloud::uniform(positions, reach(SEARCHES - 1));
        let found =
            NeighborSearch::default().between(cloud(points), cloud(&places), 0.0, &Periodic::NONE, &mut list);
        // A point that is too far away for the cells of a search is not of the body.
        if found.is_err() {
            return points.iter().map(|_| None).collect();
        }
        let of = |(row, point): (usize, &DVec3)| {
            let near = |reach: f64| {
                let of = |&image: &u32| {
                    let (place, particle, map) = images[image as usize];
                    let offset = place - point;
                    let closeness = 1.0 - offset.length() / reach;
                    let weight = body.sites[particle as usize].volume * closeness * closeness;
                    (closeness > 0.0).then_some(StencilParticle { particle, map, weight, offset })
                };
                list.row(row).iter().filter_map(of).collect::<Vec<_>>()
            };
            let widths = (0..SEARCHES).map(|search| near(reach(search)));
            let near = widths.reduce(|near, wider| if near.len() > 2 * axes { near } else { wider })?;
            let nearest = near.iter().map(|near| near.offset.length()).fold(f64::INFINITY, f64::min);
            (nearest <= OUTSIDE * body.spacing).then_some(Self(near))
        };
        points.iter().enumerate().map(of).collect()
    }

    /// The first and the last particle, counted in the body.
    pub fn ends(&self) -> (u32, u32) {
        (self.particles().min().unwrap_or(0), self.particles().max().unwrap_or(0))
    }

    /// The particles, counted in the body.
    pub fn particles(&self) -> impl Iterator<Item = u32> {
        self.0.iter().map(|near| near.particle)
    }

    /// The same with the numbers of the maps of images.
    pub fn images(&self) -> impl Iterator<Item = (u32, u32)> {
        self.0.iter().map(|near| (near.particle, near.map))
    }

    /// The same particles, each of them moved by such a way, m; images go the image of it.
    pub fn moved(&self, way: impl Fn(u32) -> DVec3, maps: &[Map]) -> Self {
        let of = |near: &StencilParticle| {
            let way = maps[near.map as usize].vector(way(near.particle));
            StencilParticle { offset: near.offset + way, ..*near }
        };
        Self(self.0.iter().map(of).collect())
    }

    /// The [shares] of the particles in the value at the point. Particles that are not `there` have none.
    pub fn shares(&self, axes: usize, there: impl Fn(u32) -> bool) -> Vec<(u32, f64)> {
        self.shares_of_images(axes, there).into_iter().map(|(particle, _, share)| (particle, share)).collect()
    }

    /// The same with the numbers of the maps of images.
    pub fn shares_of_images(&self, axes: usize, there: impl Fn(u32) -> bool) -> Vec<(u32, u32, f64)> {
        let near: Vec<&StencilParticle> = self.0.iter().filter(|near| there(near.particle)).collect();
        let places: Vec<(f64, DVec3)> = near.iter().map(|near| (near.weight, near.offset)).collect();
        let shares = shares(&places, axes);
        near.iter().zip(shares).map(|(near, share)| (near.particle, near.map, share)).collect()
    }
}
