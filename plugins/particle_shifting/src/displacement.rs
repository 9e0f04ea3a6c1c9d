//! The displacements.

use meshless_engine::formulations::fluid::FlowCloud;
use meshless_engine::glam::DVec3;

use crate::local::Local;

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

/// Input of the shifts of a body, beside its neighbourhoods.
pub struct ShiftInput {
    /// Displacement over strain rate and first moment, `-4 s h^2 dt`, m2 s.
    factor: f64,
    /// Largest displacement, m.
    largest: f64,
}

impl ShiftInput {
    /// Those of a strength, a speed of sound, m/s, and a length of the step, s.
    pub fn new(cloud: &FlowCloud, strength: f64, sound_speed: f64, dt: f64) -> Self {
        let h = cloud.kernel.smoothing_length();
        Self { factor: -4.0 * strength * h * h * dt, largest: FASTEST * sound_speed * dt }
    }

    /// The shift of a particle, which may be inside of the fluid.
    pub fn of(&self, local: &Local, inside: bool) -> Shift {
        let Local { first_moment, toward_walls, strain_rate, .. } = *local;
        if !inside {
            return Shift::default();
        }
        // The pressure of a wall acts along its normal, and a shift along it would be spurious work. At walls
        // with suction the shift prevents a separation of the flow.
        let normal = toward_walls.normalize_or_zero();
        let shift = first_moment * (self.factor * strain_rate);
        let along = shift - normal * normal.dot(shift);
        Shift { displacement: along.clamp_length_max(self.largest), inside: true }
    }
}
