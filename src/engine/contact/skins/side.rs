//! The points of one skin on the facets of another in a step: which of them touch, and their forces.

use glam::{DMat3, DVec3};

use super::close_facets::CloseFacets;
use super::facet_places::FacetPlaces;
use super::foot::{Foot, NearFacets, slopes};
use crate::contact::active::MinimumLength;
use crate::contact::laws::Touch;
use crate::contact::response::{ContactEnergy, ContactState, History, Interaction, Losses, spin_of};
use crate::neighbors::Periodic;
use crate::skins::{Patch, QuadratureRule, Vertex};

/// How deep a point may be below the surface of the other body, over the mean spacing.
const DEPTH: f64 = 0.5;

/// A point that touches.
#[derive(Clone, Copy, Default)]
pub(in crate::contact) struct PointTouch {
    /// Its foot on the other skin.
    pub(super) foot: Foot,
    /// Share of the integral.
    weight: f64,
}

/// Force of a point.
#[derive(Clone, Copy, Default)]
pub(in crate::contact) struct PointPush {
    /// Force on the point, N, and how much of it is across the normal.
    pub force: DVec3,
    pub across: DVec3,
    /// From the foot to the point in the reference configuration of the other body, m.
    pub arm: DVec3,
    /// Energy of the law over the weight, J, where the weight changes as the foot moves.
    pub energy: f64,
    /// Stiffness over the area, N/m3 (N/m2 in two dimensions).
    pub stiffness: f64,
    /// Heat of friction, J.
    pub heat: f64,
}

/// A point of a facet.
#[derive(Clone, Copy)]
pub(super) struct FacetPoint {
    pub facet: u32,
    /// Shares of the vertices of the facet.
    pub shares: [f64; 3],
}

impl FacetPoint {
    /// The point of that number among those of all facets.
    #[inline]
    pub fn of(rule: &QuadratureRule, number: u32) -> Self {
        let count = rule.len();
        Self { facet: number / count as u32, shares: rule.shares(number as usize % count) }
    }
}

/// Motion of a point relative to the material of the other body.
struct PointMotion {
    /// Velocity, along the normal that at the foot and across it that at the point, m/s.
    velocity: DVec3,
    /// Angular velocity of that material about the normal, 1/s.
    spin: f64,
    /// From the foot to the point in the reference configuration of the other body, m.
    arm: DVec3,
    /// Inverse mass of both sides under a traction, m2/kg.
    mobility: DVec3,
}

/// The points of one skin on another in a step.
pub(super) struct SkinSide<'a> {
    pub interaction: &'a Interaction,
    pub own: &'a Patch,
    pub other: &'a Patch,
    /// Where the facets of both are.
    pub places: [&'a FacetPlaces; 2],
    pub rule: &'a QuadratureRule,
    /// Of the domain, if it has periodic sides.
    pub periodic: Option<Periodic>,
    /// Length for which the law holds, m.
    pub length: f64,
    /// Length of the step, s.
    pub dt: f64,
}

impl SkinSide<'_> {
    /// The point of that number.
    #[inline]
    pub fn point(&self, number: u32) -> FacetPoint {
        FacetPoint::of(self.rule, number)
    }

    /// The force of a point that touches, with its history.
    #[inline(always)]
    pub fn respond(
        &self,
        point: u32,
        touch: &PointTouch,
        before: &History,
        energies: &mut ContactEnergy,
    ) -> (History, PointPush) {
        let Self { interaction, own, length, dt, .. } = *self;
        let PointTouch { foot, weight } = *touch;
        if interaction.is_elastic() {
            return self.spring(point, touch, before, energies);
        }
        let PointMotion { velocity, spin, arm, mobility } = self.motion(point, touch);
        let mut losses = Losses::default();
        if !before.is_elastic() {
            losses.add_work(1.0, before, velocity, dt);
        }
        let (area, usual) = (self.area(point), length.powi(own.skin.facets.axes as i32 - 1));
        let state = ContactState {
            touch: Touch { overlap: -foot.distance, radius: 0.5 * length, length, depth: length },
            normal: foot.normal,
            scale: 1.0,
            area: weight * area / usual,
            arms: [foot.x - self.place(&foot), DVec3::ZERO],
            velocity,
            lag: DVec3::ZERO,
            spin,
            acceleration: DVec3::ZERO,
        };
        let inverse_mass = |n: DVec3| mobility.dot(n * n) / (weight * area);
        let response = interaction.respond(&state, inverse_mass, dt, before);
        losses.add_work(1.0, &response.history, velocity, dt);
        losses.keep(1.0, before, &response.history);
        energies.losses.add(&losses);
        energies.stored += response.spring.energy + response.history.energy();
        energies.ahead += 0.5 * dt * response.force.dot(velocity);
        // Without friction nothing acts across the normal but round-off, which would make couples.
        let across = if interaction.friction == 0.0 {
            DVec3::ZERO
        } else {
            response.force - response.force.dot(foot.normal) * foot.normal
        };
        let stiffness = response.spring.stiffness / area;
        let energy = response.spring.energy / weight;
        let heat = losses.friction;
        (response.history, PointPush { force: response.force, across, arm, energy, stiffness, heat })
    }

    /// The same where nothing but the overlap counts.
    #[inline(always)]
    fn spring(
        &self,
        point: u32,
        PointTouch { foot, weight }: &PointTouch,
        before: &History,
        energies: &mut ContactEnergy,
    ) -> (History, PointPush) {
        let Self { length, dt, .. } = *self;
        let velocity = self.velocity(point) - self.velocity_at(foot);
        let (area, usual) = (self.area(point), length.powi(self.own.skin.facets.axes as i32 - 1));
        let touch = Touch { overlap: -foot.distance, radius: 0.5 * length, length, depth: length };
        let way = -velocity.dot(foot.normal) * dt;
        let (spring, history) = self.interaction.elastic(&touch, weight * area / usual, way, before);
        let force = spring.force * foot.normal;
        energies.stored += spring.energy;
        energies.ahead += 0.5 * dt * force.dot(velocity);
        let (energy, stiffness) = (spring.energy / weight, spring.stiffness / area);
        (history, PointPush { force, energy, stiffness, ..PointPush::default() })
    }

    /// Takes in the energy of a contact that has ended; `facets` are those of the other skin near the point.
    pub fn end(&self, point: u32, facets: &[u32], history: &History, energies: &mut ContactEnergy) {
        if !history.is_elastic() {
            let nearest = self.nearest(point, facets, &mut CloseFacets::default());
            let velocity = nearest.map_or(DVec3::ZERO, |touch| self.motion(point, &touch).velocity);
            energies.losses.add_work(1.0, history, velocity, self.dt);
        }
        energies.losses.keep(1.0, history, &History::default());
    }

    /// The length (area) of a point in the reference configuration, m (m2).
    fn area(&self, point: u32) -> f64 {
        self.own.skin.measure[self.point(point).facet as usize] / self.rule.len() as f64
    }

    /// Where a foot is, m.
    fn place(&self, foot: &Foot) -> DVec3 {
        let corners = self.other.corners(foot.facet);
        (0..3).map(|k| foot.shares[k] * corners[k].place).sum()
    }

    /// The point of the other skin nearest to a point of this one, on either side.
    #[inline(always)]
    fn nearest(&self, point: u32, facets: &[u32], close: &mut CloseFacets) -> Option<PointTouch> {
        let FacetPoint { facet, shares } = self.point(point);
        let [own, places] = self.places;
        let near = NearFacets { patch: self.other, places, facets, periodic: self.periodic };
        let (of, x) = ((facet, &own.balls[facet as usize]), own.point(facet, shares));
        let foot = close.foot(&near, of, x, DEPTH * self.length)?;
        Some(PointTouch { foot, weight: 0.0 })
    }

    /// A point that touches; else it takes in how far it is from that.
    #[inline(always)]
    pub fn touching(
        &self,
        point: u32,
        facets: &[u32],
        gap: &mut MinimumLength,
        close: &mut CloseFacets,
    ) -> Option<PointTouch> {
        let FacetPoint { facet, shares } = self.point(point);
        let PointTouch { foot, .. } = self.nearest(point, facets, close)?;
        if !self.own.is_there(facet) || !self.other.is_there(foot.facet) {
            return None;
        }
        if foot.distance >= 0.0 {
            gap.add_length(foot.distance);
            return None;
        }
        let corner = |patch: &Patch, facet: u32, shares: [f64; 3]| -> f64 {
            let vertices = patch.skin.facets.corners[facet as usize];
            (0..3).map(|k| shares[k] * patch.skin.corner[vertices[k] as usize]).sum()
        };
        let own = corner(self.own, facet, shares);
        let weight = 0.5 * (1.0 + own - corner(self.other, foot.facet, foot.shares));
        (weight > 0.0).then_some(PointTouch { foot, weight })
    }

    /// Velocity of a point, m/s.
    fn velocity(&self, point: u32) -> DVec3 {
        let FacetPoint { facet, shares } = self.point(point);
        let corners = self.own.corners(facet);
        (0..3).map(|k| shares[k] * corners[k].velocity).sum()
    }

    /// Velocity of the other skin at a foot, m/s.
    fn velocity_at(&self, foot: &Foot) -> DVec3 {
        let corners = self.other.corners(foot.facet);
        (0..3).map(|k| foot.shares[k] * corners[k].velocity).sum()
    }

    /// Motion of a point relative to the material of the other body.
    #[inline(always)]
    fn motion(&self, point: u32, touch: &PointTouch) -> PointMotion {
        let FacetPoint { facet, shares } = self.point(point);
        let (own, other) = (self.own.corners(facet), self.other.corners(touch.foot.facet));
        let below = touch.foot.shares;
        if self.interaction.is_elastic() {
            // Neither the velocity across the normal nor the mobility counts.
            let velocity = self.velocity(point) - self.velocity_at(&touch.foot);
            return PointMotion { velocity, spin: 0.0, arm: DVec3::ZERO, mobility: DVec3::ZERO };
        }
        let of_other = |of: fn(&Vertex) -> DMat3| -> DMat3 {
            (0..3).fold(DMat3::ZERO, |sum, k| sum + of(other[k]) * below[k])
        };
        let inverse = of_other(|vertex| vertex.gradient).inverse();
        let spin = spin_of(of_other(|vertex| vertex.rate) * inverse).dot(touch.foot.normal);
        let arm = inverse * (touch.foot.x - self.place(&touch.foot));
        // The normal force acts at the foot, and the stretch between foot and point does not move it.
        let (at_foot, beyond) = (0..3).fold((DVec3::ZERO, DVec3::ZERO), |(foot, beyond), k| {
            (foot + below[k] * other[k].velocity, beyond + below[k] * (other[k].rate * arm))
        });
        let there = at_foot + beyond.reject_from_normalized(touch.foot.normal);
        let mobility = (0..3).map(|k| shares[k] * own[k].mobility + below[k] * other[k].mobility).sum();
        PointMotion { velocity: self.velocity(point) - there, spin, arm, mobility }
    }
}

/// The force of the change of the weight as the foot moves: dw = -dc'/2, with c' linear on the facet, or the
/// edge, of the foot.
pub(super) fn shift_foot(
    own: &mut Patch,
    other: &mut Patch,
    point: FacetPoint,
    touch: &PointTouch,
    energy: f64,
) {
    let Foot { facet: there, shares: below, normal, distance, .. } = touch.foot;
    let skin = &other.skin;
    let [a, b, c] = skin.facets.corners[there as usize].map(|vertex| skin.corner[vertex as usize]);
    if a == b && b == c {
        return;
    }
    // The vertices between which the foot lies, in the first places.
    let mut ends = [0, 1, 2];
    ends.sort_by_key(|&k| k >= skin.facets.axes || below[k] <= 0.0);
    let count = below[..skin.facets.axes].iter().filter(|share| **share > 0.0).count();
    let corner = ends.map(|k| skin.corner[skin.facets.corners[there as usize][k] as usize]);
    if count < 2 || corner[..count].iter().all(|c| *c == corner[0]) {
        return;
    }
    let corners = other.corners(there);
    let (slope, of_shares) = slopes(count, &ends.map(|k| corners[k].place), corner);
    let half = 0.5 * energy;
    own.push(point.facet, point.shares, half * slope, None);
    for (k, of_share) in ends.into_iter().zip(of_shares).take(count) {
        let force = half * (distance * slope.dot(of_share) * normal - below[k] * slope);
        other.push_corner(there, k, force);
    }
}
