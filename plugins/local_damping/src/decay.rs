//! The decay itself: v' = -rate v along the axes that are free, with the lost energy booked.

use meshless_engine::parallel::{BlockSum, sum_over_blocks};
use meshless_engine::rigid::RigidBodies;
use meshless_engine::schedule::{AccountKind, Clock, Run, Step, StepError};
use meshless_engine::world::{BodyId, BodySet, Mass, Mobility, Velocity};

/// Account of the energy dissipated by the damping.
const ACCOUNT: &str = "local_damping";

/// When a damping acts.
#[derive(Clone, Copy, Debug)]
pub struct Window {
    /// Time from which it acts, s.
    pub from: f64,
    /// Time until which it acts, s.
    pub until: f64,
}

impl Window {
    /// The part of the step that lies in the window, s.
    pub fn share(&self, clock: &Clock) -> f64 {
        (clock.end().min(self.until) - clock.time.max(self.from)).max(0.0)
    }
}

/// Energy that a block has lost, J.
#[derive(Clone, Copy, Default)]
struct DampedEnergy(f64);

impl BlockSum for DampedEnergy {
    fn add(&mut self, next: &Self) {
        self.0 += next.0;
    }
}

/// Multiplies the velocity of a body by `factor` along its free axes, and books the loss.
pub fn damp(step: &mut Step<'_>, id: BodyId, factor: f64) -> Result<(), StepError> {
    let (view, rows) = step.world.body_view(id);
    let mass = view.read::<Mass>()?;
    let mobility = view.read::<Mobility>()?;
    let mut velocity = view.write::<Velocity>()?;
    let slices = (&mut velocity[rows.clone()], &mass[rows.clone()], &mobility[rows]);
    type Rows<'a> = (&'a mut [Velocity], &'a [Mass], &'a [Mobility]);
    let loss = sum_over_blocks(slices, &|_, (velocity, mass, mobility): Rows<'_>| {
        let mut twice = 0.0;
        for ((v, m), mobility) in velocity.iter_mut().zip(mass).zip(mobility) {
            let before = v.0.length_squared();
            for axis in 0..3 {
                if mobility.0[axis] > 0.0 {
                    v.0[axis] *= factor;
                }
            }
            twice += m.0 * (before - v.0.length_squared());
        }
        DampedEnergy(0.5 * twice)
    });
    let kinetic = step.ledger.account("kinetic", AccountKind::Stored);
    let damped = step.ledger.account(ACCOUNT, AccountKind::Dissipated);
    step.ledger.add(kinetic, id, -loss.0);
    step.ledger.add(damped, id, loss.0);
    Ok(())
}

/// Opens the account of the plugin, so that it is there from the first step on even if nothing is damped yet.
pub fn open_account(step: &mut Step<'_>) {
    step.ledger.account(ACCOUNT, AccountKind::Dissipated);
}

/// Names, in the first step, the rigid bodies that are free to move and not damped.
pub fn name_undamped(step: &mut Step<'_>, bodies: &BodySet) {
    if step.clock.step > 1 {
        return;
    }
    let Some(rigid) = step.resources.try_get::<RigidBodies>() else { return };
    for body in
        rigid.iter().filter(|body| bodies.contains(body.id) && (0..3).all(|axis| !body.is_driven_along(axis)))
    {
        let text = format!(
            "`local_damping` does not act on rigid body `{}`, which keeps moving: its contacts dissipate energy with a `restitution` below 1",
            step.world.body(body.id).name
        );
        if !step.warnings.contains(&text) {
            step.warnings.push(text);
        }
    }
}

/// Decay at a constant rate.
pub struct Decay {
    /// Bodies.
    pub bodies: BodySet,
    /// When it acts.
    pub window: Window,
    /// Rate, 1/s.
    pub rate: f64,
}

impl Run for Decay {
    fn run(&mut self, step: &mut Step<'_>) -> Result<(), StepError> {
        open_account(step);
        name_undamped(step, &self.bodies);
        let time = self.window.share(&step.clock);
        if time > 0.0 && self.rate > 0.0 {
            // Exact for any rate: no limit of the time step follows from the damping.
            let factor = (-self.rate * time).exp();
            for body in self.bodies.iter() {
                damp(step, body, factor)?;
            }
        }
        Ok(())
    }
}
