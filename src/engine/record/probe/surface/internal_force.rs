//! The force of a body on its own particles: what is left of the whole force acts on its surface.

use glam::DVec3;

use crate::column;
use crate::fields::is_of_stress;
use crate::plugin::{BodyPlan, SimBuilder};
use crate::scene::{Probe, Quantity, Select};
use crate::schedule::{Stage, Step, System};
use crate::world::{BodyId, BodySet, Force};

/// Label of the system that keeps it.
const INTERNAL_FORCE: &str = "internal_force";

column! {
    /// Force on the particle by its body and by body forces: the whole force without loads on surfaces,
    /// contacts, and fluids.
    pub struct ForceOfBody(DVec3) = "internal_force", "f_int", "N";
}

/// Keeps the internal forces of the bodies at whose surfaces a probe of the scene measures a stress.
pub(in crate::record) fn add_system(sim: &mut SimBuilder<'_>) {
    let bodies = BodySet::new(sim.scene().probes.iter().flat_map(|probe| measured(probe, sim)));
    if bodies.iter().next().is_none() {
        return;
    }
    sim.add_column_to::<ForceOfBody>(&bodies);
    let phases = sim.phases_of(&bodies);
    let all = phases.clone();
    let keep = move |step: &mut Step<'_>| {
        for phase in &all {
            let view = step.world.phase(*phase);
            let force = view.read::<Force>()?;
            let force: &[DVec3] = bytemuck::cast_slice(&force);
            bytemuck::cast_slice_mut(&mut view.write::<ForceOfBody>()?).copy_from_slice(force);
        }
        Ok(())
    };
    // What writes to the force runs before what adds to it, as this has to, although it only reads. Forces on
    // the volume are the only ones from outside that a free surface may have.
    let system = System::new(Stage::External, INTERNAL_FORCE, keep).on_phases(phases).after_any("BodyForce");
    sim.add_system(system.writes::<Force>().writes::<ForceOfBody>());
}

/// The bodies at whose surfaces a probe measures a stress.
fn measured(probe: &Probe, sim: &SimBuilder<'_>) -> Vec<BodyId> {
    let Quantity::Field(name) = &probe.quantity else { return Vec::new() };
    if !is_of_stress(name) {
        return Vec::new();
    }
    let on_surface = |on: &Option<Select>| on.as_ref().filter(|on| on.surface.is_some()).cloned();
    let second = probe.relative_to.as_ref();
    let places =
        [(&probe.on, &probe.follows)].into_iter().chain(second.map(|second| (&second.on, &second.follows)));
    let bodies = places.flat_map(|(on, follows)| {
        let surface = on_surface(on);
        let is_meant = move |body: &&BodyPlan| {
            let names = surface.as_ref().map(|on| on.body.as_ref()).or(follows.as_ref().map(Some));
            names.is_some_and(|name| name.is_none_or(|name| body.name == *name))
        };
        sim.bodies().iter().filter(is_meant).filter(|body| body.kernel.is_some()).map(|body| body.id)
    });
    bodies.collect()
}
