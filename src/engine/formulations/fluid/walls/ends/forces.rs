//! The tangential pair force between a wall and a fluid particle past its end.

use glam::DVec3;

use crate::formulations::fluid::cloud::{FlowCloud, Group, WallEnd};
use crate::world::Force;

/// Share of the support up to which neighbours are in the rows of all ranks.
pub const WITHIN: f64 = 1.0 - 1e-6;

impl Group {
    /// Whether it is a wall with empty space behind its ends.
    pub(super) fn has_ends(&self) -> bool {
        self.is_wall() && !self.has_suction()
    }
}

impl FlowCloud {
    /// Calls `f` with the row and x_iw of every particle of such walls within the support of a fluid
    /// particle.
    pub(super) fn for_each_end_wall(&self, i: usize, mut f: impl FnMut(usize, DVec3)) {
        let own = self.records[i].position();
        let limit = (WITHIN * self.kernel.support).powi(2);
        for group in self.groups.iter().filter(|group| group.has_ends()) {
            for &w in self.boundary_near(i, &group.cloud) {
                let x = self.offset(own, self.records[w as usize].position());
                if x.length_squared() < limit {
                    f(w as usize, x);
                }
            }
        }
    }

    /// The part left out of the rate of compression of a particle, `half` a step before now, 1/s.
    pub(super) fn rate_along(&self, end: &WallEnd, half: f64) -> f64 {
        let (v, mut rate) = (self.records[end.i].velocity(), 0.0);
        self.for_each_end_wall(end.i, |w, x| {
            let wall = &self.records[w];
            let v = wall.velocity() - v;
            let x = x - half * v;
            rate += wall.volume() * self.kernel.weight(x.length()) * (end.along * v).dot(x);
        });
        rate
    }

    /// Takes the part of the pressure of fluids along walls past their ends out of the forces on a group.
    pub(in crate::formulations::fluid) fn let_go(&self, group: &Group, total: &mut [Force]) {
        if self.ends.is_empty() || !(group.fluid().is_some() || group.has_ends()) {
            return;
        }
        let rows = group.cloud.clone();
        for end in &self.ends {
            let own = &self.records[end.i];
            let strength = own.pressure() * own.volume();
            let is_own = rows.contains(&end.i);
            self.for_each_end_wall(end.i, |w, x| {
                let weight = strength * self.records[w].volume() * self.kernel.weight(x.length());
                if is_own {
                    total[end.i - rows.start].0 += weight * (end.along * x);
                } else if rows.contains(&w) {
                    total[w - rows.start].0 -= weight * (end.along * x);
                }
            });
        }
    }
}
