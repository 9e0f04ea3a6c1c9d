//! Notes of `check` on the set-up of a scene.

use meshless_engine::notation::{count, number};
use meshless_engine::plugin::BodyKind;
use meshless_engine::scene::{Probe, Quantity, Scene};
use meshless_engine::simulation::Simulation;

use super::body::BodyReport;
use super::support;
use super::trial::TrialSteps;

/// Number of particles across a solid below which its bending is too stiff.
const ACROSS: f64 = 4.0;
/// Number of sub-steps of solids in a step of the fluid above which their cost dominates.
const MANY_SUB_STEPS: u32 = 50;
/// Steps in which a sound wave travels a few spacings.
const STEPS_OF_SOUND: f64 = 4.0;

/// Notes on the scene; they do not keep it from running.
pub fn notes(scene: &Scene, bodies: &[BodyReport], sim: &Simulation, trial: &TrialSteps) -> Vec<String> {
    let mut notes: Vec<String> = bodies.iter().flat_map(of_body).collect();
    notes.extend(support::notes(scene, sim));
    notes.extend(scene.probes.iter().filter_map(|probe| of_probe(probe, scene, sim)));
    if let Some((sub_steps, _)) = sim.sub_steps().filter(|(sub_steps, _)| *sub_steps > 1) {
        let limit = sim.short_limit().map(|limit| format!(", limited by {}", limit.by)).unwrap_or_default();
        let costly = match sub_steps >= MANY_SUB_STEPS {
            true => "; a softer material or a coarser solid costs less",
            false => "",
        };
        notes.push(format!(
            "solids take {} in each step of the fluid{limit}{costly}",
            count(u64::from(sub_steps), "sub-step")
        ));
    }
    if bodies.iter().any(|body| body.plastic) {
        notes.push(format!(
            "{} is a lower bound: plastic flow compresses particles, and the step shrinks with them",
            count(trial.expected_steps(sim) as u64, "step")
        ));
    }
    notes
}

/// Note on a probe that samples the force of a fluid at longer intervals than its acoustic period.
fn of_probe(probe: &Probe, scene: &Scene, sim: &Simulation) -> Option<String> {
    let is_force = matches!(probe.quantity, Quantity::FluidForce | Quantity::FluidTorque { .. });
    let seldom = scene.probe_interval(probe) > STEPS_OF_SOUND * sim.clock().dt;
    (is_force && seldom && !probe.mean).then(|| {
        format!(
            "probe `{}` catches the force of a flow at single times; where the flow hits something this rings with its sound, and the samples have another mean: \
             `mean: true` makes each of them the mean since the last one",
            probe.name
        )
    })
}

fn of_body(body: &BodyReport) -> Vec<String> {
    let has = |plugin: &str| body.plugins.iter().any(|name| name == plugin);
    let name = &body.name;
    let mut notes = Vec::new();
    let is_solid = body.kind == Some(BodyKind::Solid);
    if is_solid && !has("hourglass_control") && !has("hessian_stabilization") {
        notes.push(format!(
            "body `{name}` has no `hourglass_control`: zero-energy modes can grow, above all under large strain"
        ));
    }
    if body.kind == Some(BodyKind::Fluid) && !has("density_diffusion") {
        notes.push(format!("fluid `{name}` has no `density_diffusion`: its pressure will be noisy"));
    }
    if is_solid && body.driven {
        notes.push(format!(
            "conditions move all of body `{name}`, whose stiffness limits the time step all the same: `formulation: Rigid()` moves alike and limits none, \
             if its stresses do not matter"
        ));
    }
    if is_solid && body.across < ACROSS - 0.5 {
        notes.push(format!(
            "body `{name}` has {} particles across its smallest side: at least {} resolve its bending",
            number(body.across.round()),
            number(ACROSS)
        ));
    }
    notes
}
