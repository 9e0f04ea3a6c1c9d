//! The points at which the contact of a skin with a tool is integrated.
//!
//! A facet has closely spaced points, so that it slides without grooves, where the contact area ends on it or
//! where the tool is curved or has an edge. A facet with all vertices behind a smooth part of the tool has
//! only the points needed to integrate the square of a linear overlap. Behind a plane the vertices determine
//! the points, and under uniform overlap the vertices are the points; that is most of a contact. Points carry
//! no history, so that a facet can change its rule; friction belongs to vertices.

use glam::DVec3;

use crate::contact::active::MinimumLength;
use crate::contact::bodies::ContactSides;
use crate::contact::laws::{Spring, Touch};
use crate::contact::response::Interaction;
use crate::parallel::{BlockSum, Maximum};
use crate::rigid::RigidBody;
use crate::skins::{Patch, QuadratureRule, Skin};

/// No point of a facet is farther from its nearest vertex than that share of its longest side.
const BEYOND: f64 = 0.6;
/// Parts of a segment of half a spacing, and rows of a triangle of a spacing, each with a point.
const PARTS: [usize; 2] = [8, 2];
/// Cosine of the turn of the tool's normal between the vertices of a facet up to which it counts as smooth.
const SMOOTH: f64 = 0.9;
/// Differences of the overlap over the largest one, and over the longest side of the facet, up to which it is
/// even: there the rules differ by some ten-thousandths of the energy of the facet.
const EVEN: f64 = 0.05;
const EVEN_OF_SIDE: f64 = 1e-3;
/// Tolerance of distances from those of a plane, over the longest side of the facet.
const PLANE: f64 = 1e-9;

/// Position of the tool relative to a vertex.
#[derive(Clone, Copy, Default)]
pub(super) struct ToolView {
    /// Distance from its surface, m; negative inside.
    pub distance: f64,
    /// Outward normal of the tool.
    pub normal: DVec3,
    /// Speed at which the vertex approaches along it, m/s.
    pub approach: f64,
}

/// Which points of a facet may touch.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum FacetPart {
    /// None: the facet is so far away at least, m.
    No(f64),
    /// Those of the fine rule.
    Partly,
    /// Those of the coarse rule.
    Wholly,
    /// The same, behind a plane.
    Flat,
    /// The vertices, behind a plane and about equally deep.
    Evenly,
}

impl FacetPart {
    /// Of a facet whose vertices are at these places, m, and see that.
    #[inline]
    pub fn of(places: [DVec3; 3], seen: [&ToolView; 3]) -> Self {
        let [p, q, r] = places;
        let size = p.distance_squared(q).max(q.distance_squared(r)).max(r.distance_squared(p)).sqrt();
        let [a, b, c] = seen;
        let least = a.distance.min(b.distance).min(c.distance) - BEYOND * size;
        if least >= 0.0 {
            return Self::No(least);
        }
        let turn = a.normal.dot(b.normal).min(b.normal.dot(c.normal)).min(c.normal.dot(a.normal));
        if a.distance.max(b.distance).max(c.distance) >= 0.0 || turn <= SMOOTH {
            return Self::Partly;
        }
        let off = |x: DVec3, seen: &ToolView| (seen.distance - a.distance - a.normal.dot(x - p)).abs();
        if turn <= 1.0 - PLANE || off(q, b).max(off(r, c)) >= PLANE * size {
            return Self::Wholly;
        }
        let (nearest, farthest) = (least + BEYOND * size, a.distance.max(b.distance).max(c.distance));
        let is_even = farthest - nearest < (-EVEN * nearest).max(EVEN_OF_SIDE * size);
        if is_even { Self::Evenly } else { Self::Flat }
    }
}

/// Contact force on a vertex.
#[derive(Clone, Copy, Default)]
pub(in crate::contact) struct VertexPress {
    /// Along the normals, N.
    pub force: DVec3,
    /// The sum of the springs.
    pub spring: Spring,
    /// Area, m2 (m), and the sum of area times overlap.
    pub area: f64,
    pub depth: f64,
}

impl VertexPress {
    /// Adds a share of a spring along `normal` that represents an area, m2 (m).
    #[inline]
    pub fn add(&mut self, share: f64, spring: &Spring, normal: DVec3, area: f64, overlap: f64) {
        let part = spring.scaled(share);
        self.join(&Self {
            force: part.force * normal,
            spring: part,
            area: share * area,
            depth: share * area * overlap,
        });
    }

    /// Adds what presses by another facet.
    #[inline]
    pub fn join(&mut self, other: &Self) {
        self.force += other.force;
        self.spring.force += other.spring.force;
        self.spring.stiffness += other.spring.stiffness;
        self.spring.energy += other.spring.energy;
        self.area += other.area;
        self.depth += other.depth;
    }
}

/// Extremes over the points of some facets or vertices.
#[derive(Clone, Copy, Default)]
pub(super) struct Extremes {
    /// Gap of the nearest point that does not touch, m.
    pub gap: MinimumLength,
    /// Stiffness over the area, N/m3 (N/m2 in two dimensions).
    pub stiffest: Maximum,
    /// Sum of the areas, m2 (m), that may soon touch, each times the inverse mass of the tool there, 1/kg.
    pub landing: f64,
    /// Whether a sharp edge of the tool draws the skin along with it.
    pub is_split: bool,
}

impl BlockSum for Extremes {
    fn add(&mut self, next: &Self) {
        self.gap.add(&next.gap);
        self.stiffest.add(&next.stiffest);
        self.landing += next.landing;
        self.is_split |= next.is_split;
    }
}

/// The points of a skin on a tool.
pub(super) struct Points {
    fine: QuadratureRule,
    coarse: QuadratureRule,
}

/// Data common to all points of a step.
pub(super) struct PressPass<'a> {
    interaction: &'a Interaction,
    pub patch: &'a Patch,
    pub sides: &'a ContactSides,
    pub tool: &'a RigidBody,
    /// The law at an overlap of zero, and the area for which it holds, m2 (m).
    touch: Touch,
    pub usual: f64,
    /// Length of the step, s.
    dt: f64,
}

impl Points {
    /// Those of segments (two axes) or triangles (three).
    pub fn new(axes: usize) -> Self {
        Self { fine: QuadratureRule::fine(axes, PARTS[axes - 2]), coarse: QuadratureRule::exact(axes) }
    }

    /// Contact force on the vertices of a facet.
    pub fn press(
        &self,
        on: &PressPass<'_>,
        facet: u32,
        reached: FacetPart,
        seen: [&ToolView; 3],
        extremes: &mut Extremes,
    ) -> [VertexPress; 3] {
        if reached == FacetPart::Flat {
            return self.press_flat(on, facet, seen, extremes);
        }
        let mut pressed = [VertexPress::default(); 3];
        let rule = if reached == FacetPart::Partly { &self.fine } else { &self.coarse };
        let [a, b, c] = on.patch.corners(facet);
        let area = on.patch.skin.measure[facet as usize] / rule.len() as f64;
        for point in 0..rule.len() {
            let shares = rule.shares(point);
            let [p, q, r] = shares;
            let seen = on.look(
                p * a.place + q * b.place + r * c.place,
                p * a.velocity + q * b.velocity + r * c.velocity,
            );
            if seen.distance >= 0.0 {
                extremes.gap.add_length(seen.distance);
            } else if seen.distance < 0.0 {
                // What is not a number does not touch.
                let spring = on.spring(&seen, area, extremes);
                for (pressed, share) in pressed.iter_mut().zip(shares) {
                    pressed.add(share, &spring, seen.normal, area, -seen.distance);
                }
            }
        }
        pressed
    }

    /// Contact force on the vertices of a facet behind a plane: the depths of its points follow from those of
    /// the vertices.
    fn press_flat(
        &self,
        on: &PressPass<'_>,
        facet: u32,
        [a, b, c]: [&ToolView; 3],
        extremes: &mut Extremes,
    ) -> [VertexPress; 3] {
        let (rule, normal) = (&self.coarse, a.normal);
        let area = on.patch.skin.measure[facet as usize] / rule.len() as f64;
        let mut pressed = [VertexPress::default(); 3];
        for point in 0..rule.len() {
            let shares = rule.shares(point);
            let [p, q, r] = shares;
            let distance = p * a.distance + q * b.distance + r * c.distance;
            let approach = p * a.approach + q * b.approach + r * c.approach;
            if distance.is_nan() {
                continue;
            }
            let spring = on.spring(&ToolView { distance, normal, approach }, area, extremes);
            for (on_vertex, share) in pressed.iter_mut().zip(shares) {
                on_vertex.spring.force += share * spring.force;
                on_vertex.spring.stiffness += share * spring.stiffness;
                on_vertex.spring.energy += share * spring.energy;
                on_vertex.area += share * area;
                on_vertex.depth -= share * area * distance;
            }
        }
        for on_vertex in &mut pressed {
            on_vertex.force = on_vertex.spring.force * normal;
        }
        pressed
    }
}

/// The law of a skin on a tool at an overlap of zero, and the area for which it holds, m2 (m).
pub(super) fn touch_of(skin: &Skin, tool: &RigidBody) -> (Touch, f64) {
    let length = skin.spacing;
    let own = 0.5 * length;
    let radius = tool.nodes.sphere().map_or(own, |other| own * other / (own + other));
    (Touch { overlap: 0.0, radius, length, depth: own }, length.powi(skin.facets.axes as i32 - 1))
}

impl<'a> PressPass<'a> {
    /// Data common to the points of a patch on a tool in a step of `dt`, s.
    pub fn new(
        interaction: &'a Interaction,
        patch: &'a Patch,
        sides: &'a ContactSides,
        tool: &'a RigidBody,
        dt: f64,
    ) -> Self {
        let (touch, usual) = touch_of(&patch.skin, tool);
        Self { interaction, patch, sides, tool, touch, usual, dt }
    }

    /// The spring of a point with that geometry that represents an area, m2 (m).
    #[inline]
    pub fn spring(&self, seen: &ToolView, area: f64, extremes: &mut Extremes) -> Spring {
        let touch = Touch { overlap: -seen.distance, ..self.touch };
        let spring = self.interaction.spring(&touch, area / self.usual, seen.approach, self.dt);
        extremes.stiffest.add(&Maximum(spring.stiffness / area));
        spring
    }

    /// Position of the tool relative to a place that moves at `velocity`, m/s.
    pub fn look(&self, x: DVec3, velocity: DVec3) -> ToolView {
        let nearest = self.sides.closest(x, self.tool);
        let x = self.sides.near(x, self.tool);
        let normal = self.tool.state.rotation * nearest.normal;
        let approach = (self.tool.velocity_at(x) - velocity).dot(normal);
        ToolView { distance: nearest.signed_distance, normal, approach }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn facets_behind_a_smooth_tool_have_few_points() {
        let places = [DVec3::ZERO, DVec3::X, DVec3::Z];
        let of = |distances: [f64; 3], last: DVec3| {
            let seen = |distance: f64, normal: DVec3| ToolView { distance, normal, approach: 0.0 };
            let [a, b, c] = distances;
            FacetPart::of(places, [&seen(a, DVec3::Y), &seen(b, DVec3::Y), &seen(c, last)])
        };
        assert_eq!(of([-0.1, -0.1, -0.1], DVec3::Y), FacetPart::Evenly);
        let tilted = DVec3::new(0.1, 1.0, 0.0).normalize();
        let seen = [0.0, 0.1, 0.0].map(|x| ToolView {
            distance: x * tilted.x / 0.1 - 0.2,
            normal: tilted,
            approach: 0.0,
        });
        assert_eq!(FacetPart::of([DVec3::ZERO, DVec3::X, DVec3::Z], seen.each_ref()), FacetPart::Flat);
        assert_eq!(of([-0.1, -0.2, -0.1], DVec3::Y), FacetPart::Wholly);
        assert_eq!(of([-0.1, -0.1, -0.1], DVec3::new(0.0, 0.95, 0.31)), FacetPart::Wholly);
        assert_eq!(of([-0.1, -0.1, -0.1], DVec3::X), FacetPart::Partly);
        assert_eq!(of([-0.1, -0.2, 0.1], DVec3::Y), FacetPart::Partly);
        assert_eq!(of([0.5, 0.5, 0.5], DVec3::Y), FacetPart::Partly);
        assert_eq!(of([1.0, 1.1, 1.2], DVec3::Y), FacetPart::No(1.0 - BEYOND * 2f64.sqrt()));
    }
}
