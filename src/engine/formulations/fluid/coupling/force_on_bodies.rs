//! The force of a flow on bodies that take sub-steps.
//!
//! It is frozen in the long step: the sub-steps use the force at its start, f(n). At its end the change is
//! applied as an impulse, dt/2 (f(n+1) - f(n)), so that the body has received dt/2 (f(n) + f(n+1)), exactly
//! the opposite of the kicks of the fluid. The fluid has the mean velocity of the body in the long step, on
//! which the frozen force does its work. With one sub-step in the long one this is the leapfrog, and under a
//! constant force the impulse is zero.

use glam::DVec3;

use super::correction_impulse::{ParticleRows, Particles, give_to_rigid_body};
use super::drag;
use super::drag::DragColumns;
use super::exchange::{CouplingForce, CouplingFriction, CouplingPressure, Exchange};
use super::frozen;
use super::light_body::WetSurface;
use super::sub_cycled::limits_of_long_step;
use crate::formulations::fluid::cloud::{ACCOUNTS, FlowCloud, FluidState, Group, PARTS, PLACES_BEFORE, Role};
use crate::formulations::fluid::lanes::FlowParticle;
use crate::formulations::fluid::lists::blocks::pack_states;
use crate::formulations::fluid::moments::SurfaceMoments;
use crate::formulations::fluid::passes::{friction_on, reads_flow};
use crate::parallel::{Lanes4, for_each_block};
use crate::plugin::SimBuilder;
use crate::removal::REMOVED_ENERGY;
use crate::rigid::{RIGID_BODIES, RigidBodies, RigidBody};
use crate::schedule::{AccountKind, Mode, Run, Stage, Step, StepError, System};
use crate::world::{BodyId, BodySet, Force, Mass, Mobility, PhaseId, Position, Removed, Velocity};

/// Adds the systems for one phase of bodies beside the flow: their contributions come after the weight of the
/// bodies and after the second kick. Where friction `follows`, it changes in the sub-steps by the motion of
/// the body.
pub fn add_force_on_bodies(
    sim: &mut SimBuilder<'_>,
    groups: &[Group],
    phase: PhaseId,
    label: &'static str,
    follows: bool,
) {
    let bodies = BodySet::new(groups.iter().filter(|group| group.phase == phase).map(|group| group.body));
    sim.add_column_to::<CouplingForce>(&bodies);
    sim.add_column_to::<CouplingFriction>(&bodies);
    sim.add_column_to::<CouplingPressure>(&bodies);
    sim.add_system(
        System::new(Stage::PreStep, format!("{label}_before"), move |step: &mut Step<'_>| {
            step.resources.get_mut::<FlowCloud>().remember(phase, step.world)
        })
        .on_phases([phase])
        .touches_packed(PLACES_BEFORE, Mode::Adds)
        .reads::<Position>()
        .in_long_steps(),
    );
    frozen::add(sim, &bodies, phase, label);
    if follows {
        drag::add(sim, &bodies, phase, label);
    }
    let coupling = Coupling::new(phase, follows, &bodies, sim);
    let system = reads_flow(System::new(Stage::FinalIntegrate, label, coupling))
        .on_phases([phase])
        .in_long_steps()
        .touches_packed(PLACES_BEFORE, Mode::Reads)
        .touches_packed(RIGID_BODIES, Mode::Adds)
        .writes::<CouplingForce>()
        .writes::<CouplingFriction>()
        .writes::<CouplingPressure>()
        .reads::<Mass>()
        .reads::<Mobility>()
        .reads::<Removed>()
        .adds::<Force>()
        .adds::<Velocity>();
    sim.add_system(if follows { drag::writes_drag(system) } else { system });
}

impl FlowCloud {
    /// Keeps the positions of a phase at the start of the long step.
    fn remember(&mut self, phase: PhaseId, world: &crate::world::World) -> Result<(), StepError> {
        self.before.resize(self.records.len() - self.fluid, DVec3::ZERO);
        for group in self.groups.iter().filter(|group| group.phase == phase) {
            let position = world.phase(group.phase).read::<Position>()?;
            let before = &mut self.before[group.cloud.start - self.fluid..group.cloud.end - self.fluid];
            before.copy_from_slice(bytemuck::cast_slice(&position[group.rows.clone()]));
        }
        Ok(())
    }

    /// Gives bodies that take sub-steps their mean velocity over the long one, s.
    pub(in crate::formulations::fluid) fn average_motion(&mut self, dt: f64) {
        if dt == 0.0 {
            return;
        }
        let Self { groups, records, before, fluid, blocks, .. } = self;
        for group in groups.iter().filter(|group| group.short) {
            let before = &before[group.cloud.start - *fluid..group.cloud.end - *fluid];
            let slices = (&mut records[group.cloud.clone()], before);
            type Rows<'a> = (&'a mut [FlowParticle], &'a [DVec3]);
            for_each_block(slices, &mut Vec::new(), &|_, (records, before): Rows<'_>| {
                for (record, before) in records.iter_mut().zip(before) {
                    record.motion = Lanes4::new((record.position() - *before) / dt, 0.0);
                }
            });
            if let Some(blocks) = blocks {
                pack_states(&mut blocks.packed[group.cloud.clone()], &records[group.cloud.clone()]);
            }
        }
    }
}

/// Stable step of the surface of a deformable body in units of h / sqrt(K / rho), with its density and the
/// largest bulk modulus K of all fluids, whose pressure moves it: a strip of half the density of the water,
/// two particles of it thick, is stable at 0.42 and not at 0.6.
const SURFACE: f64 = 0.4;

struct Coupling {
    phase: PhaseId,
    /// Whether friction follows the motion of the bodies in the sub-steps.
    follows: bool,
    /// Stable step of the surface of each body, in units of h / sqrt(K / rho), and its largest one, s.
    steps: Vec<(BodyId, f64, f64)>,
    /// Surfaces of the rigid bodies.
    surfaces: Vec<WetSurface>,
    /// Force on the particles of a body, and its parts, N.
    total: Vec<Force>,
    parts: Vec<DVec3>,
    /// The same from the other side of a thin body.
    other_total: Vec<Force>,
    other_parts: Vec<DVec3>,
    moments: SurfaceMoments,
    /// How fast friction grows with the velocity of each particle, kg/s.
    drag: Vec<f64>,
    sums: Vec<Exchange>,
}

impl Coupling {
    fn new(phase: PhaseId, follows: bool, bodies: &BodySet, sim: &SimBuilder<'_>) -> Self {
        let step_of = |id| {
            let (share, longest) = limits_of_long_step(id, sim);
            (id, SURFACE * share, longest)
        };
        Self {
            phase,
            follows,
            steps: bodies.iter().map(step_of).collect(),
            surfaces: bodies.iter().filter_map(|id| WetSurface::new(id, sim)).collect(),
            total: Vec::new(),
            parts: Vec::new(),
            other_total: Vec::new(),
            other_parts: Vec::new(),
            moments: SurfaceMoments::default(),
            drag: Vec::new(),
            sums: Vec::new(),
        }
    }

    /// Sums the forces of the flow on the particles of a body over both of its sides, if it is thin.
    fn sum_forces(&mut self, cloud: &FlowCloud, body: BodyId) {
        for (side, group) in cloud.groups.iter().filter(|group| group.body == body).enumerate() {
            let Self { total, parts, other_total, other_parts, moments, .. } = self;
            let (to, parts_to) =
                if side == 0 { (&mut *total, &mut *parts) } else { (other_total, other_parts) };
            to.resize(group.rows.len(), Force::default());
            parts_to.resize(PARTS * group.rows.len(), DVec3::ZERO);
            cloud.force(group, to, parts_to);
            moments.add(cloud, group, to, parts_to);
            cloud.repel(group, to, parts_to);
            cloud.press_gaps(group, to, parts_to);
            cloud.add_edge_forces(group, to, parts_to);
            cloud.let_go(group, to);
            if side == 0 {
                self.drag.clear();
                self.drag.resize(group.rows.len(), 0.0);
            }
            self.moments.add_drag(&mut self.drag);
            if side > 0 {
                self.total.iter_mut().zip(&self.other_total).for_each(|(sum, other)| sum.0 += other.0);
                self.parts.iter_mut().zip(&self.other_parts).for_each(|(sum, other)| *sum += *other);
            }
        }
    }
}

impl Coupling {
    /// Applies the correction impulse to a body at the end of the long step.
    fn give(&mut self, step: &mut Step<'_>, cloud: &FlowCloud, group: &Group) -> Result<Exchange, StepError> {
        let resources = step.resources;
        let mut rigid = resources.try_get_mut::<RigidBodies>();
        let view = step.world.phase(group.phase);
        let rows = group.rows.clone();
        let (mass, mobility) = (view.read::<Mass>()?, view.read::<Mobility>()?);
        let removed = view.read::<Removed>()?;
        let (mut velocity, mut force) = (view.write::<Velocity>()?, view.write::<Force>()?);
        let mut frozen = view.write::<CouplingForce>()?;
        let mut friction = view.write::<CouplingFriction>()?;
        let mut pressure = view.write::<CouplingPressure>()?;
        let first = group.cloud.start - cloud.fluid;
        let before = cloud.before.get(first..first + rows.len()).unwrap_or_default();
        let particles = Particles {
            dt: step.clock.dt,
            divided: step.part.is_divided(),
            records: &cloud.records[group.cloud.clone()],
            before,
            mass: &mass[rows.clone()],
            mobility: &mobility[rows.clone()],
            removed: &removed[rows.clone()],
            drag: &self.drag,
            total: &self.total,
            parts: &self.parts,
        };
        let mut drag = if self.follows { Some(DragColumns::new(&view)?) } else { None };
        let columns = ParticleRows {
            velocity: &mut velocity[rows.clone()],
            force: &mut force[rows.clone()],
            frozen: &mut frozen[rows.clone()],
            friction: &mut friction[rows.clone()],
            pressure: &mut pressure[rows.clone()],
            drag: drag.as_mut().map(|drag| drag.rows(rows)),
        };
        let body = rigid.as_mut().and_then(|bodies| bodies.of_mut(group.body));
        let step_of_pressure = self.step_of_pressure(cloud, group, particles.lightest(), body.as_deref());
        let (exchange, rate) = match body {
            Some(body) => (give_to_rigid_body(body, &particles, columns), particles.rate_of_rigid_body(body)),
            None => (particles.give(columns, &mut self.sums), particles.rate()),
        };
        let name = &step.world.body(group.body).name;
        if rate > 0.0 {
            step.limits.propose(1.0 / rate, format_args!("friction of the fluid on `{name}`"));
        }
        if step_of_pressure.is_finite() {
            step.limits.propose(step_of_pressure, format_args!("pressure of the fluid on `{name}`"));
        }
        Ok(exchange)
    }

    /// Stable step of the pressure of the fluids on a body, s; infinite on one that they do not move. The
    /// particle of it with the minimum density that is wet has `lightest`, kg/m3.
    fn step_of_pressure(
        &self,
        cloud: &FlowCloud,
        group: &Group,
        lightest: Option<f64>,
        rigid: Option<&RigidBody>,
    ) -> f64 {
        let Some(lightest) = lightest else { return f64::INFINITY };
        let h = cloud.kernel.smoothing_length();
        let fluids = cloud.groups.iter().filter_map(Group::fluid);
        let stiffest = fluids.map(FluidState::bulk_modulus).fold(0.0, f64::max);
        if let Some(body) = rigid {
            let surface = self.surfaces.iter().find(|surface| surface.body == group.body);
            return surface.map_or(f64::INFINITY, |surface| {
                surface.stable_step(body, group.has_suction(), h, stiffest)
            });
        }
        if cloud.soft_neighborhood(group).is_none() {
            return f64::INFINITY;
        }
        let own = self.steps.iter().find(|(id, ..)| *id == group.body);
        let (share, longest) = own.map_or((SURFACE, f64::INFINITY), |(_, share, longest)| (*share, *longest));
        longest.min(share * h * (lightest / stiffest).sqrt())
    }
}

impl Run for Coupling {
    fn run(&mut self, step: &mut Step<'_>) -> Result<(), StepError> {
        let cloud = step.resources.get::<FlowCloud>();
        let (mut last, phase) = (None, self.phase);
        for group in cloud.groups.iter().filter(|group| group.phase == phase) {
            if last.replace(group.body) == Some(group.body) {
                continue;
            }
            self.sum_forces(&cloud, group.body);
            let exchange = self.give(step, &cloud, group)?;
            let moving =
                if let Role::Boundary(surface) = &group.role { surface.velocity } else { DVec3::ZERO };
            // What drives a belt does the work that friction turns into heat.
            let belt = -friction_on(&self.total, &self.parts).dot(moving) * step.clock.dt;
            let kinetic = step.ledger.account("kinetic", AccountKind::Stored);
            let constraints = step.ledger.account("constraints", AccountKind::Supplied);
            step.ledger.add(kinetic, group.body, exchange.kinetic);
            step.ledger.add(constraints, group.body, exchange.constraints + belt);
            if exchange.removed != 0.0 {
                let removed = step.ledger.account(REMOVED_ENERGY, AccountKind::Dissipated);
                step.ledger.add(removed, group.body, exchange.removed);
            }
            for (name, work) in ACCOUNTS.iter().zip(exchange.parts) {
                let account = step.ledger.account(name, AccountKind::Dissipated);
                step.ledger.add(account, group.body, -work);
            }
            let viscosity = step.ledger.account(ACCOUNTS[0], AccountKind::Dissipated);
            step.ledger.add(viscosity, group.body, belt);
        }
        Ok(())
    }
}
