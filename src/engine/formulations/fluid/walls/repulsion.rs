//! Repulsion of fluid particles that come nearer to the surface of a boundary than a flow puts them.
//!
//! A single particle at a wall has nearly zero pressure, and so has the wall, whose pressure is that of the
//! fluid beside it: nothing would stop the particle, and one that was separated from a fluid, with a density
//! below that at rest, is even attracted. So the distance d of a fluid particle from the shape of the nearest
//! boundary has the energy
//!
//! `k/2 (l_i - d)^2` where `d < l_i`, with `l_i = 0.15 dx - s_i`, `k = m (3 c_0 / h)^2`, where 1/m is the sum
//! of the inverse masses; that of a wall is zero.
//!
//! Particles of a fluid at rest stand half a spacing before a wall. Those that start nearer than the range,
//! where lattices do not fit shapes, lack s_i of it, which falls as soon as they have been farther away, so
//! that it changes no energy. It rises only where the distance jumps, because it is now measured from the
//! sphere of a particle of the body, or no longer is: `l_i - d` stays what it was.
//!
//! This energy does not change when fluid and body move together, so that the opposite force acts on the body
//! at the place of the fluid particle. The particles of the body around that carry it by shares whose centre
//! is there; before an acute edge of a rigid body, where none are around, all of the body does
//! ([`WholeBody`]).

use glam::DVec3;

use super::surface_distance::BoundaryShape;
use crate::formulations::fluid::cloud::{FlowCloud, Group, LoadCarrier, PARTS, Repelled, Role, Shares};
use crate::formulations::fluid::moments::WholeBody;
use crate::parallel::{for_each_block, own_rows};
use crate::plugin::SimBuilder;
use crate::ranks::has_several;
use crate::schedule::{Run, Step, StepError};
use crate::world::Force;

crate::column! {
    /// Shortfall of the range of the repulsion of boundaries for a fluid particle.
    pub struct RangeShortfall(f64) = "range_shortfall", "s", "m";
}
crate::column! {
    /// Whether a fluid particle was last before the sphere of a particle of a boundary: 1 there, 0 before a
    /// shape.
    pub struct BeforeSphere(f64) = "before_sphere", "", "-";
}

/// Range of the repulsion over the spacing of the fluid.
const RANGE: f64 = 0.15;
/// Frequency of a fluid particle at a wall, in units of c_0 / h. The step is at most 0.4 h / c_0.
const FREQUENCY: f64 = 3.0;
/// Distance from the shape of a boundary within which its nearest particle is, over its spacing.
const NEAREST: f64 = 1.2;

/// Finds the particles that are repelled.
pub struct Repulsion {
    surfaces: Vec<BoundaryShape>,
    range: f64,
    /// Particles near boundaries, as rows of the cloud.
    close: Vec<u32>,
    /// Whether a particle may lack of its range or be before a sphere.
    is_short: bool,
}

impl Repulsion {
    /// That of the boundaries of a flow of smoothing length `h`, m, and the distance within which a fluid
    /// particle that is repelled has a boundary particle, m.
    pub fn new(groups: &[Group], h: f64, sim: &SimBuilder<'_>) -> (Self, f64) {
        let fluid = sim.body(groups[0].body);
        let dimension = sim.dimension().count() as i32;
        let mass = |density: f64, spacing: f64| density * spacing.powi(dimension);
        let range = RANGE * fluid.spacing;
        let (mut surfaces, mut widest) = (Vec::new(), 0.0);
        for group in groups {
            let Role::Boundary(boundary) = &group.role else { continue };
            let body = sim.body(group.body);
            let of_boundary =
                if boundary.moved { 1.0 / mass(body.material.density, body.spacing) } else { 0.0 };
            let stiffness = |fluid: &Group| {
                let state = fluid.fluid()?;
                let per_mass = of_boundary + 1.0 / mass(state.density, sim.body(fluid.body).spacing);
                Some((FREQUENCY * state.sound_speed / h).powi(2) / per_mass)
            };
            let stiffness = groups.iter().map_while(stiffness).collect();
            let reach = range + NEAREST * body.spacing;
            widest = f64::max(widest, reach);
            surfaces.push(BoundaryShape::of_any(group, stiffness, reach, sim));
        }
        (Self { surfaces, range, close: Vec::new(), is_short: true }, widest)
    }

    /// Writes down how near particles are to the nearest boundary, and the direction of the repulsion of
    /// those within its range.
    fn measure(&mut self, cloud: &FlowCloud, out: &mut [Repelled], step: &Step<'_>) -> Result<(), StepError> {
        let (range, close) = (self.range, &self.close[..]);
        for surface in &mut self.surfaces {
            surface.notice_failure(step)?;
            surface.look(cloud, step, |seen| {
                let (surface, rows) = (seen.shape, (&mut out[..], close));
                for_each_block(rows, &mut Vec::new(), &|_, (out, close): (&mut [Repelled], &[u32])| {
                    for (out, &i) in out.iter_mut().zip(close) {
                        let i = i as usize;
                        if seen.is_beyond(range, cloud, i) {
                            continue;
                        }
                        let found = seen.place(cloud, i);
                        let Some(place) = found.filter(|place| place.distance < out.distance) else {
                            continue;
                        };
                        let fluid = cloud.groups.iter().position(|group| group.cloud.contains(&i));
                        let stiffness = fluid.map_or(0.0, |fluid| surface.stiffness[fluid]);
                        out.distance = place.distance;
                        out.is_before_sphere = place.is_beside_particle();
                        out.other_distance = place.other_distance;
                        out.boundary = surface.group.cloud.start;
                        if place.distance < range {
                            out.force = stiffness * surface.direction(cloud, &place);
                            out.shares = place.shares;
                        }
                    }
                });
            })?;
        }
        Ok(())
    }

    /// Computes the forces from the distances, particle by particle, and removes zero forces.
    fn compute_forces(
        &mut self,
        cloud: &FlowCloud,
        out: &mut Vec<Repelled>,
        step: &Step<'_>,
    ) -> Result<(), StepError> {
        let is_start = step.clock.step == 0 && step.clock.dt == 0.0;
        let mut is_short = false;
        for group in cloud.groups.iter().filter(|group| group.fluid().is_some()) {
            let view = step.world.phase(group.phase);
            let mut column = view.write_own::<RangeShortfall>()?;
            let shortfall = &mut column[group.rows.clone()];
            let mut column = view.write_own::<BeforeSphere>()?;
            let before_sphere = &mut column[group.rows.clone()];
            // Rows may have been another rank's before.
            if self.is_short || has_several() {
                let own = own_rows(&(0..group.rows.len()));
                let close = &cloud.is_close[group.cloud.clone()][own.clone()];
                let rows = shortfall[own.clone()].iter_mut().zip(&mut before_sphere[own]);
                let far = rows.zip(close).filter(|(_, close)| **close == 0);
                far.for_each(|((short, sphere), _)| (short.0, sphere.0) = (0.0, 0.0));
            }
            for repelled in out.iter_mut().filter(|repelled| group.cloud.contains(&repelled.i)) {
                let row = repelled.i - group.cloud.start;
                let short = &mut shortfall[row].0;
                let sphere = f64::from(repelled.is_before_sphere);
                let jumps = std::mem::replace(&mut before_sphere[row].0, sphere) != sphere;
                let overlap = |distance: f64| (self.range - distance).max(0.0);
                let within = overlap(repelled.distance);
                *short = if is_start {
                    within
                } else if jumps {
                    let before = (overlap(repelled.other_distance) - *short).max(0.0);
                    (within - before).max(0.0)
                } else {
                    short.min(within)
                };
                repelled.force *= within - *short;
                is_short |= *short > 0.0 || repelled.is_before_sphere;
            }
        }
        self.is_short = is_short;
        out.retain(|repelled| repelled.force != DVec3::ZERO);
        Ok(())
    }
}

impl Run for Repulsion {
    fn run(&mut self, step: &mut Step<'_>) -> Result<(), StepError> {
        let mut cloud = step.resources.get_mut::<FlowCloud>();
        let mut repelled = std::mem::take(&mut cloud.repelled);
        let own = cloud.fluids().flat_map(|fluid| own_rows(&fluid));
        self.close.clear();
        self.close.reserve(cloud.fluid);
        self.close.extend(own.filter(|&i| cloud.is_close[i] != 0).map(|i| i as u32));
        let none = Repelled { distance: f64::INFINITY, ..Repelled::default() };
        repelled.clear();
        repelled.reserve(cloud.fluid);
        repelled.extend(self.close.iter().map(|&i| Repelled { i: i as usize, ..none }));
        self.measure(&cloud, &mut repelled, step)?;
        self.compute_forces(&cloud, &mut repelled, step)?;
        Repelled::share(&mut repelled);
        cloud.repelled = repelled;
        Ok(())
    }

    fn save(&self) -> Vec<u8> {
        self.surfaces.iter().map(|surface| u8::from(surface.is_made_of_spheres)).collect()
    }

    fn restore(&mut self, state: &[u8]) -> bool {
        let each = self.surfaces.iter_mut().zip(state);
        each.for_each(|(surface, state)| surface.is_made_of_spheres = *state == 1);
        self.surfaces.len() == state.len()
    }
}

impl FlowCloud {
    /// Adds the repulsion to the forces on the particles of a group, and to the part of them that is due to
    /// boundaries.
    pub(in crate::formulations::fluid) fn repel(
        &self,
        group: &Group,
        total: &mut [Force],
        parts: &mut [DVec3],
    ) {
        let rows = group.cloud.clone();
        let mut add = |row: usize, force: DVec3| {
            total[row].0 += force;
            parts[PARTS * row + 1] += force;
        };
        let mut whole: Option<WholeBody> = None;
        for repelled in &self.repelled {
            if rows.contains(&repelled.i) {
                add(repelled.i - rows.start, repelled.force);
            } else if rows.start == repelled.boundary {
                if let LoadCarrier::Body(nearest) = repelled.shares.carrier {
                    let body = whole.get_or_insert_with(|| WholeBody::new(self, group));
                    body.push(self, [repelled.i, nearest as usize], -repelled.force);
                    continue;
                }
                for &j in self.boundary_near(repelled.i, &rows) {
                    let share = repelled.shares.of(self, repelled.i, j as usize);
                    add(j as usize - rows.start, -share * repelled.force);
                }
            }
        }
        if let Some(body) = whole {
            body.for_each_force(self, group, add);
        }
    }
}

impl Shares {
    /// The share of particle `j` in what acts on `i`.
    pub fn of(&self, cloud: &FlowCloud, i: usize, j: usize) -> f64 {
        if let LoadCarrier::Particle(only) = self.carrier {
            return if only as usize == j { 1.0 } else { 0.0 };
        }
        let record = &cloud.records[j];
        let x = cloud.offset(cloud.records[i].position(), record.position());
        let weight = record.volume() * cloud.kernel.value(x.length());
        weight * (1.0 + (x - self.mean).dot(self.slope)) / self.total
    }
}
