//! Heat on the vertices of a patch, distributed to its particles by their shares of the vertices.

use super::patch::Patch;
use crate::parallel::{Picked, sum_over_blocks};
use crate::world::{Mass, Temperature};

impl Patch {
    /// Heats the point of a facet with these shares of its vertices by that much, J.
    pub fn heat(&mut self, facet: u32, shares: [f64; 3], heat: f64) {
        let numbers = self.numbers(facet);
        for (number, share) in numbers.into_iter().zip(shares).take(self.skin.facets.axes) {
            self.heat_vertex(number, share * heat);
        }
    }

    /// Heats the vertex of that number in the patch by that much, J.
    pub fn heat_vertex(&mut self, number: usize, heat: f64) {
        if heat != 0.0 {
            self.heats[number] += heat;
            self.has_heat = true;
        }
    }

    /// Warms the particles of the body, of that specific heat, J/(kg K).
    pub fn warm(&self, specific_heat: f64, mass: &[Mass], temperature: &mut [Temperature]) {
        if !self.has_heat {
            return;
        }
        let rows = Picked::new(self.particles(), temperature);
        sum_over_blocks(rows, &|first, mut rows: Picked<'_, Temperature>| {
            for k in 0..rows.len() {
                let ends = self.starts[first + k] as usize..self.starts[first + k + 1] as usize;
                let share =
                    |k: usize| self.following.get(k).map_or(self.ends[k].weight, |follower| follower.share);
                let heat: f64 = ends.map(|k| share(k) * self.heats[self.ends[k].vertex as usize]).sum();
                if heat != 0.0 {
                    rows.row(k).0 += heat / (mass[rows.number(k)].0 * specific_heat);
                }
            }
        });
    }
}
