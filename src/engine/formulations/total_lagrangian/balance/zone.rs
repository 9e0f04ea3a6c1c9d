//! The particles beside the held sides of a body.

use glam::DVec3;

use super::body::HeldBody;
use crate::plugin::HeldSide;
use crate::symmetry::Repeat;

/// How far from a side shares are found, over the support radius: what its cut kernels change decays over half a spacing beyond two support radii.
const DEPTH: f64 = 2.1;
/// How far behind these a share acts, over the support radius: as far as kernels reach.
const ACTS: f64 = 1.0;
/// How far b of a particle depends on others, over the support radius: on its neighbours, and on the neighbours of these.
const SEEN: f64 = 2.01;
/// How far a side goes on beyond the particles on it, over the spacing.
const BESIDE: f64 = 0.6;
/// Of the unit normals of two sides, the product from which on they are one direction.
const SAME: f64 = 0.99;

/// Where stresses are to balance, and what that depends on; particles by their numbers in the body.
pub(super) struct Zone {
    /// Particles, ascending, with the direction along which a stress is to balance.
    pub equations: Vec<(u32, DVec3)>,
    /// Particles whose shares may change, ascending, with their distances from the nearest side, m.
    pub unknown: Vec<(u32, f64)>,
    /// Particles on which b depends, ascending.
    pub seen: Vec<u32>,
    /// Where all particles have been in the lattice, m.
    pub place_before: Vec<DVec3>,
    /// What the lattice goes on by: the mirror images behind the sides, too.
    pub repeats: Vec<Repeat>,
}

impl Zone {
    pub fn of(body: &HeldBody<'_>) -> Self {
        let plan = body.plan;
        let mut place_before: Vec<DVec3> = plan.sites.iter().map(|site| site.position).collect();
        for &(k, way) in plan.sides.iter().flat_map(|side| &side.moved) {
            place_before[k as usize] -= way;
        }
        let sides: Vec<SideBox<'_>> = plan.sides.iter().filter_map(|side| SideBox::of(body, side)).collect();
        let mut repeats = body.repeats.to_vec();
        for (axis, at) in sides.iter().map(|own| own.side.plane) {
            // Two conditions may hold one side.
            let is_known = |repeat: &Repeat| matches!(repeat, Repeat::Mirror { axis: a, at: b } if *a == axis && *b == at);
            if !repeats.iter().any(is_known) {
                repeats.push(Repeat::Mirror { axis, at });
            }
        }
        let (equations, unknown, seen) = Default::default();
        let mut zone = Self { equations, unknown, seen, place_before, repeats };
        let is_seen = |k: u32| plan.hidden.binary_search(&k).is_err();
        for (k, site) in (0..).zip(&plan.sites).filter(|(k, _)| is_seen(*k)) {
            zone.add(k, site.position, &sides);
        }
        zone
    }

    /// Adds a particle that is near one of the sides.
    fn add(&mut self, k: u32, x: DVec3, sides: &[SideBox<'_>]) {
        if !sides.iter().any(|side| side.sees(x)) {
            return;
        }
        self.seen.push(k);
        let near = sides.iter().filter(|side| side.is_near(x)).map(|side| side.distance(x));
        if let Some(depth) = near.min_by(f64::total_cmp) {
            self.unknown.push((k, depth));
        }
        let first = self.equations.len();
        for normal in sides.iter().filter(|side| side.acts_on(x)).map(|side| side.side.normal) {
            let is_held = sides.iter().any(|side| side.holds(k, normal));
            let is_known = self.equations[first..].iter().any(|own| own.1.dot(normal).abs() > SAME);
            if !is_held && !is_known {
                self.equations.push((k, normal));
            }
        }
    }
}

/// A held side with the box around its particles, and around those beside it.
struct SideBox<'a> {
    side: &'a HeldSide,
    low: DVec3,
    high: DVec3,
    /// How much wider the box of the particles is whose shares may change, m.
    near: DVec3,
    /// The same of those that these act on, and of all on which the balance of these depends.
    acts: DVec3,
    seen: DVec3,
}

impl<'a> SideBox<'a> {
    fn of(body: &HeldBody<'_>, side: &'a HeldSide) -> Option<Self> {
        let place = |(k, _): &(u32, DVec3)| body.plan.sites[*k as usize].position;
        let first = place(side.moved.first()?);
        let low = side.moved.iter().map(place).fold(first, DVec3::min);
        let high = side.moved.iter().map(place).fold(first, DVec3::max);
        let wider = |depth: f64| {
            let is_along = side.normal.abs().cmpgt(DVec3::splat(1.0 - SAME));
            DVec3::select(
                is_along,
                DVec3::splat(depth * body.support),
                DVec3::splat(BESIDE * body.plan.spacing),
            )
        };
        let (near, acts) = (wider(DEPTH), wider(DEPTH + ACTS));
        Some(Self { side, low, high, near, acts, seen: acts + SEEN * body.support })
    }

    fn is_near(&self, x: DVec3) -> bool {
        x.cmpge(self.low - self.near).all() && x.cmple(self.high + self.near).all()
    }

    /// Distance from the box around its particles, m.
    fn distance(&self, x: DVec3) -> f64 {
        x.distance(x.clamp(self.low, self.high))
    }

    fn acts_on(&self, x: DVec3) -> bool {
        x.cmpge(self.low - self.acts).all() && x.cmple(self.high + self.acts).all()
    }

    fn sees(&self, x: DVec3) -> bool {
        x.cmpge(self.low - self.seen).all() && x.cmple(self.high + self.seen).all()
    }

    /// Whether it holds a particle along a direction.
    fn holds(&self, k: u32, along: DVec3) -> bool {
        self.side.normal.dot(along).abs() > 0.5
            && self.side.moved.binary_search_by_key(&k, |own| own.0).is_ok()
    }
}
