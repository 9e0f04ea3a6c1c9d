//! Fluids whose motion is prescribed, where a start or an inlet is meant.

use crate::plugin::{BodyKind, BodyPlan, Selection, SimBuilder};

/// Warns of fluid particles that a condition drives for the whole run.
pub(super) fn warn(name: &str, selection: &Selection, sim: &mut SimBuilder<'_>) {
    let bodies = selection.parts.iter().map(|(id, _)| sim.body(*id));
    let warning = |body: &BodyPlan| {
        format!(
            "`{name}` drives those particles of the fluid `{}` that it selects at the start for the whole run, wherever they are: for a velocity to start with give the body \
             `velocity`, or an `InitialVelocity`; an inflow is driven by a `Wall` as a piston, or in a periodic domain by `RelaxationZone` or `MeanVelocity`",
            body.name
        )
    };
    let warnings: Vec<String> = bodies.filter(|body| body.kind == BodyKind::Fluid).map(warning).collect();
    warnings.into_iter().for_each(|warning| sim.warn(warning));
}
