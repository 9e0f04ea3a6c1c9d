//! The frequency of the motion of the last step, from the forces that the motion has changed.

use glam::DVec3;
use meshless_engine::parallel::{BlockSum, sum_over_blocks};
use meshless_engine::schedule::{Step, StepError};
use meshless_engine::world::{BodyId, Force, Mass, Mobility, Velocity};

meshless_engine::column! {
    /// Force at the end of the step before.
    pub struct PreviousForce(DVec3) = "previous_force", "f_n", "N";
}

/// Motion of some particles in the last step, along their free axes.
#[derive(Clone, Copy, Debug, Default)]
pub struct LastMotion {
    /// Work of the change of force on the displacement, with the sign of a resistance: - sum dx . df, J.
    pub resistance: f64,
    /// sum m dx^2, kg m2.
    pub inertia: f64,
    /// Twice the kinetic energy, J.
    pub twice_kinetic: f64,
    /// sum f^2 / m, N2/kg: over 2 omega^2 it is the energy of the forces out of balance.
    pub unbalance: f64,
}

impl BlockSum for LastMotion {
    fn add(&mut self, next: &Self) {
        self.resistance += next.resistance;
        self.inertia += next.inertia;
        self.twice_kinetic += next.twice_kinetic;
        self.unbalance += next.unbalance;
    }
}

/// Evaluates the last step of a body, and keeps its forces for the next evaluation.
pub fn look(step: &Step<'_>, id: BodyId) -> Result<LastMotion, StepError> {
    let (view, rows) = step.world.body_view(id);
    let force = view.read::<Force>()?;
    let velocity = view.read::<Velocity>()?;
    let mass = view.read::<Mass>()?;
    let mobility = view.read::<Mobility>()?;
    let mut previous = view.write::<PreviousForce>()?;
    let dt = step.clock.dt;
    let slices = (
        &mut previous[rows.clone()],
        &force[rows.clone()],
        &velocity[rows.clone()],
        &mass[rows.clone()],
        &mobility[rows],
    );
    type Rows<'a> = (&'a mut [PreviousForce], &'a [Force], &'a [Velocity], &'a [Mass], &'a [Mobility]);
    Ok(sum_over_blocks(slices, &|_, (previous, f, v, m, mobility): Rows<'_>| {
        let mut motion = LastMotion::default();
        for k in 0..f.len() {
            let free = DVec3::select(mobility[k].0.cmpgt(DVec3::ZERO), DVec3::ONE, DVec3::ZERO);
            // The drift of this step: the velocity before the last half kick.
            let moved = dt * free * (v[k].0 - 0.5 * dt * f[k].0 / m[k].0);
            motion.resistance -= moved.dot(f[k].0 - previous[k].0);
            motion.inertia += m[k].0 * moved.length_squared();
            motion.twice_kinetic += m[k].0 * (free * v[k].0).length_squared();
            motion.unbalance += (free * f[k].0).length_squared() / m[k].0;
            previous[k] = PreviousForce(f[k].0);
        }
        motion
    }))
}
