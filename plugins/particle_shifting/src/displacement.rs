//! The displacements.

use meshless_engine::formulations::fluid::{FlowCloud, RowPass};
use meshless_engine::glam::DVec3;
use meshless_engine::parallel::Arithmetic;

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

/// The shifts of the particles of one body.
pub struct Displacements<'a> {
    cloud: &'a FlowCloud,
    locals: &'a [Local],
    /// Displacement over strain rate and first moment, `-4 s h^2 dt`, m2 s.
    factor: f64,
    /// Largest displacement, m.
    largest: f64,
}

impl<'a> Displacements<'a> {
    /// The pass for a strength, a speed of sound, m/s, and a length of the step, s.
    pub fn new(
        cloud: &'a FlowCloud,
        locals: &'a [Local],
        (strength, sound_speed, dt): (f64, f64, f64),
    ) -> Self {
        let h = cloud.kernel.smoothing_length();
        let largest = FASTEST * sound_speed * dt;
        Self { cloud, locals, factor: -4.0 * strength * h * h * dt, largest }
    }
}

impl RowPass for Displacements<'_> {
    type Output = Shift;

    #[inline(always)]
    fn row<A: Arithmetic>(&self, a: A, i: usize) -> Shift {
        let Self { cloud, locals, .. } = *self;
        let Local { lambda, first_moment, toward_walls, strain_rate, .. } = locals[i];
        if lambda < INSIDE {
            return Shift::default();
        }
        for near in cloud.fours(a, i, &(0..cloud.fluid)) {
            let weight = near.weight.lanes().0;
            if (0..4).any(|k| weight[k] > 0.0 && locals[near.rows[k]].lambda < OUTERMOST) {
                return Shift::default();
            }
        }
        // The pressure of a wall works along its normal, and a shift along it would be work that nobody does.
        let normal = toward_walls.normalize_or_zero();
        let shift = first_moment * (self.factor * strain_rate);
        let along = shift - normal * normal.dot(shift);
        Shift { displacement: along.clamp_length_max(self.largest), inside: true }
    }
}
