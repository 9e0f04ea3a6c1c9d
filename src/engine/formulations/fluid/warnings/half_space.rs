//! Fluids that fall through a half-space: a tool without end has no particles that could bound a flow.

use glam::DVec3;

use super::intrusion::DEPTH;
use crate::formulations::fluid::cloud::FlowCloud;
use crate::notation::{place, quantity};
use crate::rigid::RigidBodies;
use crate::schedule::Step;

/// Warns, once, of the first half-space that a particle of a fluid is in; `spacing` is that of the fluid, m.
pub fn look(is_told: &mut bool, cloud: &FlowCloud, spacing: f64, step: &mut Step<'_>) {
    if *is_told {
        return;
    }
    let Some(bodies) = step.resources.try_get::<RigidBodies>() else { return };
    for body in bodies.iter().filter(|body| !body.surface.bounds().is_bounded()) {
        for fluid in cloud.groups.iter().filter(|group| group.fluid().is_some()) {
            let there = cloud.records[fluid.cloud.clone()].iter().filter(|record| record.volume() > 0.0);
            let is_in =
                |x: &DVec3| body.surface.closest(body.reference(*x)).signed_distance < -DEPTH * spacing;
            let Some(x) = there.map(|record| record.position()).find(is_in) else { continue };
            let name = |id| &step.world.body(id).name;
            step.warnings.push(format!(
                "`{0}` falls into `{1}`, at {2} and {3}: fluids do not see a half-space; bound `{0}` by a body of \
                 `formulation: Wall()` whose shape has an end, such as a `Box` at least three spacings thick",
                name(fluid.body),
                name(body.id),
                place(x),
                quantity(step.clock.time, "s")
            ));
            *is_told = true;
            return;
        }
    }
}
