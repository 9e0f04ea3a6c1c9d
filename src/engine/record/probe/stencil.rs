//! Values at points of a body, from the particles near them in the reference configuration.

use glam::DVec3;

use super::shares::shares;
use crate::neighbors::{Cloud, NeighborList, NeighborSearch, Periodic};
use crate::plugin::BodyPlan;

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
        let particles: Vec<DVec3> = body.sites.iter().map(|site| site.position).collect();
        let reach = |search: i32| REACH * body.spacing * WIDER.powi(search);
        let mut list = NeighborList::default();
        let cloud = |positions| Cloud::uniform(positions, reach(SEARCHES - 1));
        let found = NeighborSearch::default().between(
            cloud(points),
            cloud(&particles),
            0.0,
            &Periodic::NONE,
            &mut list,
        );
        // A point that is too far away for the cells of a search is not of the body.
        if found.is_err() {
            return points.iter().map(|_| None).collect();
        }
        let of = |(row, point): (usize, &DVec3)| {
            let near = |reach: f64| {
                let of = |&particle: &u32| {
                    let site = &body.sites[particle as usize];
                    let offset = site.position - point;
                    let closeness = 1.0 - offset.length() / reach;
                    let weight = site.volume * closeness * closeness;
                    (closeness > 0.0).then_some(StencilParticle { particle, weight, offset })
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
        let particles = || self.0.iter().map(|near| near.particle);
        (particles().min().unwrap_or(0), particles().max().unwrap_or(0))
    }

    /// The [shares] of the particles in the value at the point. Particles that are not `there` have none.
    pub fn shares(&self, axes: usize, there: impl Fn(u32) -> bool) -> Vec<(u32, f64)> {
        let near: Vec<&StencilParticle> = self.0.iter().filter(|near| there(near.particle)).collect();
        let places: Vec<(f64, DVec3)> = near.iter().map(|near| (near.weight, near.offset)).collect();
        near.iter().map(|near| near.particle).zip(shares(&places, axes)).collect()
    }
}
