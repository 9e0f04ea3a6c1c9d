//! Contact of the skins of two deformable bodies.
//!
//! Points of either skin are tested against the facets of the other one, and the integral is shared. A point counts by
//!
//! ```text
//! w = (1 + c - c')/2,       c at the point, c' at its foot,      c = 1 at corners, 0 elsewhere, linear in between
//! ```
//!
//! so that flat sides share it evenly, and at a corner the corner is the tested point. The overlap is the distance of the point from the facets, radial at
//! notches. The force is the gradient of the energy, including the change of w as the foot moves, and acts along the line between point and foot. Friction acts on both
//! bodies at the point; the material of the other body follows it with the deformation gradient at the foot.

use std::sync::Arc;

use glam::{DMat3, DVec3};

use super::foot::{Ball, Foot, enclose, foot, slopes};
use super::near_skins::NearSkins;
use crate::contact::active::{ActiveContacts, Least};
use crate::contact::bodies::{MotionBounds, failed};
use crate::contact::laws::Touch;
use crate::contact::response::time_step::{self, OfSkins};
use crate::contact::response::{ContactEnergy, ContactState, History, Interaction, PairKey};
use crate::neighbors::NeighborError;
use crate::parallel::{BlockSum, Largest, sum_over_blocks};
use crate::schedule::{Step, StepError};
use crate::skins::{Patch, Rule, Skin, SkinColumns, SkinView, Wanted};

/// How deep a point may be below the surface of the other body, over the mean spacing.
const DEPTH: f64 = 0.5;
/// Factor on the squared frequency of two skins: a particle at a corner is pressed from two sides.
const CORNERS: f64 = 2.0;

/// Contact of two skins.
pub(in crate::contact) struct SkinPair {
    interaction: Interaction,
    /// Both skins.
    pub patches: [Patch; 2],
    /// Whether the references of both bodies stay.
    keeps_reference: bool,
    rule: Rule,
    near: NearSkins,
    /// Around the facets of each side that are near the other.
    balls: [Vec<Ball>; 2],
    /// The points of each side against the facets of the other.
    pub passes: [ActiveContacts<PointTouch, PointPush, Least>; 2],
}

/// A point that touches.
#[derive(Clone, Copy, Default)]
pub(in crate::contact) struct PointTouch {
    x: DVec3,
    foot: Foot,
    /// Share of the integral.
    weight: f64,
}

/// What a point does.
#[derive(Clone, Copy, Default)]
pub(in crate::contact) struct PointPush {
    /// Force on the point, N, and how much of it is across the normal.
    force: DVec3,
    across: DVec3,
    /// From the foot to the point in the reference configuration of the other body, m.
    arm: DVec3,
    /// Energy of the law over the weight, J, where the weight changes as the foot moves.
    energy: f64,
    /// Stiffness over the area, N/m3 (N/m2 in two dimensions).
    stiffness: f64,
}

/// What is the same for all points.
struct Side<'a> {
    own: &'a Patch,
    other: &'a Patch,
    /// Around the facets of the other one.
    balls: &'a [Ball],
    rule: &'a Rule,
    /// Length for which the law holds, m.
    length: f64,
}

impl SkinPair {
    /// Contact of two skins.
    pub fn new(interaction: Interaction, skins: [Arc<Skin>; 2]) -> Self {
        let rule = Rule::exact(skins[0].facets.axes);
        let passes = skins.each_ref().map(|skin| {
            let mut contacts = ActiveContacts::default();
            contacts.reserve(rule.len() * skin.facets.corners.len());
            contacts
        });
        let balls = skins.each_ref().map(|skin| Vec::with_capacity(skin.facets.corners.len()));
        let near = NearSkins::new(skins.each_ref().map(|skin| &**skin));
        let patches = skins.map(Patch::new);
        Self { interaction, patches, keeps_reference: false, rule, near, balls, passes }
    }

    /// Works out the forces of all points that touch.
    pub fn run(
        &mut self,
        step: &mut Step<'_>,
        motion: [MotionBounds; 2],
    ) -> Result<ContactEnergy, StepError> {
        let dt = step.clock.dt;
        let skins = [0, 1].map(|k| Arc::clone(&self.patches[k].skin));
        let first = SkinColumns::new(&skins[0], step.world)?;
        let second = SkinColumns::new(&skins[1], step.world)?;
        let speed = motion[0].speed + motion[1].speed;
        self.keeps_reference = skins.iter().all(|skin| time_step::keeps_reference(step, skin.body));
        let (energies, stiffness) = self.act([first.view(), second.view()], speed, dt).map_err(failed)?;
        let squared = CORNERS * stiffness * (skins[0].lightness + skins[1].lightness);
        let reach = skins[0].spacing.min(skins[1].spacing);
        time_step::propose(step, (skins[0].body, skins[1].body), squared, speed, reach);
        Ok(energies)
    }

    /// The forces between two bodies, whose largest speeds add up to `speed`, m/s, after a step of `dt`, s; with the stiffness over an area that the next one goes by, N/m3 (N/m2 in
    /// two dimensions).
    pub fn act(
        &mut self,
        views: [SkinView<'_>; 2],
        speed: f64,
        dt: f64,
    ) -> Result<(ContactEnergy, f64), NeighborError> {
        if self.near.is_old(speed, dt) {
            let [first, second] = self.patches.each_ref().map(|patch| &*patch.skin);
            self.near.find([first, second], &views, self.rule.len())?;
            for (patch, facets) in self.patches.iter_mut().zip(&self.near.facets) {
                patch.select(facets.iter().copied());
            }
        }
        let Interaction { damping_ratio, .. } = self.interaction;
        let wanted = Wanted { mobility: damping_ratio > 0.0, gradients: !self.interaction.is_elastic() };
        self.patches.iter_mut().zip(&views).for_each(|(patch, view)| patch.update(view, dt, wanted));
        for (side, balls) in self.balls.iter_mut().enumerate() {
            enclose(&self.patches[side], &self.near.facets[side], balls);
        }
        let mut energies = ContactEnergy::default();
        let (mut stiffest, mut gap) = (Largest::default(), Least::default());
        for side in 0..2 {
            let (of_side, of_points) = self.evaluate(side, dt);
            energies.add(&of_side);
            gap.add(&of_points);
            stiffest.add(&self.push(side));
        }
        self.patches.iter_mut().for_each(Patch::hand_on);
        let length = self.length();
        let touch = Touch { overlap: 0.0, radius: 0.5 * length, length, depth: length };
        let usual = length.powi(self.patches[0].skin.facets.axes as i32 - 1);
        let law = &*self.interaction.law;
        let (stiffest, gap, keeps_reference) = (stiffest.0, gap.0, self.keeps_reference);
        let of_skins = OfSkins { law, touch, usual, stiffest, gap, speed, dt, keeps_reference };
        Ok((energies, of_skins.stiffness()))
    }

    /// Length for which the law holds, m.
    fn length(&self) -> f64 {
        0.5 * (self.patches[0].skin.spacing + self.patches[1].skin.spacing)
    }

    /// What the points of one side do, and the least gap of points that do not touch, m.
    fn evaluate(&mut self, side: usize, dt: f64) -> (ContactEnergy, Least) {
        let length = self.length();
        let Self { interaction, patches, rule, near, balls, passes, .. } = self;
        let (own, other, balls) = (&patches[side], &patches[1 - side], &balls[1 - side][..]);
        let side_of = Side { own, other, balls, rule, length };
        let at = &side_of;
        let gap = passes[side].find(&near.candidates[side], |(point, _), gap: &mut Least| {
            at.meet(point, near.facets_near(side, point / at.rule.len() as u32), gap)
        });
        let axes = at.own.skin.facets.axes;
        let usual = length.powi(axes as i32 - 1);
        let respond =
            |(point, _): PairKey, meet: &PointTouch, before: &History, energies: &mut ContactEnergy| {
                let PointTouch { x, foot, weight } = *meet;
                let (velocity, arm, mobility) = at.motion(point, meet);
                if !before.is_elastic() {
                    energies.losses.add_work(1.0, before, velocity, dt);
                }
                let area = at.area(point);
                let touch = Touch { overlap: -foot.distance, radius: 0.5 * length, length, depth: length };
                let state = ContactState {
                    touch,
                    normal: foot.normal,
                    scale: 1.0,
                    area: weight * area / usual,
                    arms: [x - at.place(&foot), DVec3::ZERO],
                    velocity,
                };
                let inverse_mass = |n: DVec3| mobility.dot(n * n) / (weight * area);
                let response = interaction.respond(&state, inverse_mass, dt, before);
                energies.losses.add_work(1.0, &response.history, velocity, dt);
                energies.losses.keep(1.0, before, &response.history);
                energies.stored += response.spring.energy + response.history.energy();
                let across = response.force - response.force.dot(foot.normal) * foot.normal;
                let stiffness = response.spring.stiffness / area;
                let energy = response.spring.energy / weight;
                (response.history, PointPush { force: response.force, across, arm, energy, stiffness })
            };
        let end = |(point, _): PairKey, history: &History, energies: &mut ContactEnergy| {
            if !history.is_elastic() {
                let meet = at.nearest(point, near.facets_near(side, point / at.rule.len() as u32));
                let velocity = meet.map_or(DVec3::ZERO, |meet| at.motion(point, &meet).0);
                energies.losses.add_work(1.0, history, velocity, dt);
            }
            energies.losses.keep(1.0, history, &History::default());
        };
        let points = at.rule.len() * at.own.skin.facets.corners.len();
        (passes[side].respond(points, respond, end), gap)
    }

    /// Pushes the vertices of both skins; returns the largest stiffness over an area.
    fn push(&mut self, side: usize) -> Largest {
        let Self { patches, rule, passes, .. } = self;
        let count = rule.len();
        let [first, second] = patches;
        let (own, other) = if side == 0 { (first, second) } else { (second, first) };
        let pass = &passes[side];
        for (((point, _), meet), push) in pass.met().iter().zip(pass.pushes()) {
            let (facet, shares) = (point / count as u32, rule.shares(*point as usize % count));
            let Foot { facet: there, shares: below, .. } = meet.foot;
            own.push(facet, shares, push.force, None);
            let f = -push.across;
            let couple = DMat3::from_cols(f * push.arm.x, f * push.arm.y, f * push.arm.z);
            other.push(there, below, -push.force, (f != DVec3::ZERO).then_some(&couple));
            shift_foot(own, other, (facet, shares), meet, push.energy);
        }
        sum_over_blocks(pass.pushes(), &|_, pushes: &[PointPush]| {
            Largest::of(pushes.iter().map(|push| push.stiffness))
        })
    }
}

/// The force of the change of the weight as the foot moves: dw = -dc'/2, with c' linear on the facet, or the edge, of the foot.
fn shift_foot(
    own: &mut Patch,
    other: &mut Patch,
    (facet, shares): (u32, [f64; 3]),
    meet: &PointTouch,
    energy: f64,
) {
    let Foot { facet: there, shares: below, normal, distance } = meet.foot;
    let skin = &other.skin;
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
    own.push(facet, shares, half * slope, None);
    for (k, of_share) in ends.into_iter().zip(of_shares).take(count) {
        let force = half * (distance * slope.dot(of_share) * normal - below[k] * slope);
        other.push_corner(there, k, force);
    }
}

impl Side<'_> {
    fn corners(&self, point: u32) -> (u32, [f64; 3]) {
        let count = self.rule.len();
        (point / count as u32, self.rule.shares(point as usize % count))
    }

    /// The length (area) of a point in the reference configuration, m (m2).
    fn area(&self, point: u32) -> f64 {
        self.own.skin.measure[self.corners(point).0 as usize] / self.rule.len() as f64
    }

    /// Where a foot is, m.
    fn place(&self, foot: &Foot) -> DVec3 {
        let corners = self.other.corners(foot.facet);
        (0..3).map(|k| foot.shares[k] * corners[k].place).sum()
    }

    /// The point of the other skin nearest to a point of this one, on either side.
    fn nearest(&self, point: u32, facets: &[u32]) -> Option<PointTouch> {
        let (facet, shares) = self.corners(point);
        let corners = self.own.corners(facet);
        let x: DVec3 = (0..3).map(|k| shares[k] * corners[k].place).sum();
        let foot = foot(self.other, self.balls, facets, x, DEPTH * self.length)?;
        Some(PointTouch { x, foot, weight: 0.0 })
    }

    /// A point that touches; else it takes in how far it is from that.
    fn meet(&self, point: u32, facets: &[u32], gap: &mut Least) -> Option<PointTouch> {
        let (facet, shares) = self.corners(point);
        let PointTouch { x, foot, .. } = self.nearest(point, facets)?;
        let there = self.other.corners(foot.facet);
        if !self.own.corners(facet).iter().chain(&there).all(|corner| corner.is_there) {
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
        (weight > 0.0).then_some(PointTouch { x, foot, weight })
    }

    /// Velocity of a point, m/s.
    fn velocity(&self, point: u32) -> DVec3 {
        let (facet, shares) = self.corners(point);
        let corners = self.own.corners(facet);
        (0..3).map(|k| shares[k] * corners[k].velocity).sum()
    }

    /// Velocity of a point relative to the material of the other body, along the normal that at the foot and across it that at the point, m/s, how that is reached from the foot in the reference configuration, m, and
    /// how much a traction moves both, m2/kg.
    fn motion(&self, point: u32, meet: &PointTouch) -> (DVec3, DVec3, DVec3) {
        let (facet, shares) = self.corners(point);
        let (own, other) = (self.own.corners(facet), self.other.corners(meet.foot.facet));
        let below = meet.foot.shares;
        let gradient = (0..3).fold(DMat3::ZERO, |sum, k| sum + other[k].gradient * below[k]);
        let arm = gradient.inverse() * (meet.x - self.place(&meet.foot));
        // The normal force acts at the foot, and the stretch between foot and point does not move it.
        let (at_foot, beyond) = (0..3).fold((DVec3::ZERO, DVec3::ZERO), |(foot, beyond), k| {
            (foot + below[k] * other[k].velocity, beyond + below[k] * (other[k].rate * arm))
        });
        let there = at_foot + beyond.reject_from_normalized(meet.foot.normal);
        let mobility = (0..3).map(|k| shares[k] * own[k].mobility + below[k] * other[k].mobility).sum();
        (self.velocity(point) - there, arm, mobility)
    }
}
