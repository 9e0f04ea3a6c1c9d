//! The force of the flow that acts on bodies in their sub-steps.

use super::exchange::CouplingForce;
use crate::plugin::SimBuilder;
use crate::removal::{LEAVING, LeavingParticles, REMOVED_ENERGY};
use crate::schedule::{AccountKind, Adds, EachRow, Mode, Run, Stage, Step, StepError, System};
use crate::world::{BodySet, Force, PhaseId, Removed};

/// Adds the system for a phase of bodies.
pub fn add(sim: &mut SimBuilder<'_>, bodies: &BodySet, phase: PhaseId, label: &str) {
    sim.add_system(
        System::new(Stage::External, format!("{label}_frozen"), FrozenForce { bodies: bodies.clone() })
            .on_phases([phase])
            .reads::<CouplingForce>()
            .reads::<Removed>()
            .touches(LEAVING, Mode::Reads)
            .adds::<Force>(),
    );
}

struct FrozenForce {
    bodies: BodySet,
}

impl Run for FrozenForce {
    fn run(&mut self, step: &mut Step<'_>) -> Result<(), StepError> {
        for body in step.part.due(step.world, &self.bodies) {
            let (view, rows) = step.world.body_view(body);
            type Columns<'c> = (Adds<Force>, &'c CouplingForce, &'c Removed);
            Columns::for_each(&view, rows.clone(), &|(force, frozen, removed)| {
                if *removed == Removed::NO {
                    force.0 += frozen.0;
                }
            })?;
            let phase = step.world.body(body).phase;
            let Some(leaving) = step.resources.try_get_of::<LeavingParticles>(phase) else { continue };
            // Its work is booked for all of their way; the last kick would have spent its half of it.
            let frozen = view.read::<CouplingForce>()?;
            let power = leaving.power(&rows, bytemuck::cast_slice(&frozen));
            if power != 0.0 {
                let removed = step.ledger.account(REMOVED_ENERGY, AccountKind::Dissipated);
                step.ledger.add(removed, body, 0.5 * step.clock.dt * power);
            }
        }
        Ok(())
    }
}
