//! External forces and their work.
//!
//! The work of a step is (f(n) + f(n+1))/2 . v(n+1/2) dt, the kinetic energy added by the two kicks of the
//! leapfrog.

use std::sync::Arc;

use glam::DVec3;

use super::field::VectorField;
use super::flow_load;
use super::load_law::LoadLaw;
use super::on_rigid::push_beside;
use super::part::{Part, parts_of, phases_of};
use super::pulses;
use crate::parallel::{Picked, sum_over_blocks};
use crate::plugin::{BodyKind, BodyPlan, Selection, SetupError, SimBuilder};
use crate::rigid::{MovingFunction, RIGID_BODIES};
use crate::scene::{Expression, Select};
use crate::schedule::{AccountKind, Mode, Run, Stage, Step, StepError, System};
use crate::world::{BodyId, Force, ParticleId, Position, Removed, Velocity};

/// A load that does not follow the motion: a field of the place and time, times a share per particle.
pub(super) struct DeadLoad {
    /// Label, for errors.
    pub name: &'static str,
    /// Traction, acceleration or force.
    pub field: VectorField,
    /// Area, mass or share of every particle of every part, in the order of the start.
    pub shares: Vec<Vec<f64>>,
    /// Of every part, see [`LoadLaw::arms`].
    pub arms: Vec<Vec<DVec3>>,
}

impl LoadLaw for DeadLoad {
    fn forces(&self, k: usize, part: &Part, step: &Step<'_>, out: &mut Vec<DVec3>) -> Result<(), StepError> {
        self.field.values(&part.points, step.clock.end(), self.name, out)?;
        let shares = &self.shares[k];
        sum_over_blocks(&mut out[..], &|first, out: &mut [DVec3]| {
            out.iter_mut().zip(first..).for_each(|(force, n)| *force *= shares[part.number(n)]);
        });
        Ok(())
    }

    fn is_constant(&self, part: &Part) -> bool {
        self.field.is_constant(part)
    }

    fn functions(&self) -> Vec<Expression> {
        self.field.functions().cloned().collect()
    }

    fn arms(&self, k: usize) -> &[DVec3] {
        &self.arms[k]
    }
}

/// Adds the system that applies a load; its work goes to the account of the same name.
pub(super) fn apply(
    label: &'static str,
    law: impl LoadLaw,
    selection: &Selection,
    sim: &mut SimBuilder<'_>,
    declare: impl Fn(System) -> System,
) {
    let mut parts = parts_of(selection, sim);
    parts.iter_mut().for_each(|part| part.in_space |= law.is_in_space());
    let phases = phases_of(selection, sim);
    let forces = vec![Vec::new(); parts.len()];
    let law: Arc<dyn LoadLaw> = Arc::new(law);
    flow_load::add(label, &law, &parts, sim, &declare);
    let kinds: Vec<BodyKind> = parts.iter().map(|part| sim.body(part.body).kind).collect();
    let turns = kinds.contains(&BodyKind::Rigid);
    let rigid = parts.iter().zip(&kinds).filter(|(_, kind)| **kind == BodyKind::Rigid);
    let places = rigid.filter_map(|(part, _)| Some((part.body, *part.points.first()?)));
    for (k, (body, place)) in places.enumerate() {
        let functions = law.functions().into_iter().filter(|value| k == 0 || value.depends_on_place());
        functions.for_each(|value| sim.extend(MovingFunction { body, value, place }));
    }
    pulses::watch(label, &law.functions(), pulses::places_of(&parts), sim);
    let load = Load { label, law, parts, kinds, forces, next: Vec::new() };
    let mut system = System::new(Stage::External, label, load).on_phases(phases).by_body();
    if turns {
        system = system.touches_packed(RIGID_BODIES, Mode::Adds);
    }
    let system = system
        .reads::<Position>()
        .reads::<Velocity>()
        .reads::<Removed>()
        .reads::<ParticleId>()
        .adds::<Force>();
    sim.add_system(declare(system));
}

/// # Errors
/// A load acts on walls alone, which are moved by conditions and nothing else.
pub(super) fn require_movable(selection: &Selection, sim: &SimBuilder<'_>) -> Result<(), SetupError> {
    let is_wall = |id: BodyId| sim.body(id).kind == BodyKind::Boundary;
    match selection.parts.first() {
        Some((id, _)) if selection.parts.iter().all(|(id, _)| is_wall(*id)) => {
            let message = format!("no load moves body `{}`, a wall", sim.body(*id).name);
            let help = "walls are moved by their `velocity`, by `Velocity` or by `Displacement`; loads act on fluids, solids and rigid bodies";
            Err(SetupError::parameter("on", message, help))
        }
        _ => Ok(()),
    }
}

/// How a free surface is loaded.
pub(super) const PRESSED_SURFACE: &str = "pressures of a flow count from that of its free surface: leave a constant one out, and let a `Wall` or a `Rigid` body press where another one acts";

/// Warns of a load on a part of a fluid, which flows away from where it was selected.
pub(super) fn warn_of_parts(name: &str, on: &Select, selection: &Selection, sim: &mut SimBuilder<'_>) {
    let is_part = |body: &BodyPlan, rows: &[u32]| {
        body.kind == BodyKind::Fluid && on.nearest.is_none() && rows.len() < body.sites.len()
    };
    let bodies = selection.parts.iter().map(|(id, rows)| (sim.body(*id), rows));
    let warning = |body: &BodyPlan| {
        format!(
            "`{name}` loads those particles of the fluid `{}` that it selects at the start, wherever they flow: a force in a region is a function of place, `\"5*step(x)\"`, \
             on all of the fluid, and particles of a surface that are pressed sink into it; {PRESSED_SURFACE}",
            body.name
        )
    };
    let warnings: Vec<String> =
        bodies.filter(|(body, rows)| is_part(body, rows)).map(|(body, _)| warning(body)).collect();
    warnings.into_iter().for_each(|warning| sim.warn(warning));
}

struct Load {
    label: &'static str,
    law: Arc<dyn LoadLaw>,
    parts: Vec<Part>,
    /// Kind of the body of each part. Walls have no mass: a load changes the pressure of the fluid beside
    /// them, and does not act on themselves.
    kinds: Vec<BodyKind>,
    /// Forces at the end of the last step, in the order of rows; empty before the first.
    forces: Vec<Vec<DVec3>>,
    next: Vec<DVec3>,
}

impl Run for Load {
    fn run(&mut self, step: &mut Step<'_>) -> Result<(), StepError> {
        let account = step.ledger.account(self.label, AccountKind::Supplied);
        for (k, (part, last)) in self.parts.iter_mut().zip(&mut self.forces).enumerate() {
            if !step.part.is_due(step.world, part.body) {
                continue;
            }
            part.follow(step.world, last)?;
            let first = last.is_empty();
            let changes = first || !self.law.is_constant(part);
            if changes {
                part.locate(step.world)?;
                self.law.forces(k, part, step, &mut self.next)?;
                let rate = self.law.rate(part, step)?;
                if rate > 0.0 {
                    let name = &step.world.body(part.body).name;
                    step.limits.propose(1.0 / rate, format_args!("force field on `{name}`"));
                }
                if first {
                    last.clone_from(&self.next);
                }
            }
            let (view, _) = step.world.body_view(part.body);
            let velocity = view.read::<Velocity>()?;
            let removed = view.read::<Removed>()?;
            let mut force = view.write::<Force>()?;
            let (velocity, removed) = (&velocity[..], &removed[..]);
            let acts = self.kinds[k] != BodyKind::Boundary;
            let next: &[DVec3] = if changes { &self.next } else { last };
            let rows = (Picked::new(&part.rows, &mut force), &last[..], next);
            type Rows<'a> = (Picked<'a, Force>, &'a [DVec3], &'a [DVec3]);
            let mut power = sum_over_blocks(rows, &|_, (mut loaded, last, next): Rows<'_>| {
                let mut power = 0.0;
                for (k, (last, next)) in last.iter().zip(next).enumerate() {
                    let row = loaded.number(k);
                    if removed[row] == Removed::NO && acts {
                        loaded.row(k).0 += *next;
                        power += 0.5 * (*last + *next).dot(velocity[row].0);
                    }
                }
                power
            });
            if self.kinds[k] == BodyKind::Rigid {
                power = push_beside(part, self.law.arms(k), [last, next], step);
            }
            step.ledger.add(account, part.body, power * step.clock.dt);
            if changes {
                std::mem::swap(last, &mut self.next);
            }
        }
        Ok(())
    }

    fn save(&self) -> Vec<u8> {
        if self.parts.iter().all(|part| self.law.is_constant(part)) {
            return Vec::new();
        }
        let mut components = Vec::new();
        for (part, forces) in self.parts.iter().zip(&self.forces) {
            let mut at_start = vec![DVec3::ZERO; forces.len()];
            forces.iter().enumerate().for_each(|(n, force)| at_start[part.number(n)] = *force);
            components.extend(at_start.into_iter().flat_map(|force| force.to_array()));
        }
        components.into_iter().flat_map(f64::to_le_bytes).collect()
    }

    fn restore(&mut self, state: &[u8]) -> bool {
        let (numbers, rest) = state.as_chunks::<8>();
        let count: usize = self.parts.iter().map(|part| part.rows.len()).sum();
        if !rest.is_empty() || (numbers.len() != 3 * count && !numbers.is_empty()) {
            return false;
        }
        let numbers: Vec<f64> = numbers.iter().map(|bytes| f64::from_le_bytes(*bytes)).collect();
        let mut vectors = numbers.as_chunks::<3>().0.iter().map(|v| DVec3::from_array(*v));
        for (part, forces) in self.parts.iter().zip(&mut self.forces) {
            *forces = vectors.by_ref().take(part.rows.len()).collect();
        }
        true
    }
}
