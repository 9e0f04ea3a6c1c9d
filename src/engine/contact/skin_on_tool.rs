//! Contact of the skin of a deformable body with the exact surface of a rigid one.
//!
//! The energy is the integral of that of the law over the skin, by points with areas of the reference configuration; the overlap is the exact distance of
//! a point from the surface. Both bodies are pushed at the point itself. The points stand so close that a curved tool does not feel them.

use std::sync::Arc;

use glam::DVec3;

use super::law::Touch;
use super::least::Least;
use super::meetings::Meetings;
use super::memory::{Memory, PairKey};
use super::pace::Pace;
use super::response::{Interaction, Meeting};
use super::sides::Sides;
use super::skin_near::NearTool;
use super::stiffness;
use super::tally::Tally;
use crate::parallel::{BlockSum, Largest, for_each_block, sum_over_blocks};
use crate::rigid::{RigidBodies, RigidBody, Wrench};
use crate::schedule::{Step, StepError};
use crate::skins::{Patch, Rule, Skin, SkinColumns, Vertex, Wanted};
use crate::world::BodyId;

/// No point of a facet is farther from its nearest vertex than that share of its longest side.
const BEYOND: f64 = 0.6;
/// Parts of a segment of half a spacing, and rows of a triangle of a spacing, each with a point.
const PARTS: [usize; 2] = [8, 2];

/// Contact of a skin with a rigid body.
pub(super) struct SkinOnTool {
    interaction: Interaction,
    pub patch: Patch,
    pub tool: BodyId,
    /// The particles and the surface, which must not overlap at the start.
    pub sides: Sides,
    rule: Rule,
    near: NearTool,
    candidates: Vec<PairKey>,
    /// Of every vertex of the patch its distance from the tool, m.
    distances: Vec<f64>,
    pub meetings: Meetings<Meet, Push, Least>,
}

/// A point of the skin that touches.
#[derive(Clone, Copy, Default)]
pub(super) struct Meet {
    /// Where it is, m.
    x: DVec3,
    /// Outward normal of the tool there.
    normal: DVec3,
    /// How deep it is in the tool, m.
    overlap: f64,
}

/// What a point does.
#[derive(Clone, Copy, Default)]
pub(super) struct Push {
    /// Where, m.
    x: DVec3,
    /// Force on the skin, N.
    force: DVec3,
    /// Stiffness over the area, N/m3 (N/m2 in two dimensions), and times the inverse mass of the tool, 1/s2.
    stiffness: f64,
    of_tool: f64,
}

/// The sums over all points that touch.
#[derive(Clone, Copy, Default)]
struct Sums {
    on_tool: Wrench,
    stiffest: Largest,
    of_tool: f64,
}

impl BlockSum for Sums {
    fn add(&mut self, next: &Self) {
        self.on_tool.add(&next.on_tool);
        self.stiffest.add(&next.stiffest);
        self.of_tool += next.of_tool;
    }
}

impl SkinOnTool {
    /// Contact of a skin with the surface of a rigid body.
    pub fn new(interaction: Interaction, skin: Arc<Skin>, sides: Sides) -> Self {
        let axes = skin.facets.axes;
        let rule = Rule::fine(axes, PARTS[axes - 2]);
        let points = rule.len() * skin.facets.corners.len();
        let (near, tool) = (NearTool::new(&skin), sides.second);
        let (patch, candidates, mut meetings) =
            (Patch::new(skin), Vec::with_capacity(points), Meetings::default());
        meetings.reserve(points);
        let distances = Vec::with_capacity(patch.skin.vertices());
        Self { interaction, patch, tool, sides, rule, near, candidates, distances, meetings }
    }

    /// Works out the forces of all points that touch, and pushes the rigid body.
    pub fn run(&mut self, step: &mut Step<'_>, paces: [Pace; 2]) -> Result<Tally, StepError> {
        let shared = step.resources.get::<RigidBodies>().clone();
        let mut bodies = shared.lock();
        let missing =
            || StepError::System { system: super::CONTACT.to_owned(), message: "no rigid body".into() };
        let tool = bodies.iter_mut().find(|body| body.id == self.tool).ok_or_else(missing)?;
        let dt = step.clock.dt;
        let skin = Arc::clone(&self.patch.skin);
        let columns = SkinColumns::new(&skin, step.world)?;
        let view = columns.view();
        let speeds = [paces[0].speed, paces[1].speed];
        if self.near.is_old(speeds, dt) {
            self.near.find(&skin, &view, tool);
            let facets = &self.near.facets;
            self.patch.select(facets.iter().copied());
            let count = self.rule.len() as u32;
            self.candidates.clear();
            let points = facets.iter().flat_map(|facet| (0..count).map(move |k| (facet * count + k, 0)));
            self.candidates.extend(points);
        }
        let wanted = if self.interaction.is_elastic() { Wanted::Places } else { Wanted::Mobility };
        self.patch.update(&view, dt, wanted);
        let gap = self.find(tool);
        let tally = self.evaluate(tool, dt);
        let Sums { on_tool, mut stiffest, of_tool } = self.push(tool);
        stiffest.add(&Largest(self.expected(tool, gap, speeds[0] + speeds[1], dt)));
        tool.push(&on_tool);
        self.patch.hand_on();
        let squared = stiffness::OF_SKIN * stiffest.0 * skin.lightness + of_tool;
        stiffness::propose(step, (skin.body, self.tool), squared, speeds[0] + speeds[1], skin.spacing);
        Ok(tally)
    }

    /// The law at an overlap of zero.
    fn touch(&self, tool: &RigidBody) -> Touch {
        let length = self.patch.skin.spacing;
        let own = 0.5 * length;
        let radius = tool.nodes.sphere().map_or(own, |other| own * other / (own + other));
        Touch { overlap: 0.0, radius, length, depth: own }
    }

    /// The stiffness over the area that a touch may soon have, N/m3 (N/m2 in two dimensions).
    fn expected(&self, tool: &RigidBody, gap: f64, speed: f64, dt: f64) -> f64 {
        let touch = self.touch(tool);
        let usual = touch.length.powi(self.patch.skin.facets.axes as i32 - 1);
        stiffness::expected(&*self.interaction.law, &touch, gap, speed, dt) / usual
    }

    /// Finds the points that touch; returns the least gap of the others, m.
    fn find(&mut self, tool: &RigidBody) -> f64 {
        let Self { patch, rule, meetings, candidates, distances, .. } = self;
        let count = rule.len();
        distances.resize(patch.vertices().len(), 0.0);
        let rows = (&mut distances[..], patch.vertices());
        for_each_block(rows, &mut Vec::new(), &|_, (distances, vertices): (&mut [f64], &[Vertex])| {
            for (distance, vertex) in distances.iter_mut().zip(vertices) {
                *distance = tool.surface.closest(tool.reference(vertex.place)).signed_distance;
            }
        });
        let gap = meetings.find(candidates, |(point, _), gap: &mut Least| {
            let (facet, point) = (point / count as u32, point as usize % count);
            let [a, b, c] = patch.numbers(facet).map(|vertex| distances[vertex]);
            let corners = patch.corners(facet);
            let [p, q, r] = corners.map(|corner| corner.place);
            let size = p.distance_squared(q).max(q.distance_squared(r)).max(r.distance_squared(p)).sqrt();
            let least = a.min(b).min(c) - BEYOND * size;
            if least >= 0.0 {
                gap.add(&Least(least));
                return None;
            }
            let shares = rule.shares(point);
            let x =
                shares[0] * corners[0].place + shares[1] * corners[1].place + shares[2] * corners[2].place;
            let nearest = tool.surface.closest(tool.reference(x));
            if !corners.iter().all(|corner| corner.is_there) {
                return None;
            }
            if nearest.signed_distance >= 0.0 {
                gap.add(&Least(nearest.signed_distance));
            }
            (nearest.signed_distance < 0.0).then(|| Meet {
                x,
                normal: tool.state.rotation * nearest.normal,
                overlap: -nearest.signed_distance,
            })
        });
        gap.0
    }

    /// Works out what every point does.
    fn evaluate(&mut self, tool: &RigidBody, dt: f64) -> Tally {
        let usual_touch = self.touch(tool);
        let Self { interaction, patch, rule, meetings, .. } = self;
        let (patch, rule) = (&*patch, &*rule);
        let skin = &patch.skin;
        let (length, count) = (skin.spacing, rule.len());
        let usual = length.powi(skin.facets.axes as i32 - 1);
        let at = |point: u32| {
            let facet = point / count as u32;
            (facet, patch.corners(facet), rule.shares(point as usize % count))
        };
        let velocity = |key: PairKey| {
            let (_, corners, shares) = at(key.0);
            (0..3).map(|k| shares[k] * corners[k].velocity).sum::<DVec3>()
        };
        let respond = |key: PairKey, meet: &Meet, before: &Memory, tally: &mut Tally| {
            let (facet, corners, shares) = at(key.0);
            let Meet { x, normal, overlap } = *meet;
            let velocity = velocity(key) - tool.velocity_at(x);
            if !before.is_elastic() {
                tally.losses.add_work(1.0, before, velocity, dt);
            }
            let area = skin.measure[facet as usize] / count as f64;
            let mobility = (0..3).map(|k| shares[k] * corners[k].mobility).sum::<DVec3>() / area;
            let meeting = Meeting {
                touch: Touch { overlap, ..usual_touch },
                normal,
                scale: 1.0,
                area: area / usual,
                arms: [DVec3::ZERO; 2],
                velocity,
            };
            let inverse_mass = |n: DVec3| mobility.dot(n * n) + tool.inverse_mass_at(x, n);
            let response = interaction.respond(&meeting, inverse_mass, dt, before);
            tally.losses.add_work(1.0, &response.memory, velocity, dt);
            tally.losses.keep(1.0, before, &response.memory);
            tally.stored += response.spring.energy + response.memory.energy();
            let stiffness = response.spring.stiffness;
            let of_tool = stiffness * tool.inverse_mass_at(x, normal);
            (response.memory, Push { x, force: response.force, stiffness: stiffness / area, of_tool })
        };
        let end = |key: PairKey, memory: &Memory, tally: &mut Tally| {
            let (_, corners, shares) = at(key.0);
            let x = (0..3).map(|k| shares[k] * corners[k].place).sum::<DVec3>();
            tally.losses.add_work(1.0, memory, velocity(key) - tool.velocity_at(x), dt);
            tally.losses.keep(1.0, memory, &Memory::default());
        };
        meetings.respond(respond, end)
    }

    /// Pushes the vertices; returns what is on the tool about its centre, and the stiffness.
    fn push(&mut self, tool: &RigidBody) -> Sums {
        let Self { patch, rule, meetings, .. } = self;
        let count = rule.len();
        for (((point, _), _), push) in meetings.met().iter().zip(meetings.pushes()) {
            let shares = rule.shares(*point as usize % count);
            patch.push(point / count as u32, shares, push.force, None);
        }
        sum_over_blocks(meetings.pushes(), &|_, pushes: &[Push]| {
            let mut sums = Sums::default();
            for Push { x, force, stiffness, of_tool } in pushes {
                sums.on_tool.push(*x - tool.state.center, -*force);
                sums.stiffest.add(&Largest(*stiffness));
                sums.of_tool += of_tool;
            }
            sums
        })
    }
}
