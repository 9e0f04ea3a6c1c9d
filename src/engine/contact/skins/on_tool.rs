//! Contact of the skin of a deformable body with the exact surface of a rigid one.
//!
//! The energy is the integral of the law's energy over the skin, by points with areas of the reference
//! configuration; the overlap is the exact distance of a point from the surface. `skin_points` places the
//! points; `tips` adds those of what is finer than they are. Forces act on both bodies at the vertices of the
//! skin, summed from the points around each; dashpot and friction belong to vertices as well.

use std::sync::Arc;

use glam::DVec3;

use super::near_tool::NearTool;
use super::points::{Extremes, FacetPart, Points, PressPass, ToolView, VertexPress, touch_of};
use super::tips::Tips;
use crate::contact::active::ActiveContacts;
use crate::contact::bodies::{ContactSides, MotionBounds, failed};
use crate::contact::laws::Touch;
use crate::contact::response::time_step::{self, OfSkins, Touches};
use crate::contact::response::{ContactEnergy, ContactState, History, Interaction, Losses, PairKey};
use crate::notation::quantity;
use crate::parallel::{BlockSum, for_each_block, sum_over_blocks};
use crate::rigid::{RigidBodies, RigidBody, Wrench};
use crate::schedule::{Step, StepError};
use crate::skins::{Patch, Skin, SkinColumns, Vertex, Wanted};
use crate::world::{BodyId, sum_by_row};

/// Contact of a skin with a rigid body.
pub(in crate::contact) struct SkinOnTool {
    interaction: Interaction,
    pub patch: Patch,
    pub tool: BodyId,
    /// The particles and the surface, which must not overlap at the start.
    pub sides: ContactSides,
    points: Points,
    near: NearTool,
    tips: Tips,
    /// Position of the tool relative to every vertex of the patch, and the points of every facet near it that
    /// may touch.
    seen: Vec<ToolView>,
    reached: Vec<FacetPart>,
    /// Forces on the vertices of every facet near the tool, and on every vertex of the patch.
    on_facets: Vec<[VertexPress; 3]>,
    pressed: Vec<VertexPress>,
    /// Of every vertex of the patch the area of even facets that is its own, m2 (m).
    even: Vec<f64>,
    /// Vertices that touch, with their numbers in the patch, and what dashpot and friction add there, N.
    touching: Vec<PairKey>,
    /// Whether the user has been warned of a sharp edge.
    pub told: bool,
    pub contacts: ActiveContacts<u32, VertexFriction, ()>,
}

/// Force of dashpot and friction at a vertex, N, and heat of friction, J.
#[derive(Clone, Copy, Default)]
pub(in crate::contact) struct VertexFriction {
    force: DVec3,
    heat: f64,
}

/// The sums over all vertices that touch.
#[derive(Clone, Copy, Default)]
struct ToolSums {
    on_tool: Wrench,
    of_tool: f64,
    stored: f64,
    power: f64,
}

impl BlockSum for ToolSums {
    fn add(&mut self, next: &Self) {
        self.on_tool.add(&next.on_tool);
        self.of_tool += next.of_tool;
        self.stored += next.stored;
        self.power += next.power;
    }
}

impl SkinOnTool {
    /// Contact of a skin with the surface of a rigid body.
    pub fn new(interaction: Interaction, skin: Arc<Skin>, sides: ContactSides) -> Self {
        let (vertices, facets) = (skin.vertices(), skin.facets.corners.len());
        let mut contacts = ActiveContacts::default();
        if !interaction.is_elastic() {
            contacts.reserve(vertices);
        }
        Self {
            interaction,
            tool: sides.second,
            sides,
            points: Points::new(skin.facets.axes),
            near: NearTool::new(&skin),
            tips: Tips::default(),
            seen: Vec::with_capacity(vertices),
            reached: Vec::with_capacity(facets),
            on_facets: Vec::with_capacity(facets),
            pressed: Vec::with_capacity(vertices),
            even: Vec::with_capacity(vertices),
            touching: Vec::with_capacity(vertices),
            told: false,
            patch: Patch::new(skin),
            contacts,
        }
    }

    /// Whether nothing touches and no facets are near the tool.
    pub fn is_idle(&self) -> bool {
        self.near.facets.is_empty() && self.contacts.histories.is_empty()
    }

    /// Has all facets searched again.
    pub fn forget(&mut self) {
        self.near.forget();
    }

    /// Computes the forces of all points that touch, and pushes the rigid body.
    pub fn run(
        &mut self,
        step: &mut Step<'_>,
        motion: [MotionBounds; 2],
    ) -> Result<ContactEnergy, StepError> {
        let (energies, on_tool) = self.evaluate(step, motion)?;
        let mut bodies = step.resources.get_mut::<RigidBodies>();
        let tool = bodies.of_mut(self.tool);
        tool.into_iter().for_each(|tool| tool.push(&on_tool));
        Ok(energies)
    }

    /// Computes the forces of all points in contact, and their sum on the rigid body about its centre.
    pub fn evaluate(
        &mut self,
        step: &mut Step<'_>,
        motion: [MotionBounds; 2],
    ) -> Result<(ContactEnergy, Wrench), StepError> {
        let resources = step.resources;
        let bodies = resources.get::<RigidBodies>();
        let missing = || failed("no rigid body");
        let tool = bodies.of(self.tool).ok_or_else(missing)?;
        let dt = step.clock.dt;
        let skin = Arc::clone(&self.patch.skin);
        let columns = SkinColumns::new(&skin, step.world)?;
        let view = columns.view();
        let speeds = MotionBounds::speeds(motion);
        if self.near.is_old(speeds, dt) {
            self.near.find(&skin, &view, &self.sides, tool);
            self.patch.select(self.near.facets.iter().copied());
        }
        let wanted = Wanted { mobility: self.interaction.damping_ratio > 0.0, gradients: false };
        self.patch.update(&view, dt, wanted);
        let reach = OfSkins::reach(speeds[0] + speeds[1], dt, skin.spacing);
        let Extremes { gap, stiffest, landing, is_split } = self.press(tool, reach, dt);
        let mut energies = if self.interaction.is_elastic() {
            ContactEnergy::default()
        } else {
            self.add_friction(tool, dt)
        };
        let ToolSums { on_tool, of_tool, stored, power } = self.push(tool);
        energies.stored += stored;
        energies.ahead += 0.5 * dt * power;
        self.patch.transfer_forces();
        let (touch, usual) = touch_of(&skin, tool);
        let (law, speed) = (&*self.interaction.law, speeds[0] + speeds[1]);
        let (stiffest, gap) = (stiffest.0, gap.0);
        let keeps_reference = time_step::keeps_reference(step, skin.body);
        let of_skins = OfSkins { law, touch, usual, stiffest, gap, speed, dt, keeps_reference };
        let of_touching = of_skins.stiffness() * skin.lightness + of_tool;
        let squared = of_touching.max(of_skins.of_landing_tool(landing));
        let touches = Touches { squared, stored: energies.stored, speed, reach: skin.spacing };
        time_step::propose(step, [skin.body, self.tool], &touches)?;
        if is_split && !std::mem::replace(&mut self.told, true) {
            self.warn_of_edge(step);
        }
        Ok((energies, on_tool))
    }

    /// Warns of a sharp edge that has been pressed into the body.
    fn warn_of_edge(&self, step: &mut Step<'_>) {
        let [body, tool] = [self.patch.skin.body, self.tool].map(|id| &step.world.body(id).name[..]);
        let time = quantity(step.clock.time, "s");
        step.warnings.push(format!(
            "an edge of `{tool}`, sharper than 70 degrees or thin, is pressed into `{body}` at {time}: particles do not part before it, and its \
             force may be off by half while it is less than some ten spacings deep; round the edge to some spacings, or take \
             smaller particles in `{body}`"
        ));
    }

    /// Computes what presses on the vertices; what is nearer than `reach`, m, may soon.
    fn press(&mut self, tool: &RigidBody, reach: f64, dt: f64) -> Extremes {
        self.look(tool, dt);
        let mut extremes = self.press_facets(tool, reach, dt);
        self.gather();
        extremes.add(&self.press_tips(tool, reach, dt));
        extremes.add(&self.press_vertices(tool, dt));
        extremes
    }

    /// Computes the position of the tool relative to the vertices.
    fn look(&mut self, tool: &RigidBody, dt: f64) {
        let Self { interaction, patch, sides, seen, .. } = self;
        let (on, vertices) = (PressPass::new(interaction, patch, sides, tool, dt), patch.vertices());
        seen.resize(vertices.len(), ToolView::default());
        let rows = (&mut seen[..], vertices);
        for_each_block(rows, &mut Vec::new(), &|_, (seen, vertices): (&mut [ToolView], &[Vertex])| {
            for (seen, vertex) in seen.iter_mut().zip(vertices) {
                *seen = on.look(vertex.place, vertex.velocity);
            }
        });
    }

    /// Computes the contact forces of the points of every facet near the tool on its vertices.
    fn press_facets(&mut self, tool: &RigidBody, reach: f64, dt: f64) -> Extremes {
        let Self { interaction, patch, sides, points, near, seen, reached, on_facets, .. } = self;
        let (patch, points, seen) = (&*patch, &*points, &*seen);
        let on = PressPass::new(interaction, patch, sides, tool, dt);
        reached.resize(near.facets.len(), FacetPart::Partly);
        on_facets.resize(near.facets.len(), Default::default());
        let rows = (&near.facets[..], &mut reached[..], &mut on_facets[..]);
        type Rows<'a> = (&'a [u32], &'a mut [FacetPart], &'a mut [[VertexPress; 3]]);
        sum_over_blocks(rows, &|_, (facets, reached, on_facets): Rows<'_>| {
            let mut extremes = Extremes::default();
            for ((&facet, reached), on_facet) in facets.iter().zip(reached).zip(on_facets) {
                let corners = patch.corners(facet);
                let [a, b, c] = patch.numbers(facet);
                let seen = [&seen[a], &seen[b], &seen[c]];
                let [a, b, c] = corners;
                *reached = if a.is_there && b.is_there && c.is_there {
                    FacetPart::of([a.place, b.place, c.place], seen)
                } else {
                    FacetPart::No(f64::INFINITY)
                };
                let touches_soon = match *reached {
                    FacetPart::No(distance) => {
                        extremes.gap.add_length(distance);
                        distance < reach
                    }
                    FacetPart::Evenly => false,
                    reached => {
                        *on_facet = points.press(&on, facet, reached, seen, &mut extremes);
                        on_facet.iter().all(|press| press.area == 0.0)
                    }
                };
                if touches_soon && !tool.is_driven() {
                    let mobility = tool.inverse_mass_at(on.sides.near(a.place, tool), seen[0].normal);
                    extremes.landing += patch.skin.measure[facet as usize] * mobility;
                }
            }
            extremes
        })
    }

    /// Sums the forces of the facets on every vertex, and its share of the area of even facets.
    fn gather(&mut self) {
        let Self { patch, near, reached, on_facets, pressed, even, .. } = self;
        let (axes, vertices) = (patch.skin.facets.axes, patch.vertices().len());
        pressed.clear();
        pressed.resize(vertices, VertexPress::default());
        even.clear();
        even.resize(vertices, 0.0);
        for ((&facet, reached), on) in near.facets.iter().zip(&*reached).zip(&*on_facets) {
            let numbers = patch.numbers(facet);
            let part = patch.skin.measure[facet as usize] / axes as f64;
            match reached {
                FacetPart::No(_) => {}
                FacetPart::Evenly => numbers[..axes].iter().for_each(|&number| even[number] += part),
                _ => numbers[..axes].iter().zip(on).for_each(|(&number, on)| pressed[number].join(on)),
            }
        }
    }

    /// Adds the forces of sharp edges and tips of the tool to the vertices.
    fn press_tips(&mut self, tool: &RigidBody, reach: f64, dt: f64) -> Extremes {
        let Self { interaction, patch, sides, near, tips, pressed, .. } = self;
        tips.press(&PressPass::new(interaction, patch, sides, tool, dt), &near.facets, reach, pressed)
    }

    /// Adds the forces of the areas of even facets to their vertices.
    fn press_vertices(&mut self, tool: &RigidBody, dt: f64) -> Extremes {
        let Self { interaction, patch, sides, seen, pressed, even, .. } = self;
        let on = PressPass::new(interaction, patch, sides, tool, dt);
        let rows = (&mut pressed[..], &seen[..], &even[..]);
        type Rows<'a> = (&'a mut [VertexPress], &'a [ToolView], &'a [f64]);
        sum_over_blocks(rows, &|_, (pressed, seen, even): Rows<'_>| {
            let mut extremes = Extremes::default();
            for ((pressed, seen), &area) in
                pressed.iter_mut().zip(seen).zip(even).filter(|(_, area)| **area > 0.0)
            {
                pressed.add(1.0, &on.spring(seen, area, &mut extremes), seen.normal, area, -seen.distance);
            }
            extremes
        })
    }

    /// Computes dashpot and friction at the vertices that are pressed.
    fn add_friction(&mut self, tool: &RigidBody, dt: f64) -> ContactEnergy {
        let (usual, _) = touch_of(&self.patch.skin, tool);
        let Self { interaction, patch, sides, pressed, touching, contacts, .. } = self;
        let (patch, pressed) = (&*patch, &*pressed);
        touching.clear();
        let numbers = patch.vertex_numbers().iter().zip(0..);
        touching.extend(
            numbers.filter(|(_, k)| pressed[*k as usize].spring.force > 0.0).map(|(vertex, _)| (*vertex, 0)),
        );
        contacts.find(touching, |(vertex, _), (), (): &mut ()| Some(patch.number(vertex)));
        let place = |vertex: &Vertex| sides.near(vertex.place, tool);
        let velocity = |vertex: &Vertex| vertex.velocity - tool.velocity_at(place(vertex));
        let lag = |vertex: &Vertex| -tool.lag_at(place(vertex), dt);
        // With the arms of the beginning of the step, where the force of the last one acted.
        let at_start = |vertex: &Vertex| velocity(vertex) + 2.0 * lag(vertex);
        let respond = |_: PairKey, number: &u32, before: &History, energies: &mut ContactEnergy| {
            let (vertex, pressed) = (&patch.vertices()[*number as usize], &pressed[*number as usize]);
            let velocity = velocity(vertex);
            let mut losses = Losses::default();
            if !before.is_elastic() {
                losses.add_work(1.0, before, at_start(vertex), dt);
            }
            let normal = pressed.force.normalize_or_zero();
            let state = ContactState {
                touch: Touch { overlap: pressed.depth / pressed.area, ..usual },
                normal,
                scale: 1.0,
                area: 1.0,
                arms: [DVec3::ZERO; 2],
                velocity,
                lag: lag(vertex),
                spin: tool.state.angular_velocity.dot(normal),
                acceleration: DVec3::ZERO,
            };
            let mobility = vertex.mobility / pressed.area;
            let inverse_mass = |n: DVec3| mobility.dot(n * n) + tool.inverse_mass_at(place(vertex), n);
            let response = interaction.beside(pressed.spring, &state, inverse_mass, dt, before);
            losses.add_work(1.0, &response.history, velocity, dt);
            losses.keep(1.0, before, &response.history);
            energies.losses.add(&losses);
            energies.stored += response.history.energy();
            let force = response.force - pressed.spring.force * normal;
            (response.history, VertexFriction { force, heat: losses.friction })
        };
        let end = |(vertex, _): PairKey, history: &History, energies: &mut ContactEnergy| {
            if !history.is_elastic() && patch.has(vertex) {
                energies.losses.add_work(1.0, history, at_start(patch.vertex(vertex)), dt);
            }
            energies.losses.keep(1.0, history, &History::default());
        };
        contacts.respond(patch.skin.vertices(), respond, end)
    }

    /// Adds the forces to the vertices; returns their sum on the tool about its centre.
    fn push(&mut self, tool: &RigidBody) -> ToolSums {
        let Self { interaction, patch, sides, pressed, contacts, .. } = self;
        for ((_, number), beside) in contacts.met().iter().zip(contacts.pushes()) {
            pressed[*number as usize].force += beside.force;
            patch.heat_vertex(*number as usize, interaction.heat[0] * beside.heat);
        }
        for (number, pressed) in pressed.iter().enumerate().filter(|(_, pressed)| pressed.spring.force > 0.0)
        {
            patch.push_vertex(number, pressed.force);
        }
        let (patch, pressed) = (&*patch, &*pressed);
        let of_vertex = |k: usize| {
            let (vertex, VertexPress { force, spring, .. }) = (&patch.vertices()[k], &pressed[k]);
            let mut sums = ToolSums::default();
            if spring.force > 0.0 {
                let place = sides.near(vertex.place, tool);
                sums.on_tool.push(place - tool.state.center, -*force);
                sums.of_tool = spring.stiffness * tool.inverse_mass_at(place, force.normalize_or_zero());
                sums.stored = spring.energy;
                sums.power = force.dot(vertex.velocity - tool.velocity_at(place));
            }
            sums
        };
        let numbers = patch.vertex_numbers();
        sum_by_row(patch.skin.vertices(), numbers.len(), &|k| numbers[k] as usize, &of_vertex)
    }
}
