//! Edges and tips of thin parts of a tool, tested against the facets of a skin.
//!
//! The points of a skin do not see what is thinner than their distance: a blade passes between them, or they
//! slide off its tip to its sides. So points of its edges and corners, and circles of thin round bodies,
//! touch the facets. The overlap is the distance of the point from the facets, and the force acts at the
//! vertices of the facet by the shares of the foot, as all forces between skin and tool do: the line of the
//! force passes through the point and its foot, so that momenta and energy are exact.

use glam::DVec3;

use super::facet_places::FacetPlaces;
use super::foot::{Foot, NearFacets, foot};
use super::points::{Extremes, PressPass, ToolView, VertexPress};
use super::skin_end::share_at_end;
use super::tool_edges::{Tip, tips_of};
use crate::contact::laws::Spring;
use crate::parallel::{BlockSum, Maximum, sum_over_blocks};
use crate::rigid::Round;
use crate::shapes::{Aabb, directed_area};

/// Depth over the spacing at which a point is lost.
const DEEPEST: f64 = 0.5;
/// How far below the skin a lost point of a sharp edge is looked for, over the spacing.
const LOST: f64 = 2.0;
/// Length (area) of a facet over that of the reference, from which on a sharp edge that is no farther from it
/// than that, over the spacing, draws it along: beside a wedge of 70 degrees that is pressed in, 1.7.
const SPLIT: f64 = 1.3;
const TOUCHES: f64 = 0.1;

/// The points of a tool; they are found in the first step.
#[derive(Default)]
pub(super) struct Tips {
    list: Option<Vec<Tip>>,
    /// What each presses on in this step.
    pushes: Vec<TipPush>,
    places: FacetPlaces,
}

/// The spring of a point on a facet; without a force it does not touch.
#[derive(Clone, Copy, Default)]
struct TipPush {
    spring: Spring,
    foot: Foot,
    overlap: f64,
    area: f64,
}

impl Tips {
    /// Adds the forces of the points that touch one of these facets to the vertices; those nearer than
    /// `reach`, m, may soon.
    pub fn press(
        &mut self,
        on: &PressPass<'_>,
        facets: &[u32],
        reach: f64,
        pressed: &mut [VertexPress],
    ) -> Extremes {
        let Self { list, pushes, places } = self;
        let skin = &on.patch.skin;
        let list = list.get_or_insert_with(|| tips_of(on.tool, on.sides, skin.spacing, skin.facets.axes));
        if list.is_empty() || facets.is_empty() {
            return Extremes::default();
        }
        places.locate(on.patch, facets);
        let periodic = on.sides.periodic.any().then_some(on.sides.periodic);
        let near = NearFacets { patch: on.patch, places, facets, periodic };
        let bounds = periodic.is_none().then(|| {
            let corners = facets.iter().flat_map(|&facet| on.patch.places(facet));
            Aabb::around(corners).grown(LOST * skin.spacing)
        });
        pushes.resize(list.len(), TipPush::default());
        let rows = (&list[..], &mut pushes[..]);
        let extremes = sum_over_blocks(rows, &|_, (list, pushes): (&[Tip], &mut [TipPush])| {
            let mut extremes = Extremes::default();
            for (tip, push) in list.iter().zip(pushes) {
                let is_far = bounds.is_some_and(|bounds| is_outside(&bounds, on.tool.place(tip.point)));
                let found = if is_far { None } else { tip.press(on, &near, reach, &mut extremes) };
                *push = found.unwrap_or_default();
            }
            extremes
        });
        for TipPush { spring, foot, overlap, area } in pushes.iter().filter(|push| push.spring.force > 0.0) {
            let numbers = on.patch.numbers(foot.facet).into_iter().zip(foot.shares);
            for (number, share) in numbers.filter(|(_, share)| *share > 0.0) {
                pressed[number].add(share, spring, -foot.normal, *area, *overlap);
            }
        }
        extremes
    }
}

impl Tip {
    /// What it presses on, if it touches.
    fn press(
        &self,
        on: &PressPass<'_>,
        near: &NearFacets<'_>,
        reach: f64,
        extremes: &mut Extremes,
    ) -> Option<TipPush> {
        let Some((foot, radius)) = self.foot(near, on) else {
            extremes.is_split |= self.is_sharp && self.is_lost(near, on);
            return None;
        };
        let end = share_at_end(on.patch, on.sides, &foot);
        if self.is_sharp && end > 0.0 && foot.distance < TOUCHES * on.patch.skin.spacing {
            extremes.is_split |= stretch(on, foot.facet) > SPLIT;
        }
        let area = end * self.area;
        if area == 0.0 {
            return None;
        }
        let corners = on.patch.corners(foot.facet);
        let velocity: DVec3 = (0..3).map(|k| foot.shares[k] * corners[k].velocity).sum();
        let (normal, at) = (-foot.normal, on.sides.near(foot.x, on.tool));
        let approach = (on.tool.velocity_at(at) - velocity).dot(normal);
        let seen = ToolView { distance: foot.distance - radius, normal, approach };
        if seen.distance >= 0.0 {
            extremes.gap.add_length(seen.distance);
            if seen.distance < reach {
                extremes.landing += area * on.tool.inverse_mass_at(at, normal);
            }
            return None;
        }
        let spring = on.spring(&seen, area, extremes);
        // Points of the skin press on the same particles.
        let both = 1.0 + area / on.usual;
        extremes.stiffest.add(&Maximum(both * spring.stiffness / area));
        Some(TipPush { spring, foot, overlap: -seen.distance, area })
    }

    /// Whether it is inside of the body, farther below the skin than it may be to touch it.
    fn is_lost(&self, near: &NearFacets<'_>, on: &PressPass<'_>) -> bool {
        let foot = foot(near, on.tool.place(self.point), LOST * on.patch.skin.spacing);
        foot.is_some_and(|foot| {
            let is_inside = foot.distance < 0.0 && on.patch.is_there(foot.facet);
            is_inside && share_at_end(on.patch, on.sides, &foot) > 0.0
        })
    }

    /// The foot on the nearest facet that is there, and the radius of the tip about the point with that foot,
    /// m.
    fn foot(&self, near: &NearFacets<'_>, on: &PressPass<'_>) -> Option<(Foot, f64)> {
        let spacing = on.patch.skin.spacing;
        let of = |point: DVec3, reach: f64| {
            let foot = foot(near, on.tool.place(point), DEEPEST * spacing + reach)?;
            on.patch.is_there(foot.facet).then_some(foot)
        };
        match self.round {
            Round::Point | Round::Edge(_) => Some((of(self.point, 0.0)?, 0.0)),
            Round::Ball(radius) => Some((of(self.point, radius)?, radius)),
            Round::Ellipsoid(ellipsoid) => {
                let foot = of(self.point, ellipsoid.extremes()[1])?;
                let lowest = ellipsoid.lowest(on.tool.state.rotation.inverse() * foot.normal);
                Some((of(self.point + ellipsoid.arm(lowest), 0.0)?, 0.0))
            }
            Round::Rim(rim) => {
                let foot = of(self.point, rim.radius)?;
                let arm = rim.lowest(on.tool.state.rotation.inverse() * foot.normal);
                Some((arm.map_or(Some(foot), |arm| of(self.point + arm, 0.0))?, 0.0))
            }
        }
    }
}

fn is_outside(bounds: &Aabb, x: DVec3) -> bool {
    (x.cmplt(bounds.min) | x.cmpgt(bounds.max)).any()
}

/// Length (area) of a facet over that of the reference.
fn stretch(on: &PressPass<'_>, facet: u32) -> f64 {
    let axes = on.patch.skin.facets.axes;
    directed_area(axes, &on.patch.places(facet)).length() / on.patch.skin.measure[facet as usize]
}
