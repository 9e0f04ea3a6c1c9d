//! The neighbours of each boundary particle within its body, and their relative motion.

use glam::{DMat3, DVec3};

use crate::formulations::fluid::lanes::FlowParticle;
use crate::linalg::Sym3;
use crate::neighbors::{Cloud, NeighborError, NeighborList, Periodic};
use crate::plugin::BodyPlan;
use crate::world::BodyId;

/// Distance of the particles that move with one, over the spacing of the fluid.
const REACH: f64 = 1.5;
/// Distance from which on a neighbour of the start counts no more, over the same spacing: in a body that
/// flows or wears it has gone elsewhere.
const FARTHEST: f64 = 2.0 * REACH;
/// Mean square of the distance from the centre of a cluster, over that of the spacing of the fluid, below
/// which the cluster has collapsed: that of two particles a spacing apart. Corners of whole bodies have twice
/// as much.
const COLLAPSED: f64 = 0.25;

/// The neighbours of the particles of a body at its start.
#[derive(Debug)]
pub struct Neighborhood {
    pub body: BodyId,
    /// Whether the body deforms.
    pub is_soft: bool,
    /// Whether friction acts on it with its gradient of velocity.
    pub has_friction: bool,
    pub list: NeighborList,
    /// Square of the distance from which on a neighbour counts no more, m2.
    farthest: f64,
}

/// A particle and its neighbours in the body, weighed by their volumes.
#[derive(Clone, Copy, Debug)]
pub struct Cluster {
    /// Volume, m3.
    pub volume: f64,
    /// Centre of mass, from the particle, m.
    pub mean: DVec3,
    /// Moment matrix about the centre, m5.
    pub moment: Sym3,
    /// The same sum with velocities in the place of the first of its two factors, m5/s.
    pub motion: DMat3,
}

impl Neighborhood {
    /// That of a body in a flow of that spacing, m, which neither deforms nor has friction.
    pub fn new(body: &BodyPlan, spacing: f64, periodic: &Periodic) -> Result<Self, NeighborError> {
        let positions: Vec<DVec3> = body.sites.iter().map(|site| site.position).collect();
        let list = NeighborList::reference(Cloud::uniform(&positions, REACH * spacing), periodic)?;
        let farthest = (FARTHEST * spacing).powi(2);
        Ok(Self { body: body.id, is_soft: false, has_friction: false, list, farthest })
    }

    /// Whether two particles that were neighbours at the start, x apart, m, still are.
    #[inline(always)]
    pub fn are_near(&self, x: DVec3) -> bool {
        x.length_squared() < self.farthest
    }

    /// The cluster of particle `k`, all zero for a removed particle.
    pub fn cluster(&self, records: &[FlowParticle], k: usize, periodic: &Periodic) -> Cluster {
        self.cluster_before(records, k, periodic, 0.0)
    }

    /// The same that long before, s.
    pub fn cluster_before(
        &self,
        records: &[FlowParticle],
        k: usize,
        periodic: &Periodic,
        before: f64,
    ) -> Cluster {
        let own = &records[k];
        if own.volume() == 0.0 {
            return Cluster { volume: 0.0, mean: DVec3::ZERO, moment: Sym3::ZERO, motion: DMat3::ZERO };
        }
        let (mut volume, mut first, mut momentum) = (own.volume(), DVec3::ZERO, DVec3::ZERO);
        let (mut moment, mut motion) = (Sym3::ZERO, DMat3::ZERO);
        for &j in self.list.row(k) {
            let other = &records[j as usize];
            let v = other.velocity() - own.velocity();
            let now = periodic.minimal_image(other.position() - own.position());
            if !self.are_near(now) {
                continue;
            }
            let x = now - before * v;
            volume += other.volume();
            first += other.volume() * x;
            momentum += other.volume() * v;
            moment += Sym3::dyad(x) * other.volume();
            motion += dyad(other.volume() * v, x);
        }
        let mean = first / volume;
        let (moment, motion) = (moment - Sym3::dyad(mean) * volume, motion - dyad(momentum, mean));
        Cluster { volume, mean, moment, motion }
    }

    /// The share of the moments of pressure that a cluster bears: all of it in a body, less in one that has
    /// collapsed.
    ///
    /// Fragments of a few particles may have no stress. The pressure around would squeeze them to a point,
    /// where the forces that have a moment grow without bounds, and so does the gradient of the motion.
    /// Moments of pressure have no couple, so that angular momentum does not depend on this share; force and
    /// gradient take the same one.
    #[inline(always)]
    pub fn share(&self, cluster: &Cluster) -> f64 {
        let collapsed = COLLAPSED * cluster.volume * self.farthest / (2.0 * REACH).powi(2);
        let extent = cluster.moment.trace();
        if extent < collapsed { (extent / collapsed).powi(2) } else { 1.0 }
    }
}

/// `v (x) x`.
fn dyad(v: DVec3, x: DVec3) -> DMat3 {
    DMat3::from_cols(v * x.x, v * x.y, v * x.z)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::parallel::Lanes4;

    /// Four corners of a square of edge 1, of which the last one is `away` and takes its velocity with it.
    fn square(away: DVec3) -> Cluster {
        let corners = [DVec3::ZERO, DVec3::X, DVec3::Y, DVec3::new(1.0, 1.0, 0.0)];
        let list = NeighborList::reference(Cloud::uniform(&corners, REACH), &Periodic::NONE).expect("a list");
        let farthest = FARTHEST * FARTHEST;
        let near = Neighborhood { body: BodyId(0), is_soft: true, has_friction: true, list, farthest };
        let mut records = corners.map(|x| FlowParticle {
            place: Lanes4([x.x, x.y, 0.0, 1.0]),
            motion: Lanes4([0.1 * x.x, 0.0, 0.0, 0.0]),
        });
        let x = corners[3] + away;
        records[3].place = Lanes4([x.x, x.y, 0.0, 1.0]);
        near.cluster(&records, 0, &Periodic::NONE)
    }

    #[test]
    fn a_neighbour_that_has_gone_elsewhere_is_no_part_of_a_cluster() {
        let (whole, without) = (square(DVec3::ZERO), square(DVec3::X * 10.0));
        assert_eq!(whole.mean, DVec3::new(0.5, 0.5, 0.0));
        // Of the three that are left: mean place, and moments 2/3 about it along both axes.
        let third = 1.0 / 3.0;
        assert!((without.mean - DVec3::new(third, third, 0.0)).length() < 1e-15);
        let moment = without.moment.to_matrix();
        assert!((moment.x_axis.x - 2.0 * third).abs() < 1e-15 && (moment.x_axis.y + third).abs() < 1e-15);
        assert!((without.motion.x_axis.x - 0.2 * third).abs() < 1e-15);
    }
}
