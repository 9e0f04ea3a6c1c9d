//! The one system that removes particles from a run.
//!
//! A removed particle keeps its row and its position: [`Removed`] is set, its velocity, force and mobility
//! are zero, mass and volume stay for the energy balance. Formulations, contacts and conditions leave such
//! rows out. Its kinetic energy goes to the account `removed`, and so does the energy of its bonds and
//! contacts, which formulation and contact book.
//!
//! Bodies that take sub-steps lose particles in the last of a long step: what computes their forces then
//! sees all of them at the same time, with those that go and without them, and a flow sees the losses at the
//! end of its step.

use glam::DVec3;

use super::domain::{DomainBox, RemoveOutside};
use super::leaving::{LEAVING, LeavingParticles};
use super::rule::RemovalRule;
use crate::notation::quantity;
use crate::parallel::{Picked, sum_over_blocks};
use crate::plugin::SimBuilder;
use crate::rigid::{RIGID_BODIES, take_out};
use crate::scene::Outside;
use crate::schedule::{Access, AccountKind, Mode, REMOVED_ENERGY, Run, Stage, Step, StepError, System};
use crate::world::{
    BodyId, BodySet, Force, Mass, Mobility, PhaseView, Position, Removed, Velocity, sum_by_row,
};

/// Label of the system of stage [`Stage::Neighbors`] that removes particles. It is always there: lists of
/// neighbours are made `.after(REMOVAL)`.
pub const REMOVAL: &str = "removal";

impl SimBuilder<'_> {
    /// Adds a rule that removes particles, looked at in every step after the drift and before lists and
    /// forces.
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
    let phases = sim.phases_of(&BodySet::new(sim.bodies().iter().map(|body| body.id)));
    let gravity = sim.gravity();
    let columns: Vec<Access> = rules.iter().flat_map(|rule| rule.access()).collect();
    sim.add_system(
        System::new(Stage::Neighbors, REMOVAL, Removal { rules, gravity, rows: Vec::new() })
            .on_phases(phases)
            .by_body()
            .touches_all(columns)
            .reads::<Position>()
            .reads::<Mass>()
            .writes::<Removed>()
            .writes::<Velocity>()
            .writes::<Force>()
            .writes::<Mobility>()
            .touches(LEAVING, Mode::Writes)
            .touches_packed(RIGID_BODIES, Mode::Writes),
    );
}

struct Removal {
    rules: Vec<Box<dyn RemovalRule>>,
    gravity: DVec3,
    rows: Vec<u32>,
}

impl Run for Removal {
    fn run(&mut self, step: &mut Step<'_>) -> Result<(), StepError> {
        if !self.rules.is_empty() {
            // From the first step on, so that the tables of energies have a column for it.
            step.ledger.account(REMOVED_ENERGY, AccountKind::Dissipated);
        }
        leaving_of_phases(step, LeavingParticles::clear);
        if !step.part.is_last() {
            return Ok(());
        }
        for rule in &mut self.rules {
            for body in (0..step.world.bodies().len()).map(BodyId) {
                if !step.part.is_due(step.world, body) {
                    continue;
                }
                self.rows.clear();
                rule.rows(step, body, &mut self.rows)?;
                if !self.rows.is_empty() {
                    keep_present(step, body, &mut self.rows)?;
                    remove(step, body, &self.rows, self.gravity)?;
                }
            }
        }
        leaving_of_phases(step, LeavingParticles::sort);
        Ok(())
    }
}

/// Changes the list of what leaves of every phase that has one and moves in this part of the step.
fn leaving_of_phases(step: &Step<'_>, change: impl Fn(&mut LeavingParticles)) {
    for phase in step.world.phases().filter(|&phase| step.part.moves(phase)) {
        if let Some(mut leaving) = step.resources.try_get_mut_of::<LeavingParticles>(phase) {
            change(&mut leaving);
        }
    }
}

/// Leaves only rows of a body that are there, each once and ascending.
fn keep_present(step: &Step<'_>, body: BodyId, rows: &mut Vec<u32>) -> Result<(), StepError> {
    let removed = step.world.body_view(body).0.read::<Removed>()?;
    rows.retain(|row| removed[*row as usize] == Removed::NO);
    rows.sort_unstable();
    rows.dedup();
    Ok(())
}

/// Removes rows of a body, ascending, that are there.
fn remove(step: &mut Step<'_>, body: BodyId, rows: &[u32], gravity: DVec3) -> Result<(), StepError> {
    if rows.is_empty() {
        return Ok(());
    }
    let (view, own) = step.world.body_view(body);
    let mut leaving = step.resources.try_get_mut_of::<LeavingParticles>(step.world.body(body).phase);
    let kinetic = {
        let (velocity, force) = (view.read::<Velocity>()?, view.read::<Force>()?);
        let (mobility, mass) = (view.read::<Mobility>()?, view.read::<Mass>()?);
        let (velocity, force, mobility, mass) = (&velocity[..], &force[..], &mobility[..], &mass[..]);
        if let Some(leaving) = leaving.as_mut() {
            rows.iter().for_each(|&row| leaving.push(row, velocity[row as usize].0));
        }
        // The last kick is that of forces which are only made after they have gone. The system that computes
        // them books what it would take from the motion, if they ask who leaves; the work of gravity is
        // booked already.
        let kick_takes = leaving.is_none();
        let half_step = 0.5 * step.clock.dt;
        sum_by_row(own.len(), rows.len(), &|k| rows[k] as usize - own.start, &|k| {
            let row = rows[k] as usize;
            // The velocity is that of mid-step, the account of kinetic energy is taken at its end.
            let v = velocity[row].0;
            let kick = half_step * (force[row].0 * mobility[row].0);
            let power = 2.0 * v.dot(if kick_takes { kick } else { half_step * gravity });
            0.5 * mass[row].0 * (v.length_squared() + kick.length_squared() + power)
        })
    };
    let kinetic = take_out(step, body).unwrap_or(kinetic);
    clear(&view, rows)?;
    if view.read::<Removed>()?[own].iter().all(|row| *row == Removed::YES) {
        step.warnings.push(format!(
            "all particles of `{}` have been removed by {}: is there something that should have held them?",
            step.world.body(body).name,
            quantity(step.clock.end(), "s")
        ));
    }
    let account = step.ledger.account(REMOVED_ENERGY, AccountKind::Dissipated);
    step.ledger.add(account, body, kinetic);
    Ok(())
}

/// Marks rows as removed: nothing moves them from now on.
fn clear(view: &PhaseView<'_>, rows: &[u32]) -> Result<(), StepError> {
    let (mut removed, mut velocity) = (view.write::<Removed>()?, view.write::<Velocity>()?);
    let (mut force, mut mobility) = (view.write::<Force>()?, view.write::<Mobility>()?);
    let kinematics = (Picked::new(rows, &mut removed), Picked::new(rows, &mut velocity));
    let dynamics = (Picked::new(rows, &mut force), Picked::new(rows, &mut mobility));
    type Kinematics<'a> = (Picked<'a, Removed>, Picked<'a, Velocity>);
    type Dynamics<'a> = (Picked<'a, Force>, Picked<'a, Mobility>);
    type Rows<'a> = (Kinematics<'a>, Dynamics<'a>);
    sum_over_blocks((kinematics, dynamics), &|_, (kinematics, dynamics): Rows<'_>| {
        let ((mut removed, mut velocity), (mut force, mut mobility)) = (kinematics, dynamics);
        for k in 0..removed.len() {
            *removed.row(k) = Removed::YES;
            *velocity.row(k) = Velocity(DVec3::ZERO);
            *force.row(k) = Force(DVec3::ZERO);
            *mobility.row(k) = Mobility(DVec3::ZERO);
        }
    });
    Ok(())
}
