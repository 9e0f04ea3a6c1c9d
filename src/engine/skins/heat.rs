//! Heat on the vertices of a patch, distributed to its particles by their shares of the vertices.

use super::patch::Patch;
use crate::parallel::{Picked, sum_over_blocks};
use crate::solids::HeatCapacity;
use crate::world::Temperature;

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

    /// Warms the particles of the body, of those heat capacities.
    pub fn warm(&self, capacity: &HeatCapacity<'_>, temperature: &mut [Temperature]) {
        if !self.has_heat {
            return;
        }
        let heat = |k: usize| -> f64 {
            let ends = self.starts[k] as usize..self.starts[k + 1] as usize;
            let share =
                |k: usize| self.following.get(k).map_or(self.ends[k].weight, |follower| follower.share);
            ends.map(|k| share(k) * self.heats[self.ends[k].vertex as usize]).sum()
        };
        let rows = Picked::new(self.particles(), temperature);
        sum_over_blocks(rows, &|first, mut rows: Picked<'_, Temperature>| {
            for k in 0..rows.len() {
                let (number, heat) = (rows.number(k), heat(first + k));
                if heat != 0.0 && capacity.has(number) {
                    rows.row(k).0 += capacity.rise(number, heat);
                }
            }
        });
        for (k, number) in self.particles().iter().enumerate() {
            let number = *number as usize;
            if !capacity.has(number) {
                capacity.warm(number, heat(k), temperature);
            }
        }
    }
}
