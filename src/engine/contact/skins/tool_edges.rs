//! Edges, corners and round parts of a tool that are finer than the points of a skin see.
//!
//! Whether an edge is thin follows from the deepest place in the tool near it. Of wedges and whatever is
//! thicker than a spacing the points of the skin hold the sides, and points of the edge would be too strong.

use glam::DVec3;

use crate::contact::bodies::ContactSides;
use crate::parallel::for_each_block;
use crate::rigid::{RigidBody, Round};

/// Depth of the deepest place in the tool near an edge, over the spacing of the skin, up to which the edge
/// has its whole weight, and from which on it has none: plates of 0.6 and 0.9 spacings.
const THIN: [f64; 2] = [0.3, 0.45];
/// How near that is, over the spacing.
const NEAR: f64 = 2.0;
/// Part of a ball about an edge in the tool, over that of a right angle, up to which the edge is sharp: 70
/// degrees; radius of the ball over the spacing, in the plane, and in space, where it ends before the corner.
const SHARP: f64 = 7.0 / 9.0;
const AROUND: [f64; 2] = [0.5, 0.25];
/// Distance of points along an edge, over the spacing of the skin.
const STEP: f64 = 0.5;
/// Samples along the diameter of a ball where the deepest place is looked for, and where its part in the tool
/// is measured; in the plane, and in space.
const TO_FIND: [usize; 2] = [32, 16];
const TO_MEASURE: [usize; 2] = [32, 8];
/// From one sample to the next: the first ones are all over the ball. Odd, so that each has its turn.
const STRIDE: usize = 197;

/// A point of an edge, or the middle of a thin round body or of a circle on it.
pub(super) struct Tip {
    /// In the reference configuration of the tool, m.
    pub point: DVec3,
    pub round: Round,
    /// Length (area) of the facets that it stands for, m (m2); zero where the skin resolves the tool.
    pub area: f64,
    /// Whether it is of a sharp or thin edge, which particles do not part before.
    pub is_sharp: bool,
}

/// A tool beside a skin of that spacing, m, in two or three dimensions.
struct BesideSkin<'a> {
    tool: &'a RigidBody,
    sides: &'a ContactSides,
    spacing: f64,
    axes: usize,
}

/// The points of a tool that a skin of that spacing, m, does not resolve, and those of sharp edges.
pub(super) fn tips_of(tool: &RigidBody, sides: &ContactSides, spacing: f64, axes: usize) -> Vec<Tip> {
    let mut tips = places(tool, spacing, axes);
    let beside = BesideSkin { tool, sides, spacing, axes };
    for_each_block(&mut tips[..], &mut Vec::new(), &|_, tips: &mut [Tip]| {
        for tip in tips {
            let thin = (THIN[1] - beside.deepest(tip.point)) / (THIN[1] - THIN[0]);
            tip.area = thin.clamp(0.0, 1.0) * spacing.powi(axes as i32 - 1);
            tip.is_sharp = tip.is_sharp && beside.is_sharp(tip.point);
        }
    });
    tips.retain(|tip| tip.area > 0.0 || tip.is_sharp);
    share_out(&mut tips, spacing);
    tips
}

/// The places to look at; edges may be sharp.
fn places(tool: &RigidBody, spacing: f64, axes: usize) -> Vec<Tip> {
    let at = |point: DVec3, round: Round, is_sharp: bool| Tip { point, round, area: 0.0, is_sharp };
    let thin = tool.nodes.list().iter().filter(|node| node.radius() > 0.0 && node.radius() < spacing);
    let mut tips: Vec<Tip> = thin.map(|node| at(node.point, node.round, false)).collect();
    let edges = tool.surface.edges(spacing);
    for [a, b] in edges.iter().filter(|[a, b]| a != b) {
        let parts = (a.distance(*b) / (STEP * spacing)).ceil() as usize;
        let middle = |part: usize| a.lerp(*b, (part as f64 + 0.5) / parts as f64);
        tips.extend((0..parts).map(|part| at(middle(part), Round::Point, true)));
    }
    let mut corners: Vec<DVec3> = edges.into_iter().flatten().collect();
    corners.sort_by(|a, b| a.to_array().partial_cmp(&b.to_array()).unwrap_or(std::cmp::Ordering::Equal));
    corners.dedup();
    // In the plane corners are the edges.
    tips.extend(corners.into_iter().map(|corner| at(corner, Round::Point, axes == 2)));
    tips
}

impl BesideSkin<'_> {
    /// Depth of the deepest place in the tool near a point of it, over the spacing, if it is below that from
    /// which on edges have no weight.
    fn deepest(&self, x: DVec3) -> f64 {
        let limit = THIN[1] * self.spacing;
        let mut deepest = self.depth(x).max(0.0);
        // From a sample on away from the surface, by half of the distance of samples, and half of that twice.
        let half = NEAR * self.spacing / TO_FIND[self.axes - 2] as f64;
        self.in_ball(NEAR, TO_FIND, &mut |arm| {
            let mut at = x + arm;
            for step in [half, 0.5 * half, 0.25 * half, 0.0] {
                let seen = self.sides.closest_at_start(at, self.tool);
                deepest = deepest.max(-seen.signed_distance);
                if step - seen.signed_distance <= deepest || deepest >= limit {
                    break;
                }
                at -= step * seen.normal;
            }
            deepest < limit
        });
        deepest / self.spacing
    }

    /// Whether the tool fills so little of a ball about a place on an edge.
    fn is_sharp(&self, x: DVec3) -> bool {
        let (mut inside, mut all) = (0, 0);
        self.in_ball(AROUND[self.axes - 2], TO_MEASURE, &mut |arm| {
            all += 1;
            inside += i32::from(self.depth(x + arm) > 0.0);
            true
        });
        4.0 * f64::from(inside) < SHARP * f64::from(all)
    }

    /// How deep a place is in the tool, m; all is found as it is at the start, so that a resumed run has the
    /// same points.
    fn depth(&self, x: DVec3) -> f64 {
        -self.sides.closest_at_start(x, self.tool).signed_distance
    }

    /// Calls `f` with the samples of a ball, m, whose radius over the spacing is given, as long as it goes
    /// on.
    fn in_ball(&self, radius: f64, samples: [usize; 2], f: &mut dyn FnMut(DVec3) -> bool) {
        let (radius, count) = (radius * self.spacing, samples[self.axes - 2]);
        let at = |k: usize| radius * ((2 * k + 1) as f64 / count as f64 - 1.0);
        let total = count.pow(self.axes as u32);
        let arms = (0..total).map(|turn| {
            let number = turn * STRIDE % total;
            let z = if self.axes == 2 { 0.0 } else { at(number / (count * count)) };
            DVec3::new(at(number % count), at(number / count % count), z)
        });
        arms.filter(|arm| arm.length() < radius).all(f);
    }
}

/// Divides the area among points closer to each other than a spacing.
fn share_out(tips: &mut [Tip], spacing: f64) {
    let mut thin: Vec<&mut Tip> = tips.iter_mut().filter(|tip| tip.area > 0.0).collect();
    let near = |a: &Tip, b: &Tip| (1.0 - a.point.distance(b.point) / spacing).max(0.0);
    let count = |tip: &Tip| thin.iter().map(|other| near(tip, other)).sum();
    let counts: Vec<f64> = thin.iter().map(|tip| count(tip)).collect();
    thin.iter_mut().zip(counts).for_each(|(tip, count)| tip.area /= count);
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::assembly::build;
    use crate::contact::bodies::{NodeTurn, SideNodes};
    use crate::neighbors::Periodic;
    use crate::plugin::Registry;
    use crate::rigid::RigidBodies;
    use crate::scene::{Source, parse};
    use crate::world::BodyId;

    /// Sum of the areas of a tool beside a skin with a spacing of 1, and how many points are of sharp edges.
    fn areas_and_sharp(axes: usize, shape: &str) -> (f64, usize) {
        let dimension = ["Two", "Three"][axes - 2];
        let text = format!(
            r#"(dimension: {dimension}, materials: {{"steel": Steel}},
                bodies: [(name: "tool", material: "steel", shape: {shape}, spacing: 0.1, formulation: Rigid())],
                conditions: [Fix(on: Select(body: "tool"))], time: (end: 1.0))"#
        );
        let (scene, source) = parse(Source::new("tool.ron", &text)).unwrap_or_else(|e| panic!("{e}"));
        let sim = build(&scene, &source, &Registry::standard()).unwrap_or_else(|e| panic!("{e}"));
        let bodies = sim.resources().get::<RigidBodies>();
        let sides = ContactSides {
            first: BodyId(0),
            nodes: SideNodes::Rigid,
            second: BodyId(0),
            turn: NodeTurn::Alone,
            periodic: Periodic::NONE,
            seams: Vec::new(),
        };
        let tips = tips_of(&bodies[0], &sides, 1.0, axes);
        let is_sharp = |tip: &&Tip| tip.is_sharp;
        (tips.iter().map(|tip| tip.area).sum(), tips.iter().filter(is_sharp).count())
    }

    #[test]
    fn what_is_a_spacing_thick_has_no_points_that_press() {
        for (axes, shape) in [
            (2, "Box(min: (0, 0), max: (1, 4))"),
            (2, "Sphere(center: (0, 0), radius: 0.5)"),
            (2, "Rotate(shape: Polygon(points: [(0, 0), (4, 4), (0, 8), (-4, 4)]), angle_degrees: 33)"),
            (3, "Rotate(shape: Box(min: (0, 0, 0), max: (1, 2, 2)), axis: (1, 2, 3), angle_degrees: 33)"),
            (3, "Sphere(center: (0, 0, 0), radius: 0.5)"),
            (3, "Cylinder(from: (0, 0, 0), to: (0, 0, 2), radius: 0.55)"),
        ] {
            assert_eq!(areas_and_sharp(axes, shape), (0.0, 0), "{shape}");
        }
    }

    #[test]
    fn thin_parts_stand_for_a_spacing() {
        // The two corners of each end, 0.2 apart, count as 1.8 points.
        let (area, _) = areas_and_sharp(2, "Box(min: (0, 0), max: (0.2, 4))");
        assert!((area - 2.0 * 2.0 / 1.8).abs() < 1e-12, "{area}");
        let (area, _) = areas_and_sharp(2, "Sphere(center: (0, 0), radius: 0.1)");
        assert!((area - 1.0).abs() < 1e-12, "{area}");
        // Half of the weight at three quarters of a spacing.
        let (area, _) = areas_and_sharp(2, "Sphere(center: (0, 0), radius: 0.375)");
        assert!((area - 0.5).abs() < 0.1, "{area}");
    }

    #[test]
    fn edges_of_less_than_seventy_degrees_are_sharp() {
        let wedge = |half_degrees: f64, turn: f64| {
            let x = 4.0 * half_degrees.to_radians().tan();
            format!("Rotate(shape: Polygon(points: [(0, 0), ({x}, 4), (-{x}, 4)]), angle_degrees: {turn})")
        };
        for turn in [0.0, 20.0, 33.0] {
            assert_eq!(areas_and_sharp(2, &wedge(32.0, turn)).1, 3, "the others have 58 degrees");
            assert_eq!(areas_and_sharp(2, &wedge(38.0, turn)).1, 2, "the others have 52 degrees");
        }
        let prism = "Extrusion(polygon: [(0, 0), (2, 4), (-2, 4)], from: 0, to: 2)";
        for turn in [0.0, 20.0, 33.0] {
            let turned = format!("Rotate(shape: {prism}, axis: (1, 2, 3), angle_degrees: {turn})");
            let (area, sharp) = areas_and_sharp(3, &turned);
            // 53 and two times 63 degrees; four points along two units, and some near the corners.
            assert!(area == 0.0 && (12..30).contains(&sharp), "{turn}: {area}, {sharp}");
        }
    }
}
