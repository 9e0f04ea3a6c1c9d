//! Contact of the skins of two deformable bodies, or of one with itself.
//!
//! Points of either skin are tested against the facets of the other one, and the integral is shared. A point
//! counts by
//!
//! ```text
//! w = (1 + c - c')/2,       c at the point, c' at its foot,      c = 1 at corners, 0 elsewhere, linear in between
//! ```
//!
//! so that flat sides share it evenly, and at a corner the corner is the tested point. The overlap is the
//! distance of the point from the facets, radial at notches. The force is the gradient of the energy,
//! including the change of w as the foot moves, and acts along the line between point and foot. Friction acts
//! on both bodies at the point; the material of the other body follows it with the deformation gradient at
//! the foot.
//!
//! Where a body touches itself, its points are tested against its facets: points of both places that touch
//! share the integral, as those of two bodies do.

use std::sync::Arc;

use glam::{DMat3, DVec3};

use super::close_facets::CloseFacets;
use super::facet_places::FacetPlaces;
use super::foot::Foot;
use super::near_skins::{NearSkins, speed_of_points};
use super::side::{FacetPoint, PointPush, PointTouch, SkinSide, shift_foot};
use crate::contact::active::{ActiveContacts, MinimumLength};
use crate::contact::bodies::{MotionBounds, failed};
use crate::contact::laws::Touch;
use crate::contact::response::time_step::{self, OfSkins, Touches};
use crate::contact::response::{ContactEnergy, Interaction};
use crate::neighbors::{NeighborError, Periodic};
use crate::parallel::{BlockSum, Maximum, sum_over_blocks};
use crate::schedule::{Step, StepError};
use crate::skins::{Patch, QuadratureRule, Skin, SkinColumns, SkinView, Wanted};
use crate::symmetry::Map;

/// Factor on the squared frequency of two skins: a particle at a corner is pressed from two sides.
const CORNERS: f64 = 2.0;

/// Contact of two skins.
pub(in crate::contact) struct SkinPair {
    interaction: Arc<Interaction>,
    /// Number of skins whose points are tested: both, or the one of a body that touches itself.
    sides: usize,
    /// Both skins; of a body that touches itself its skin twice, first with its points, then with its facets.
    pub patches: [Patch; 2],
    /// Whether the references of both bodies stay.
    keeps_reference: bool,
    rule: QuadratureRule,
    near: NearSkins,
    periodic: Periodic,
    /// Where the facets of each side are that are near the other.
    places: [FacetPlaces; 2],
    /// The points of each side against the facets of the other.
    pub passes: [ActiveContacts<PointTouch, PointPush, MinimumLength>; 2],
}

impl SkinPair {
    /// Contact of two skins in a domain that is periodic along some axes.
    pub fn new(interaction: Arc<Interaction>, skins: [Arc<Skin>; 2], periodic: Periodic) -> Self {
        let rule = QuadratureRule::exact(skins[0].facets.axes);
        let sides = if skins[0].body == skins[1].body { 1 } else { 2 };
        let passes = [0, 1].map(|side| {
            let mut contacts = ActiveContacts::default();
            if side < sides {
                contacts.reserve(rule.len() * skins[side].facets.corners.len());
            }
            contacts
        });
        let places = skins.each_ref().map(|skin| FacetPlaces::with_capacity(skin.facets.corners.len()));
        let near = NearSkins::new(skins.each_ref().map(|skin| &**skin), periodic);
        let patches = skins.map(Patch::new);
        Self { interaction, sides, patches, keeps_reference: false, rule, near, periodic, places, passes }
    }

    /// Whether nothing touches and no facets are near each other.
    pub fn is_idle(&self) -> bool {
        self.near.is_empty() && self.passes.iter().all(|pass| pass.histories.is_empty())
    }

    /// Has all facets searched again.
    pub fn forget(&mut self) {
        self.near.forget();
    }

    /// Computes the forces of all points that touch.
    pub fn run(
        &mut self,
        step: &mut Step<'_>,
        motion: [MotionBounds; 2],
    ) -> Result<ContactEnergy, StepError> {
        let dt = step.clock.dt;
        let skins = [0, 1].map(|k| Arc::clone(&self.patches[k].skin));
        let first = SkinColumns::new(&skins[0], step.world)?;
        let second = SkinColumns::new(&skins[1], step.world)?;
        let [speed, fastest] = [MotionBounds::approach(motion, &Map::IDENTITY), speed_of_points(motion)];
        self.keeps_reference = skins.iter().all(|skin| time_step::keeps_reference(step, skin.body));
        let (energies, stiffness) =
            self.act([first.view(), second.view()], [speed, fastest], dt).map_err(failed)?;
        let squared = CORNERS * stiffness * (skins[0].lightness + skins[1].lightness);
        let reach = skins[0].spacing.min(skins[1].spacing);
        let touches = Touches { squared, stored: energies.stored, speed, reach };
        time_step::propose(step, [skins[0].body, skins[1].body], &touches)?;
        Ok(energies)
    }

    /// The forces between two bodies, whose particles and points approach each other at most with these
    /// speeds, m/s, after a step of `dt`, s; with the stiffness over an area that the next one goes by, N/m3
    /// (N/m2 in two dimensions).
    pub fn act(
        &mut self,
        views: [SkinView<'_>; 2],
        [speed, fastest]: [f64; 2],
        dt: f64,
    ) -> Result<(ContactEnergy, f64), NeighborError> {
        if self.near.is_old(fastest * dt) {
            let [first, second] = self.patches.each_ref().map(|patch| &*patch.skin);
            if self.near.find([first, second], &views, self.rule.len())? {
                for (patch, facets) in self.patches.iter_mut().zip(&self.near.facets) {
                    patch.select(facets.iter().copied());
                }
            }
        }
        let Interaction { damping_ratio, .. } = *self.interaction;
        let wanted = Wanted { mobility: damping_ratio > 0.0, gradients: !self.interaction.is_elastic() };
        self.patches.iter_mut().zip(&views).for_each(|(patch, view)| patch.update(view, dt, wanted));
        for (side, places) in self.places.iter_mut().enumerate() {
            places.locate(&self.patches[side], &self.near.facets[side]);
        }
        let mut energies = ContactEnergy::default();
        let (mut stiffest, mut gap) = (Maximum::default(), MinimumLength::default());
        for side in 0..self.sides {
            let (of_side, of_points) = self.evaluate(side, dt);
            energies.add(&of_side);
            gap.add(&of_points);
            stiffest.add(&self.push(side));
        }
        self.patches.iter_mut().for_each(Patch::transfer_forces);
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

    /// Forces of the points of one side, and the minimum gap of points without contact, m.
    fn evaluate(&mut self, side: usize, dt: f64) -> (ContactEnergy, MinimumLength) {
        let length = self.length();
        let periodic = self.periodic.any().then_some(self.periodic);
        let Self { interaction, patches, rule, near, places, passes, .. } = self;
        let (own, other) = (&patches[side], &patches[1 - side]);
        let places = [&places[side], &places[1 - side]];
        let at = SkinSide { interaction, own, other, places, rule, periodic, length, dt };
        let facets_near = |point: u32| near.facets_near(side, at.point(point).facet);
        let gap = passes[side].find(
            &near.candidates[side],
            |(point, _), gap: &mut MinimumLength, close: &mut CloseFacets| {
                at.touching(point, facets_near(point), gap, close)
            },
        );
        let energies = passes[side].respond(
            at.rule.len() * at.own.skin.facets.corners.len(),
            |(point, _), touch, before, energies| at.respond(point, touch, before, energies),
            |(point, _), history, energies| at.end(point, facets_near(point), history, energies),
        );
        (energies, gap)
    }

    /// Pushes the vertices of both skins; returns the largest stiffness over an area.
    fn push(&mut self, side: usize) -> Maximum {
        let Self { interaction, patches, rule, passes, .. } = self;
        let heat = [interaction.heat[side], interaction.heat[1 - side]];
        let [first, second] = patches;
        let (own, other) = if side == 0 { (first, second) } else { (second, first) };
        let pass = &passes[side];
        for (((point, _), touch), push) in pass.met().iter().zip(pass.pushes()) {
            let point = FacetPoint::of(rule, *point);
            let Foot { facet: there, shares: below, .. } = touch.foot;
            own.push(point.facet, point.shares, push.force, None);
            let f = -push.across;
            let couple = DMat3::from_cols(f * push.arm.x, f * push.arm.y, f * push.arm.z);
            other.push(there, below, -push.force, (f != DVec3::ZERO).then_some(&couple));
            shift_foot(own, other, point, touch, push.energy);
            if push.heat != 0.0 {
                own.heat(point.facet, point.shares, heat[0] * push.heat);
                other.heat(there, below, heat[1] * push.heat);
            }
        }
        sum_over_blocks(pass.pushes(), &|_, pushes: &[PointPush]| {
            Maximum::of(pushes.iter().map(|push| push.stiffness))
        })
    }
}
