//! The particles beside the held sides of a body.

use glam::DVec3;

use super::body::HeldBody;
use super::labels::{length_label, mix};
use crate::plugin::HeldSide;
use crate::symmetry::Repeat;

/// How far from a side shares are found, over the support radius: what its cut kernels change decays over
/// half a spacing beyond two support radii.
const DEPTH: f64 = 2.1;
/// How far behind these a share acts, over the support radius: as far as kernels reach.
const ACTS: f64 = 1.0;
/// How far b of a particle depends on others, over the support radius: on its neighbours, and on the
/// neighbours of these.
const SEEN: f64 = 2.01;
/// How far a side goes on beyond the particles on it, over the spacing.
const BESIDE: f64 = 0.6;
/// Of the unit normals of two sides, the product from which on they are one direction.
const SAME: f64 = 0.99;

/// Particles whose stress is to be in equilibrium, and those that affect it.
pub(super) struct Zone {
    /// Particles of which something is asked, by their numbers in the body, ascending.
    pub asked: Vec<u32>,
    /// Places in `asked`, ascending, with the direction along which a stress is to balance.
    pub equations: Vec<(u32, DVec3)>,
    /// Places in `asked` of the particles whose shares may change, ascending, with their distances from the
    /// nearest side, m.
    pub unknown: Vec<(u32, f64)>,
    /// Particles on which b depends, by their numbers in the body, ascending.
    pub seen: Vec<u32>,
    /// Label of each of `asked` apart from its neighbours: its distances from the sides, and its condition.
    pub labels: Vec<u64>,
    /// Place in `asked` of every particle of the body, if it is there.
    at: Vec<Option<u32>>,
}

impl Zone {
    /// The zone of a body of which some particles carry less than all of their stress at the start.
    pub fn of(body: &HeldBody<'_>, start: &[f64]) -> Self {
        let plan = body.plan;
        let sides: Vec<SideBox<'_>> = plan.sides.iter().filter_map(|side| SideBox::of(body, side)).collect();
        let mut zone = Self {
            asked: Vec::new(),
            equations: Vec::new(),
            unknown: Vec::new(),
            seen: Vec::new(),
            labels: Vec::new(),
            at: vec![None; plan.sites.len()],
        };
        if sides.is_empty() {
            return zone;
        }
        let is_hidden = |k: u32| plan.hidden.binary_search(&k).is_ok();
        for (k, site) in (0..).zip(&plan.sites) {
            if !sides.iter().any(|side| side.sees(site.position)) || is_hidden(k) {
                continue;
            }
            zone.seen.push(k);
            if sides.iter().any(|side| side.acts_on(site.position)) {
                zone.at[k as usize] = Some(zone.asked.len() as u32);
                let own = mix(site.volume.to_bits()) ^ start[k as usize].to_bits();
                let label = zone.add(k, site.position, own, &sides, plan.spacing);
                zone.asked.push(k);
                zone.labels.push(label);
            }
        }
        zone
    }

    /// Depth from a side, m, up to which the balance of the particles beside it depends on others: no farther
    /// than the next side or symmetry plane along its normal.
    pub fn depth_beside(&self, body: &HeldBody<'_>, side: &HeldSide) -> f64 {
        let (axis, at) = side.plane;
        let mirrors = body.repeats.iter().filter_map(|repeat| match repeat {
            Repeat::Mirror { axis, at } => Some((*axis, *at)),
            Repeat::Period { .. } => None,
        });
        let others = body.plan.sides.iter().map(|other| other.plane).chain(mirrors);
        let others = others.filter(|other| other.0 == axis);
        let distances = others.map(|other| (other.1 - at).abs()).filter(|distance| *distance > 0.0);
        distances.fold((DEPTH + ACTS + SEEN) * body.support, f64::min)
    }

    /// Place in `asked` of a particle of the body, if something is asked of it.
    pub fn place_of(&self, number: u32) -> Option<u32> {
        self.at[number as usize]
    }

    /// Adds what is asked of a particle that one of the sides sees; returns its label.
    fn add(&mut self, k: u32, x: DVec3, own: u64, sides: &[SideBox<'_>], spacing: f64) -> u64 {
        let at = self.asked.len() as u32;
        let mut label = own;
        let mut tell = |what: u64| label = label.wrapping_add(mix(what));
        for side in sides.iter().filter(|side| side.sees(x)) {
            let (axis, plane) = side.side.plane;
            tell(length_label((x[axis] - plane).abs(), spacing));
        }
        let near = sides.iter().filter(|side| side.is_near(x)).map(|side| side.distance(x));
        if let Some(depth) = near.min_by(f64::total_cmp) {
            self.unknown.push((at, depth));
            tell(!length_label(depth, spacing));
        }
        let first = self.equations.len();
        for normal in sides.iter().filter(|side| side.acts_on(x)).map(|side| side.side.normal) {
            let is_held = sides.iter().any(|side| side.holds(k, normal));
            let is_known = self.equations[first..].iter().any(|own| own.1.dot(normal).abs() > SAME);
            if !is_held && !is_known {
                self.equations.push((at, normal));
            }
            tell(1 + u64::from(is_held));
        }
        label
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
