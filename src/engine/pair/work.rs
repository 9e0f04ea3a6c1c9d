//! The work of pair terms, booked so that the energy balance closes as it does without them.
//!
//! A force f computed at the end of a step acts in the second kick of that step and in the first kick of the
//! next. Its work is `dt/2 f.(v - a dt/4)` in the one and `dt/2 f.(v + a dt/4)` in the other, exactly, with
//! the velocity v and the acceleration a between the two: two sums over the particles give both.

use bytemuck::{Pod, Zeroable};
use glam::DVec3;

use super::body_terms::{BodyTerms, MAX_TERMS};
use crate::integrate::DRIFT;
use crate::parallel::{BlockSum, FourLanes, HotLoop, Lanes4, Split, for_each_own_block, run_hot};
use crate::plugin::SimBuilder;
use crate::schedule::{AccountKind, Mode, Resources, Run, Shared, Stage, Step, StepError, System};
use crate::world::{BodyId, Column, Force, Mobility, PhaseId, Velocity};

/// Power f.v, W, and f.a, W/s, of every term of a body.
#[derive(Clone, Copy, Debug, Default, Pod, Zeroable)]
#[repr(C)]
struct Power {
    of_velocity: [f64; MAX_TERMS],
    of_acceleration: [f64; MAX_TERMS],
}

impl BlockSum for Power {
    fn add(&mut self, next: &Self) {
        for k in 0..MAX_TERMS {
            self.of_velocity[k] += next.of_velocity[k];
            self.of_acceleration[k] += next.of_acceleration[k];
        }
    }
}

/// The powers of the terms of a body in the last right-hand side.
struct BodyPowers {
    id: BodyId,
    terms: Vec<usize>,
    power: Power,
}

/// Data shared by the two systems.
type Powers = Shared<Vec<BodyPowers>>;

/// Adds the booking of the two kicks of what others put into `bodies`.
pub(crate) fn add_work_systems(
    sim: &mut SimBuilder<'_>,
    phase: PhaseId,
    accounts: Vec<String>,
    bodies: Shared<Vec<BodyTerms>>,
) {
    let powers = sim.share(Vec::new());
    let first = WorkOfFirstKick { accounts: accounts.clone(), powers };
    sim.add_system(
        System::new(Stage::InitialIntegrate, "pair_work_of_first_kick", first)
            .on_phases([phase])
            .before(DRIFT),
    );
    let second = WorkOfSecondKick { accounts, bodies, powers, sums: Vec::new() };
    sim.add_system(
        System::new(Stage::FinalIntegrate, "pair_work_of_second_kick", second)
            .on_phases([phase])
            // After the kick, which writes them. Conditions set velocities along axes that no force moves:
            // the order does not matter, `Adds` says so.
            .touches(Velocity::NAME, Mode::Adds)
            .reads::<Force>()
            .reads::<Mobility>(),
    );
}

/// Books half a step; `side` is -1 for the kick before the velocity, +1 for the kick after it.
fn book(step: &mut Step<'_>, accounts: &[String], body: &BodyPowers, side: f64) {
    let dt = step.clock.dt;
    let BodyPowers { id, terms, power } = body;
    for (slot, &k) in terms.iter().enumerate() {
        let account = step.ledger.account(&accounts[k], AccountKind::Dissipated);
        let mean = power.of_velocity[slot] + side * 0.25 * dt * power.of_acceleration[slot];
        step.ledger.add(account, *id, -0.5 * dt * mean);
    }
}

struct WorkOfFirstKick {
    accounts: Vec<String>,
    powers: Powers,
}

impl Run for WorkOfFirstKick {
    fn run(&mut self, step: &mut Step<'_>) -> Result<(), StepError> {
        let powers = step.resources.of(self.powers);
        powers.iter().for_each(|body| book(step, &self.accounts, body, 1.0));
        Ok(())
    }
}

struct WorkOfSecondKick {
    accounts: Vec<String>,
    bodies: Shared<Vec<BodyTerms>>,
    powers: Powers,
    sums: Vec<Power>,
}

/// A block of particles, and the forces of all terms on them.
struct WorkRows<'a> {
    velocity: &'a [Velocity],
    force: &'a [Force],
    mobility: &'a [Mobility],
    by_term: &'a [DVec3],
    terms: usize,
}

impl Split for WorkRows<'_> {
    fn rows(&self) -> usize {
        self.velocity.len()
    }

    fn split(self, at: usize) -> (Self, Self) {
        let part = |rows: std::ops::Range<usize>| Self {
            velocity: &self.velocity[rows.clone()],
            force: &self.force[rows.clone()],
            mobility: &self.mobility[rows.clone()],
            by_term: &self.by_term[rows.start * self.terms..rows.end * self.terms],
            terms: self.terms,
        };
        (part(0..at), part(at..self.velocity.len()))
    }
}

impl HotLoop for WorkRows<'_> {
    type Output = Power;

    #[inline(always)]
    fn run<A: FourLanes>(self, a: A) -> Power {
        match self.terms {
            1 => self.power::<A, 1>(a),
            2 => self.power::<A, 2>(a),
            3 => self.power::<A, 3>(a),
            4 => self.power::<A, 4>(a),
            5 => self.power::<A, 5>(a),
            6 => self.power::<A, 6>(a),
            7 => self.power::<A, 7>(a),
            _ => self.power::<A, MAX_TERMS>(a),
        }
    }
}

impl WorkRows<'_> {
    /// The powers of T terms.
    #[inline(always)]
    fn power<A: FourLanes, const T: usize>(self, a: A) -> Power {
        let count = self.velocity.len();
        let (force, mobility) = (&self.force[..count], &self.mobility[..count]);
        let by_term = &self.by_term.as_chunks::<T>().0[..count];
        let (mut of_velocity, mut of_acceleration) = ([Lanes4::ZERO; T], [Lanes4::ZERO; T]);
        for (k, v) in self.velocity.iter().enumerate() {
            let v = Lanes4::new(v.0, 0.0);
            let acceleration = a.mul(Lanes4::new(force[k].0, 0.0), Lanes4::new(mobility[k].0, 0.0));
            for slot in 0..T {
                let force = Lanes4::new(by_term[k][slot], 0.0);
                of_velocity[slot] = a.mul_add(force, v, of_velocity[slot]);
                of_acceleration[slot] = a.mul_add(force, acceleration, of_acceleration[slot]);
            }
        }
        let mut power = Power::default();
        for slot in 0..T {
            power.of_velocity[slot] = of_velocity[slot].sum();
            power.of_acceleration[slot] = of_acceleration[slot].sum();
        }
        power
    }
}

impl Run for WorkOfSecondKick {
    fn run(&mut self, step: &mut Step<'_>) -> Result<(), StepError> {
        let bodies = step.resources.of(self.bodies);
        let mut powers = step.resources.of_mut(self.powers);
        let none = || BodyPowers { id: BodyId(0), terms: Vec::new(), power: Power::default() };
        powers.resize_with(bodies.len(), none);
        for (BodyTerms { id, terms, forces }, entry) in bodies.iter().zip(powers.iter_mut()) {
            let (view, rows) = step.world.body_view(*id);
            let (velocity, force, mobility) =
                (view.read_own::<Velocity>()?, view.read_own::<Force>()?, view.read_own::<Mobility>()?);
            let read = WorkRows {
                velocity: &velocity[rows.clone()],
                force: &force[rows.clone()],
                mobility: &mobility[rows],
                by_term: forces,
                terms: terms.len(),
            };
            entry.id = *id;
            entry.terms.clone_from(terms);
            entry.power = for_each_own_block(read, &mut self.sums, &|_, block: WorkRows<'_>| run_hot(block));
            book(step, &self.accounts, entry, -1.0);
        }
        Ok(())
    }

    fn save_with(&self, resources: &Resources) -> Vec<u8> {
        let powers = resources.of(self.powers);
        let numbers = powers
            .iter()
            .map(|BodyPowers { id, terms, power }| (id.0, terms, power.of_velocity, power.of_acceleration));
        postcard::to_stdvec(&numbers.collect::<Vec<_>>()).unwrap_or_default()
    }

    fn restore_with(&mut self, state: &[u8], resources: &Resources) -> bool {
        type Saved = Vec<(usize, Vec<usize>, [f64; MAX_TERMS], [f64; MAX_TERMS])>;
        let Ok(saved) = postcard::from_bytes::<Saved>(state) else { return false };
        let bodies = saved.into_iter().map(|(id, terms, of_velocity, of_acceleration)| BodyPowers {
            id: BodyId(id),
            terms,
            power: Power { of_velocity, of_acceleration },
        });
        *resources.of_mut(self.powers) = bodies.collect();
        true
    }
}
