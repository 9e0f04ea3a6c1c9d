//! The leapfrog: v(n+1/2) = v(n) + dt/2 a(n), x(n+1) = x(n) + dt v(n+1/2), v(n+1) = v(n+1/2) + dt/2 a(n+1).
//!
//! A force acts through the mobility, the inverse mass per axis. Where it is zero the motion is prescribed
//! and the force acts on the constraint; its work, -f.v of the two half-steps, is booked here.

use std::any::TypeId;
use std::ops::Range;

use bytemuck::{Pod, Zeroable};
use glam::DVec3;

use super::fours::FourOfColumn;
use crate::parallel::{BlockSum, FourLanes, HotLoop, Lanes4, for_each_own_block, run_hot};
use crate::plugin::SimBuilder;
use crate::schedule::{AccountKind, Mode, Run, Stage, Step, StepError, System};
use crate::world::{BodyId, BodySet, Force, Mass, Mobility, Position, Velocity};

/// Label of the system of stage [`Stage::InitialIntegrate`].
pub const DRIFT: &str = "kick_and_drift";
/// Label of the system of stage [`Stage::FinalIntegrate`].
pub const KICK: &str = "kick";

/// A body that its formulation moves itself; formulations add it with [`SimBuilder::extend`].
pub struct OwnMotion(pub BodyId);

/// Adds the two systems of the leapfrog, for all bodies that do not move by themselves.
pub fn add_systems(sim: &mut SimBuilder<'_>) {
    let gravity = sim.gravity();
    let own = BodySet::new(sim.take_extensions::<OwnMotion>().into_iter().map(|own| own.0));
    let bodies = BodySet::new(sim.bodies().iter().map(|body| body.id).filter(|&id| !own.contains(id)));
    if bodies.is_empty() {
        return;
    }
    let phases = sim.phases_of(&bodies);
    sim.add_system(
        System::new(
            Stage::InitialIntegrate,
            DRIFT,
            KickDrift { bodies: bodies.clone(), gravity, sums: Vec::new() },
        )
        .on_phases(phases.clone())
        .reads::<Force>()
        .reads::<Mobility>()
        .reads::<Mass>()
        .touches(<Velocity as crate::world::Column>::NAME, Mode::Writes)
        .writes::<Position>()
        .by_body(),
    );
    sim.add_system(
        System::new(Stage::FinalIntegrate, KICK, Kick { bodies, sums: Vec::new() })
            .on_phases(phases)
            .reads::<Force>()
            .reads::<Mobility>()
            .reads::<Mass>()
            .writes::<Velocity>()
            .by_body(),
    );
}

/// One where the mobility is zero, zero elsewhere.
#[inline(always)]
pub(crate) fn constrained(mobility: DVec3) -> DVec3 {
    DVec3::select(mobility.cmpeq(DVec3::ZERO), DVec3::ONE, DVec3::ZERO)
}

/// Sums over a block.
#[derive(Clone, Copy, Debug, Default, Pod, Zeroable)]
#[repr(C)]
struct MotionSum {
    /// Power of gravity, W.
    gravity_power: f64,
    /// Power of the forces on constrained axes, W.
    constraint_power: f64,
    /// Twice the kinetic energy, J.
    twice_kinetic: f64,
    /// Largest squared acceleration, m2/s4.
    acceleration_squared: f64,
    /// Bits that any component has changed.
    changed: u64,
}

impl BlockSum for MotionSum {
    fn add(&mut self, next: &Self) {
        self.gravity_power += next.gravity_power;
        self.constraint_power += next.constraint_power;
        self.twice_kinetic += next.twice_kinetic;
        self.acceleration_squared = self.acceleration_squared.max(next.acceleration_squared);
        self.changed |= next.changed;
    }
}

/// Rows of a block for both kicks.
type Rows<'a> = (&'a mut [Velocity], &'a [Force], &'a [Mobility], &'a [Mass]);

/// The same component by component, and the masses.
struct KickComponents<'a> {
    velocity: &'a mut [f64],
    force: &'a [f64],
    mobility: &'a [f64],
    mass: &'a [f64],
}

impl<'a> KickComponents<'a> {
    #[inline(always)]
    fn new((velocity, force, mobility, mass): Rows<'a>) -> Self {
        Self {
            velocity: bytemuck::cast_slice_mut(velocity),
            force: bytemuck::cast_slice(force),
            mobility: bytemuck::cast_slice(mobility),
            mass: bytemuck::cast_slice(mass),
        }
    }

    /// Number of fours, the last of which may not be whole.
    #[inline(always)]
    fn fours(&self) -> usize {
        self.mass.len().div_ceil(4)
    }

    /// Force, mobility and mass of the k-th four, and where their components lie.
    #[inline(always)]
    fn four(&self, k: usize) -> (FourOfColumn, FourOfColumn, FourOfColumn, Range<usize>) {
        let (first, last) = (4 * k, (4 * k + 4).min(self.mass.len()));
        let at = 3 * first..3 * last;
        let (force, mobility) = (&self.force[at.clone()], &self.mobility[at.clone()]);
        let mass = FourOfColumn::of_numbers(&self.mass[first..last]);
        (FourOfColumn::load(force), FourOfColumn::load(mobility), mass, at)
    }
}

struct KickDrift {
    bodies: BodySet,
    gravity: DVec3,
    sums: Vec<MotionSum>,
}

impl Run for KickDrift {
    fn run(&mut self, step: &mut Step<'_>) -> Result<(), StepError> {
        let dt = step.clock.dt;
        let constraints = step.ledger.account("constraints", AccountKind::Supplied);
        let gravity_work = step.ledger.account("gravity", AccountKind::Supplied);
        for id in step.part.due(step.world, &self.bodies) {
            let body = step.world.body(id);
            let view = step.world.phase(body.phase);
            let rows = body.rows.clone();
            let force = view.read_own::<Force>()?;
            let mobility = view.read_own::<Mobility>()?;
            let mass = view.read_own::<Mass>()?;
            let mut velocity = view.write_unmarked::<Velocity>()?;
            let mut position = view.write_unmarked::<Position>()?;
            let slices = (
                &mut position[rows.clone()],
                (&mut velocity[rows.clone()], &force[rows.clone()], &mobility[rows.clone()], &mass[rows]),
            );
            let gravity = self.gravity;
            let sum = for_each_own_block(slices, &mut self.sums, &|_, (positions, rows): (_, Rows<'_>)| {
                run_hot(FirstKick { dt, gravity, positions, rows })
            });
            drop((velocity, position));
            // What stands still needs no exchange.
            if sum.changed != 0 {
                view.mark_own(TypeId::of::<Velocity>());
                view.mark_own(TypeId::of::<Position>());
            }
            step.ledger.add(constraints, id, -0.5 * dt * sum.constraint_power);
            step.ledger.add(gravity_work, id, dt * sum.gravity_power);
        }
        Ok(())
    }
}

struct FirstKick<'a> {
    dt: f64,
    gravity: DVec3,
    positions: &'a mut [Position],
    rows: Rows<'a>,
}

impl HotLoop for FirstKick<'_> {
    type Output = MotionSum;

    #[inline(always)]
    fn run<A: FourLanes>(self, a: A) -> MotionSum {
        let gravity = FourOfColumn::splat(self.gravity);
        let (mut gravity_power, mut constraint_power) = (Lanes4::ZERO, Lanes4::ZERO);
        let mut changed = 0;
        let positions: &mut [f64] = bytemuck::cast_slice_mut(self.positions);
        let of = KickComponents::new(self.rows);
        for k in 0..of.fours() {
            let (f, mobility, mass, at) = of.four(k);
            let (x, velocity) = (&mut positions[at.clone()], &mut of.velocity[at]);
            let (before, place) = (FourOfColumn::load(velocity), FourOfColumn::load(x));
            let v = before.add_scaled(a, 0.5 * self.dt, f.mul(a, mobility));
            v.store(velocity);
            let moved = place.add_scaled(a, self.dt, v);
            moved.store(x);
            changed |= v.difference(before) | moved.difference(place);
            let weight = mass.mul(a, gravity);
            gravity_power = weight.dot_onto(a, v, gravity_power);
            constraint_power = f.where_held(a, mobility).dot_onto(a, v, constraint_power);
        }
        MotionSum {
            gravity_power: gravity_power.sum(),
            constraint_power: constraint_power.sum(),
            changed,
            ..MotionSum::default()
        }
    }
}

/// Share of the distance sqrt(spacing / acceleration) that a step may take.
const ACCELERATION_FACTOR: f64 = 0.25;

struct Kick {
    bodies: BodySet,
    sums: Vec<MotionSum>,
}

impl Run for Kick {
    fn run(&mut self, step: &mut Step<'_>) -> Result<(), StepError> {
        let dt = step.clock.dt;
        let kinetic = step.ledger.account("kinetic", AccountKind::Stored);
        let constraints = step.ledger.account("constraints", AccountKind::Supplied);
        for id in step.part.due(step.world, &self.bodies) {
            let body = step.world.body(id);
            let view = step.world.phase(body.phase);
            let rows = body.rows.clone();
            let force = view.read_own::<Force>()?;
            let mobility = view.read_own::<Mobility>()?;
            let mass = view.read_own::<Mass>()?;
            let mut velocity = view.write_unmarked::<Velocity>()?;
            let slices = (
                &mut velocity[rows.clone()],
                &force[rows.clone()],
                &mobility[rows.clone()],
                &mass[rows.clone()],
            );
            let sum = for_each_own_block(slices, &mut self.sums, &|_, rows: Rows<'_>| {
                run_hot(SecondKick { dt, rows })
            });
            drop(velocity);
            if sum.changed != 0 {
                view.mark_own(TypeId::of::<Velocity>());
            }
            step.ledger.add(constraints, id, -0.5 * dt * sum.constraint_power);
            step.ledger.set(kinetic, id, 0.5 * sum.twice_kinetic);
            if !sum.twice_kinetic.is_finite() {
                let broken =
                    view.read::<Velocity>()?[rows].iter().position(|v| !v.0.is_finite()).unwrap_or(0);
                return Err(step.unstable("velocity is not a finite number", id, broken));
            }
            if sum.acceleration_squared > 0.0 {
                let limit = ACCELERATION_FACTOR * (body.spacing / sum.acceleration_squared.sqrt()).sqrt();
                step.limits.propose(limit, format_args!("acceleration of `{}`", body.name));
            }
        }
        Ok(())
    }
}

struct SecondKick<'a> {
    dt: f64,
    rows: Rows<'a>,
}

impl HotLoop for SecondKick<'_> {
    type Output = MotionSum;

    #[inline(always)]
    fn run<A: FourLanes>(self, a: A) -> MotionSum {
        let (mut constraint_power, mut twice_kinetic) = (Lanes4::ZERO, Lanes4::ZERO);
        let (mut acceleration_squared, mut changed) = (Lanes4::ZERO, 0);
        let of = KickComponents::new(self.rows);
        for k in 0..of.fours() {
            let (f, mobility, mass, at) = of.four(k);
            let velocity = &mut of.velocity[at];
            let before = FourOfColumn::load(velocity);
            constraint_power = f.where_held(a, mobility).dot_onto(a, before, constraint_power);
            let acceleration = f.mul(a, mobility);
            let v = before.add_scaled(a, 0.5 * self.dt, acceleration);
            v.store(velocity);
            changed |= v.difference(before);
            twice_kinetic = mass.mul(a, v).dot_onto(a, v, twice_kinetic);
            acceleration_squared = a.max(acceleration.squares(a), acceleration_squared);
        }
        let [p, q, r, s] = acceleration_squared.0;
        MotionSum {
            constraint_power: constraint_power.sum(),
            twice_kinetic: twice_kinetic.sum(),
            acceleration_squared: p.max(q).max(r.max(s)),
            changed,
            ..MotionSum::default()
        }
    }
}
