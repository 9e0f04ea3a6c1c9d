//! Forces that the faces at edges take over from the particles behind them.

use glam::DVec3;

use crate::formulations::fluid::cloud::{FlowCloud, Front, Group, PARTS, part};
use crate::schedule::{Run, Step, StepError};
use crate::world::Force;

/// Share of the support up to which neighbours are in the rows of all ranks.
const WITHIN: f64 = 1.0 - 1e-6;

/// Divides the forces of pressure on particles beside edges among the faces around them.
pub struct EdgeForces;

impl Run for EdgeForces {
    fn run(&mut self, step: &mut Step<'_>) -> Result<(), StepError> {
        let mut cloud = step.resources.get_mut::<FlowCloud>();
        let mut edges = std::mem::take(&mut cloud.edges);
        if edges.particles.is_empty() {
            edges.fronts.clear();
        }
        for edge in &mut edges.particles {
            let (own, volume) = (cloud.records[edge.row].pressure(), cloud.records[edge.row].volume());
            let mut force = [DVec3::ZERO; 2];
            cloud.for_each_beside(edge.row, 0.0, |j, _, part| {
                force[0] -= volume * (own + cloud.records[j].pressure()) * part;
                force[1] -= volume * own * part;
            });
            // Without suction the fluid is compressed by w itself, so that the work of all of the force on
            // the motion of the faces relative to w is booked as that of the boundaries.
            if !cloud.group_of(edge.row).has_suction() {
                force[1] = force[0];
            }
            edge.force = force;
        }
        for front in &mut edges.fronts {
            front.force = [DVec3::ZERO; 2];
            for &w in cloud.near_row(front.i) {
                let Ok(at) = edges.particles.binary_search_by_key(&(w as usize), |edge| edge.row) else {
                    continue;
                };
                let edge = &edges.particles[at];
                if !cloud.pairs.gaps.have_edges(front.boundary, edge.row) {
                    continue;
                }
                let (share, _) = front.share_and_depth(&cloud, edge.row);
                for (sum, force) in front.force.iter_mut().zip(edge.force) {
                    *sum += share * front.normal.dot(edge.inverse * force) * front.normal;
                }
            }
        }
        for edge in &mut edges.particles {
            edge.force = edge.force.map(|force| edge.behind * force - edge.own * (edge.inverse * force));
        }
        cloud.edges = edges;
        Ok(())
    }
}

impl Front {
    /// Weight of the face at a boundary particle, and the depth of the particle behind it, m.
    pub fn share_and_depth(&self, cloud: &FlowCloud, row: usize) -> (f64, f64) {
        let x = cloud.offset(cloud.records[self.i].position(), cloud.records[row].position());
        (self.weight * cloud.value_between(self.i, row), -x.dot(self.normal) - self.distance)
    }
}

impl FlowCloud {
    /// Kernel value between two particles; zero at the very end of the support, where lists of ranks differ.
    pub(super) fn value_between(&self, i: usize, j: usize) -> f64 {
        let r = self.offset(self.records[i].position(), self.records[j].position()).length();
        if r < WITHIN * self.kernel.support { self.kernel.value(r) } else { 0.0 }
    }

    /// The group that a row belongs to.
    pub(in crate::formulations::fluid) fn group_of(&self, row: usize) -> &Group {
        &self.groups[self.groups.partition_point(|group| group.cloud.end <= row)]
    }

    /// Calls `f` with the row, W V and V w x of every fluid particle beside a boundary particle, `half` a
    /// step before now, s.
    pub(super) fn for_each_beside(&self, row: usize, half: f64, mut f: impl FnMut(usize, f64, DVec3)) {
        let own = &self.records[row];
        for &j in self.pairs.boundary.row(row - self.fluid) {
            let other = &self.records[j as usize];
            let x = self.offset(own.position(), other.position());
            let x = x - half * (other.velocity() - own.velocity());
            let distance = x.length();
            if distance < self.kernel.support {
                let volume = other.volume();
                f(
                    j as usize,
                    volume * self.kernel.value(distance),
                    volume * self.kernel.weight(distance) * x,
                );
            }
        }
    }

    /// Sums of W V and of a function of V w x over the fluid beside a boundary particle.
    pub(super) fn sums_beside(&self, row: usize, half: f64, f: impl Fn(DVec3) -> f64) -> [f64; 2] {
        let mut sums = [0.0; 2];
        self.for_each_beside(row, half, |_, value, part| {
            sums[0] += value;
            sums[1] += f(part);
        });
        sums
    }

    /// Adds what faces at edges take over to the forces on the particles of a group, and to the part of them
    /// that is due to boundaries.
    pub(in crate::formulations::fluid) fn add_edge_forces(
        &self,
        group: &Group,
        total: &mut [Force],
        parts: &mut [DVec3],
    ) {
        let rows = group.cloud.clone();
        let mut add = |row: usize, [force, own]: [DVec3; 2]| {
            total[row].0 += force;
            parts[PARTS * row + 1] += own;
        };
        for edge in self.edges.particles.iter().filter(|edge| rows.contains(&edge.row)) {
            add(edge.row - rows.start, edge.force.map(|force| -force));
        }
        for front in self.edges.fronts.iter().filter(|front| front.boundary == rows.start) {
            for &j in part(self.near_row(front.i), &rows) {
                let share = front.shares.of(self, front.i, j as usize);
                add(j as usize - rows.start, front.force.map(|force| share * force));
            }
        }
    }
}
