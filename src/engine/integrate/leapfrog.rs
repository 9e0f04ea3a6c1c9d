//! The leapfrog: v(n+1/2) = v(n) + dt/2 a(n), x(n+1) = x(n) + dt v(n+1/2), v(n+1) = v(n+1/2) + dt/2 a(n+1).
//!
//! A force acts through the mobility, the inverse mass per axis: where it is zero the motion is prescribed and the
//! force goes into the constraint, whose work is booked here as -f.v of the two half-steps.

use glam::DVec3;

use crate::parallel::{BlockSum, for_each_block};
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

/// What a pass learns of a block.
#[derive(Clone, Copy, Debug, Default)]
struct MotionSum {
    /// Momentum, kg m/s.
    momentum: DVec3,
    /// Power of the forces on constrained axes, W.
    constraint_power: f64,
    /// Twice the kinetic energy, J.
    twice_kinetic: f64,
    /// Largest squared acceleration, m2/s4.
    acceleration_squared: f64,
}

impl BlockSum for MotionSum {
    fn add(&mut self, next: &Self) {
        self.momentum += next.momentum;
        self.constraint_power += next.constraint_power;
        self.twice_kinetic += next.twice_kinetic;
        self.acceleration_squared = self.acceleration_squared.max(next.acceleration_squared);
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
        for id in step.turn.due(step.world, &self.bodies) {
            let body = step.world.body(id);
            let view = step.world.phase(body.phase);
            let rows = body.rows.clone();
            let force = view.read::<Force>()?;
            let mobility = view.read::<Mobility>()?;
            let mass = view.read::<Mass>()?;
            let mut velocity = view.write::<Velocity>()?;
            let mut position = view.write::<Position>()?;
            let slices = (
                &mut velocity[rows.clone()],
                &mut position[rows.clone()],
                &force[rows.clone()],
                &mobility[rows.clone()],
                &mass[rows],
            );
            type Rows<'a> = (&'a mut [Velocity], &'a mut [Position], &'a [Force], &'a [Mobility], &'a [Mass]);
            let sum = for_each_block(slices, &mut self.sums, &|_, (v, x, f, mobility, mass): Rows<'_>| {
                let mut sum = MotionSum::default();
                for k in 0..v.len() {
                    v[k].0 += 0.5 * dt * (f[k].0 * mobility[k].0);
                    x[k].0 += dt * v[k].0;
                    sum.momentum += mass[k].0 * v[k].0;
                    sum.constraint_power += (f[k].0 * constrained(mobility[k].0)).dot(v[k].0);
                }
                sum
            });
            step.ledger.add(constraints, id, -0.5 * dt * sum.constraint_power);
            step.ledger.add(gravity_work, id, dt * sum.momentum.dot(self.gravity));
        }
        Ok(())
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
        for id in step.turn.due(step.world, &self.bodies) {
            let body = step.world.body(id);
            let view = step.world.phase(body.phase);
            let rows = body.rows.clone();
            let force = view.read::<Force>()?;
            let mobility = view.read::<Mobility>()?;
            let mass = view.read::<Mass>()?;
            let mut velocity = view.write::<Velocity>()?;
            let slices = (
                &mut velocity[rows.clone()],
                &force[rows.clone()],
                &mobility[rows.clone()],
                &mass[rows.clone()],
            );
            type Rows<'a> = (&'a mut [Velocity], &'a [Force], &'a [Mobility], &'a [Mass]);
            let sum = for_each_block(slices, &mut self.sums, &|_, (v, f, mobility, mass): Rows<'_>| {
                let mut sum = MotionSum::default();
                for k in 0..v.len() {
                    let acceleration = f[k].0 * mobility[k].0;
                    sum.constraint_power += (f[k].0 * constrained(mobility[k].0)).dot(v[k].0);
                    v[k].0 += 0.5 * dt * acceleration;
                    sum.twice_kinetic += mass[k].0 * v[k].0.length_squared();
                    sum.acceleration_squared = sum.acceleration_squared.max(acceleration.length_squared());
                }
                sum
            });
            step.ledger.add(constraints, id, -0.5 * dt * sum.constraint_power);
            step.ledger.set(kinetic, id, 0.5 * sum.twice_kinetic);
            if !sum.twice_kinetic.is_finite() {
                let broken = velocity[rows].iter().position(|v| !v.0.is_finite()).unwrap_or(0);
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
