//! Loads on fluids for the pressure of walls, which increases along every acceleration that acts on the
//! fluid.

use std::sync::Arc;

use glam::DVec3;

use super::load_law::LoadLaw;
use super::part::Part;
use crate::formulations::fluid::{FLOW_LOADS, FlowCloud};
use crate::plugin::{BodyKind, SimBuilder};
use crate::schedule::{Mode, Run, Stage, Step, StepError, System};
use crate::world::{Mass, ParticleId, PhaseId, Position};

/// Adds the system that passes a load on to fluids with boundaries.
/// `declare` adds the columns that the law reads.
pub(super) fn add(
    label: &str,
    law: &Arc<dyn LoadLaw>,
    parts: &[Part],
    sim: &mut SimBuilder<'_>,
    declare: impl FnOnce(System) -> System,
) {
    let is_fluid = |part: &Part| sim.body(part.body).kind == BodyKind::Fluid;
    let parts: Vec<(usize, Part)> =
        parts.iter().cloned().enumerate().filter(|(_, part)| is_fluid(part)).collect();
    let has_walls = sim.bodies().iter().any(|body| body.kind != BodyKind::Fluid);
    if parts.is_empty() || !has_walls {
        return;
    }
    let mut phases: Vec<PhaseId> = parts.iter().map(|(_, part)| sim.body(part.body).phase).collect();
    phases.dedup();
    let accelerations = vec![Vec::new(); parts.len()];
    let load = FlowLoad { law: Arc::clone(law), parts, accelerations };
    let system = System::new(Stage::Gradients, format!("{label}_of_flow"), load);
    let system = system.on_phases(phases).touches_packed(FLOW_LOADS, Mode::Adds);
    sim.add_system(declare(system.reads::<Position>().reads::<Mass>().reads::<ParticleId>()));
}

struct FlowLoad {
    law: Arc<dyn LoadLaw>,
    /// The parts that flow, with their numbers in the load.
    parts: Vec<(usize, Part)>,
    /// Accelerations of each, m/s2; empty before the first step.
    accelerations: Vec<Vec<DVec3>>,
}

impl Run for FlowLoad {
    fn run(&mut self, step: &mut Step<'_>) -> Result<(), StepError> {
        for ((k, part), accelerations) in self.parts.iter_mut().zip(&mut self.accelerations) {
            part.follow(step.world, accelerations)?;
            if accelerations.is_empty() || !self.law.is_constant(part) {
                part.locate(step.world)?;
                self.law.forces(*k, part, step, accelerations)?;
                let mass = step.world.phase(step.world.body(part.body).phase).read::<Mass>()?;
                for (acceleration, &row) in accelerations.iter_mut().zip(&part.rows) {
                    *acceleration /= mass[row as usize].0;
                }
            }
            step.resources.get_mut::<FlowCloud>().add_loads(part.body, &part.rows, accelerations);
        }
        Ok(())
    }
}
