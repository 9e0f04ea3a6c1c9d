//! The one system that removes particles from a run.
//!
//! A removed particle keeps its row and its position: [`Removed`] is set, its velocity, force and mobility are zero, mass and volume stay
//! for the energy balance. Formulations, contacts and conditions leave such rows out. Its kinetic energy
//! goes to the account `removed`, and so does the energy of its bonds and
//! contacts, which formulation and contact book.

use glam::DVec3;

use super::domain::{DomainBox, RemoveOutside};
use super::leaving::Leaving;
use crate::plugin::SimBuilder;
use crate::scene::Outside;
use crate::schedule::{AccountKind, Run, Stage, Step, StepError, System};
use crate::world::{BodyId, Force, Mass, Mobility, Position, Removed, Velocity};

/// Label of the system of stage [`Stage::Neighbors`] that removes particles. It is always there: lists of neighbours are
/// made `.after(REMOVAL)`.
pub const REMOVAL: &str = "removal";

/// Account of the energy that leaves with removed particles.
pub const REMOVED_ENERGY: &str = "removed";

/// Says which particles are to be taken out of the run. Plugins add one with [`SimBuilder::add_removal_rule`].
pub trait RemovalRule: Send + 'static {
    /// Appends the rows of the body that are to go, ascending; rows that are out already may be named again.
    ///
    /// # Errors
    /// A column is missing.
    fn rows(&mut self, step: &Step<'_>, body: BodyId, out: &mut Vec<u32>) -> Result<(), StepError>;
}

impl SimBuilder<'_> {
    /// Adds a rule that removes particles, looked at in every step after the drift and before lists and forces.
    pub fn add_removal_rule(&mut self, rule: impl RemovalRule) {
        self.extend::<Box<dyn RemovalRule>>(Box::new(rule));
    }
}

/// Adds the system, with the rules of plugins and that of the domain.
pub fn add_system(sim: &mut SimBuilder<'_>) {
    let mut rules: Vec<Box<dyn RemovalRule>> = sim.take_extensions();
    if let Some(domain) = DomainBox::of_scene(sim).filter(|domain| domain.outside == Outside::Remove) {
        rules.push(Box::new(RemoveOutside::new(domain)));
    }
    sim.add_system(
        System::new(Stage::Neighbors, REMOVAL, Removal { rules, rows: Vec::new() })
            .reads::<Position>()
            .reads::<Mass>()
            .writes::<Removed>()
            .writes::<Velocity>()
            .writes::<Force>()
            .writes::<Mobility>(),
    );
}

struct Removal {
    rules: Vec<Box<dyn RemovalRule>>,
    rows: Vec<u32>,
}

impl Run for Removal {
    fn run(&mut self, step: &mut Step<'_>) -> Result<(), StepError> {
        if !self.rules.is_empty() {
            // From the first step on, so that the tables of energies have a column for it.
            step.ledger.account(REMOVED_ENERGY, AccountKind::Dissipated);
        }
        for phase in step.world.phases() {
            if let Some(mut leaving) = step.resources.try_get_mut_of::<Leaving>(phase) {
                leaving.clear();
            }
        }
        for rule in &mut self.rules {
            for body in (0..step.world.bodies().len()).map(BodyId) {
                self.rows.clear();
                rule.rows(step, body, &mut self.rows)?;
                remove(step, body, &self.rows)?;
            }
        }
        Ok(())
    }
}

fn remove(step: &mut Step<'_>, body: BodyId, rows: &[u32]) -> Result<(), StepError> {
    if rows.is_empty() {
        return Ok(());
    }
    let (view, _) = step.world.body_view(body);
    let mut leaving = step.resources.try_get_mut_of::<Leaving>(step.world.body(body).phase);
    let mut removed = view.write::<Removed>()?;
    let mut velocity = view.write::<Velocity>()?;
    let mut force = view.write::<Force>()?;
    let mut mobility = view.write::<Mobility>()?;
    let mass = view.read::<Mass>()?;
    let due = step.turn.is_due(step.world, body);
    let mut kinetic = 0.0;
    for row in rows.iter().map(|&row| row as usize) {
        if removed[row] == Removed::YES {
            continue;
        }
        // The velocity is that of mid-step, the account of kinetic energy is taken at its end; bodies that take sub-steps are there.
        let kick = if due { 0.5 * step.clock.dt * (force[row].0 * mobility[row].0) } else { DVec3::ZERO };
        let v = velocity[row].0;
        kinetic += 0.5 * mass[row].0 * (v.length_squared() + kick.length_squared());
        match &mut leaving {
            // What the new forces would take from the motion is booked by those who make them.
            Some(leaving) if due => leaving.push(row as u32, v),
            _ => kinetic += mass[row].0 * v.dot(kick),
        }
        removed[row] = Removed::YES;
        velocity[row] = Velocity(DVec3::ZERO);
        force[row] = Force(DVec3::ZERO);
        mobility[row] = Mobility(DVec3::ZERO);
    }
    let account = step.ledger.account(REMOVED_ENERGY, AccountKind::Dissipated);
    step.ledger.add(account, body, kinetic);
    if !due {
        let held = step.ledger.account("kinetic", AccountKind::Stored);
        step.ledger.add(held, body, -kinetic);
    }
    Ok(())
}
