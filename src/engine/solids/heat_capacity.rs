//! Heat capacity of the particles of a body.

use super::phase::SolidPhase;
use crate::world::{Mass, Temperature};

/// Heat capacities of the particles of a body. Beside supports a particle has the share of heat that it has
/// of energy: the heat of plastic work is then a part of that work.
#[derive(Clone, Copy)]
pub struct HeatCapacity<'a> {
    specific_heat: f64,
    mass: &'a [Mass],
    first: usize,
    solid: Option<&'a dyn SolidPhase>,
}

impl<'a> HeatCapacity<'a> {
    /// Of the body whose first row is `first`, with its specific heat, J/(kg K), the masses of its phase and,
    /// for a solid, the packed rows of that.
    pub fn of_body(
        specific_heat: f64,
        mass: &'a [Mass],
        first: usize,
        solid: Option<&'a dyn SolidPhase>,
    ) -> Self {
        Self { specific_heat, mass, first, solid }
    }

    /// Whether a particle, by its number in the body, has a share of the heat.
    pub fn has(&self, number: usize) -> bool {
        self.share(self.first + number) > 0.0
    }

    /// Rise of the temperature of such a particle by that heat, J, in K.
    pub fn rise(&self, number: usize, heat: f64) -> f64 {
        let row = self.first + number;
        heat / (self.share(row) * self.mass[row].0 * self.specific_heat)
    }

    /// Warms a particle by that heat, J; one without a share, in the plane of a clamp, gives it to its
    /// neighbours.
    pub fn warm(&self, number: usize, heat: f64, temperature: &mut [Temperature]) {
        if self.has(number) {
            temperature[number].0 += self.rise(number, heat);
            return;
        }
        let Some(solid) = self.solid else { return };
        let ghosts = solid.ghosts();
        let each = |f: &mut dyn FnMut(usize, f64)| {
            solid.neighbors(self.first + number, &mut |j, weight| {
                let row = ghosts.source(j);
                f(row - self.first, weight * self.share(row));
            });
        };
        let mut all = 0.0;
        each(&mut |_, weight| all += weight);
        each(&mut |other, weight| {
            if weight > 0.0 {
                temperature[other].0 += self.rise(other, heat * weight / all);
            }
        });
    }

    fn share(&self, row: usize) -> f64 {
        self.solid.map_or(1.0, |solid| solid.share(row))
    }
}
