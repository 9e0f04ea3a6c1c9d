//! The system that computes the forces of a flow, and their opposite on the boundary particles.

use glam::DVec3;

use crate::formulations::fluid::cloud::{
    ACCOUNTS, EDGES, ENDS, FLOW_RECORDS, FlowCloud, GAP_FORCES, PARTS, REPELLED, Role, SPINS,
};
use crate::formulations::fluid::moments::SurfaceMoments;
use crate::pair::{BodyTerms, PhaseTerms};
use crate::parallel::{for_each_own_block, share_wide_rows, sum_over_blocks};
use crate::schedule::{AccountKind, Mode, Run, Shared, Step, StepError, System};
use crate::world::{Force, Mass, PhaseId, Removed};

/// Label of the system that computes the forces of fluids and walls.
pub const FLUID_FORCE: &str = "fluid_force";

/// Declares the reads of the force of a flow, beside those of the particles.
pub fn reads_flow(system: System) -> System {
    system
        .touches_packed(FLOW_RECORDS, Mode::ReadsNear)
        .touches_packed(SPINS, Mode::ReadsNear)
        .touches_packed(REPELLED, Mode::Reads)
        .touches_packed(GAP_FORCES, Mode::Reads)
        .touches_packed(EDGES, Mode::Reads)
        .touches_packed(ENDS, Mode::Reads)
        .reads_own_packed()
}

/// Makes the forces on the particles of one phase.
pub struct FlowForce {
    pub phase: PhaseId,
    /// Acceleration of gravity, m/s2; none where another system has given the particles their weight.
    pub gravity: Option<DVec3>,
    /// The parts of the force on each body, for the booking of their work.
    pub parts: Shared<Vec<BodyTerms>>,
    pub moments: SurfaceMoments,
    /// Pair terms of plugins, run in the same pass.
    pub terms: Option<PhaseTerms>,
}

/// Friction on all particles of a group, N, of the parts of the force on each.
pub fn friction_on(rows: &[Force], parts: &[DVec3]) -> DVec3 {
    sum_over_blocks(rows, &|first, rows: &[Force]| {
        (first..first + rows.len()).map(|k| parts[PARTS * k]).sum::<DVec3>()
    })
}

impl Run for FlowForce {
    fn run(&mut self, step: &mut Step<'_>) -> Result<(), StepError> {
        let flows = self.gravity.is_some();
        let resources = step.resources;
        let cloud = resources.get::<FlowCloud>();
        let view = step.world.phase(self.phase);
        let (mass, removed) = (view.read::<Mass>()?, view.read::<Removed>()?);
        let mut force = view.write_own::<Force>()?;
        let mut parts = step.resources.of_mut(self.parts);
        let groups = cloud.groups.iter().filter(|group| group.phase == self.phase);
        for (group, BodyTerms { forces, .. }) in groups.zip(parts.iter_mut()) {
            forces.resize(PARTS * group.rows.len(), DVec3::ZERO);
            let total = &mut force[group.rows.clone()];
            let terms = self.terms.as_mut().filter(|terms| terms.act_on(group.body));
            match terms {
                Some(terms) => cloud.force_with(group, terms, step, total, forces)?,
                None => cloud.own_force(group, !flows, total, forces),
            }
            self.moments.add(&cloud, group, total, forces);
            cloud.repel(group, total, forces);
            cloud.press_gaps(group, total, forces);
            cloud.add_edge_forces(group, total, forces);
            cloud.let_go(group, total);
            if let Some(gravity) = self.gravity {
                let rows = (&mut *total, &mass[group.rows.clone()], &removed[group.rows.clone()]);
                type Rows<'a> = (&'a mut [Force], &'a [Mass], &'a [Removed]);
                for_each_own_block(rows, &mut Vec::new(), &|_, (f, m, removed): Rows<'_>| {
                    let (m, removed) = (&m[..f.len()], &removed[..f.len()]);
                    for (k, f) in f.iter_mut().enumerate() {
                        // Without a branch.
                        let mass = if removed[k] == Removed::NO { m[k].0 } else { 0.0 };
                        f.0 += gravity * mass;
                    }
                });
            }
            if let Role::Boundary(surface) = &group.role
                && surface.velocity != DVec3::ZERO
            {
                share_wide_rows(forces, PARTS);
                // What drives a belt does the work that friction turns into heat.
                let friction = friction_on(total, forces);
                let work = -friction.dot(surface.velocity) * step.clock.dt;
                let supplied = step.ledger.account("constraints", AccountKind::Supplied);
                let dissipated = step.ledger.account(ACCOUNTS[0], AccountKind::Dissipated);
                step.ledger.add(supplied, group.body, work);
                step.ledger.add(dissipated, group.body, work);
            }
        }
        Ok(())
    }
}
