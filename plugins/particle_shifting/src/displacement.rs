//! The displacements.

use meshless_engine::formulations::fluid::FlowCloud;
use meshless_engine::glam::DVec3;

use crate::local::Local;

/// Smallest eigenvalue above which a particle can be inside the fluid (Marrone et al., J. Comput. Phys. 229 (2010) 3652-3663).
const INSIDE: f64 = 0.75;
/// Smallest eigenvalue below which a particle is at a free surface or beside a hole: its neighbours are not inside.
const OUTERMOST: f64 = 0.65;
/// Largest speed of the shift over the speed of sound: a twentieth of the spacing in the longest step.
const FASTEST: f64 = 1.0 / 12.0;

/// The shift of a particle.
#[derive(Clone, Copy, Debug, Default)]
pub struct Shift {
    /// Displacement in this step, m.
    pub displacement: DVec3,
    /// Whether no free surface is near. Only such particles are shifted.
    pub inside: bool,
}

/// Marks the particles that have one at a free surface or beside a hole among their neighbours. These are few, so that it costs less to go out from them than to look
/// at the neighbours of all particles.
pub fn mark_surfaces(cloud: &FlowCloud, locals: &[Local], near_surface: &mut [bool]) {
    near_surface.fill(false);
    let outermost = |i: &usize| locals[*i].lambda < OUTERMOST && cloud.volume(*i) > 0.0;
    for i in (0..locals.len()).filter(outermost) {
        cloud.for_each_neighbor(i, |near| {
            if let Some(mark) = near_surface.get_mut(near.row) {
                *mark = true;
            }
        });
    }
}

/// What the shifts of a body depend on beside its neighbourhoods.
pub struct Displacements {
    /// Displacement over strain rate and first moment, `-4 s h^2 dt`, m2 s.
    factor: f64,
    /// Largest displacement, m.
    largest: f64,
}

impl Displacements {
    /// Those of a strength, a speed of sound, m/s, and a length of the step, s.
    pub fn new(cloud: &FlowCloud, strength: f64, sound_speed: f64, dt: f64) -> Self {
        let h = cloud.kernel.smoothing_length();
        Self { factor: -4.0 * strength * h * h * dt, largest: FASTEST * sound_speed * dt }
    }

    /// The shift of a particle.
    pub fn of(&self, local: &Local, near_surface: bool) -> Shift {
        let Local { lambda, first_moment, toward_walls, strain_rate, .. } = *local;
        if lambda < INSIDE || near_surface {
            return Shift::default();
        }
        // The pressure of a wall works along its normal, and a shift along it would be work that nobody does. Where walls pull, it keeps them from tearing the flow off.
        let normal = toward_walls.normalize_or_zero();
        let shift = first_moment * (self.factor * strain_rate);
        let along = shift - normal * normal.dot(shift);
        Shift { displacement: along.clamp_length_max(self.largest), inside: true }
    }
}
