//! The spin of boundary particles: how the particles beside each in its body turn around it.

use glam::DVec3;

use super::spin::rotation;
use crate::formulations::fluid::cloud::{FlowCloud, Group};
use crate::formulations::fluid::lanes::Record;
use crate::linalg::Sym3;
use crate::neighbors::{Cloud, NeighborError, NeighborList, Periodic};
use crate::parallel::for_each_block;
use crate::plugin::BodyPlan;
use crate::world::BodyId;

/// Distance of the particles that turn with one, over the spacing of the fluid.
const REACH: f64 = 1.5;

/// The neighbours of the particles of a body at its start.
#[derive(Debug)]
pub struct Neighborhood {
    pub body: BodyId,
    pub list: NeighborList,
}

/// A particle and its neighbours in the body, weighed by their volumes.
#[derive(Clone, Copy, Debug, Default)]
pub struct Cluster {
    /// Centre of mass, from the particle, m.
    pub mean: DVec3,
    /// Moment matrix about the centre, m5.
    pub moment: Sym3,
    /// Angular momentum about the centre over the density, m5/s.
    pub angular: DVec3,
}

impl Neighborhood {
    /// That of a body in a flow of that spacing, m.
    pub fn new(body: &BodyPlan, spacing: f64, periodic: &Periodic) -> Result<Self, NeighborError> {
        let positions: Vec<DVec3> = body.sites.iter().map(|site| site.position).collect();
        let list = NeighborList::reference(Cloud::uniform(&positions, REACH * spacing), periodic)?;
        Ok(Self { body: body.id, list })
    }

    /// The cluster of particle `k`, all zero for a removed particle.
    pub fn cluster(&self, records: &[Record], k: usize, periodic: &Periodic) -> Cluster {
        let own = &records[k];
        if own.volume() == 0.0 {
            return Cluster::default();
        }
        let (mut volume, mut first, mut momentum) = (own.volume(), DVec3::ZERO, DVec3::ZERO);
        let (mut moment, mut angular) = (Sym3::ZERO, DVec3::ZERO);
        for &j in self.list.row(k) {
            let other = &records[j as usize];
            let x = periodic.minimal_image(other.position() - own.position());
            let v = other.velocity() - own.velocity();
            volume += other.volume();
            first += other.volume() * x;
            momentum += other.volume() * v;
            moment += Sym3::dyad(x) * other.volume();
            angular += other.volume() * x.cross(v);
        }
        let mean = first / volume;
        Cluster { mean, moment: moment - Sym3::dyad(mean) * volume, angular: angular - mean.cross(momentum) }
    }
}

impl FlowCloud {
    /// The neighbours of the particles of a boundary in its body, if friction with it asks for them.
    pub(in crate::formulations::fluid) fn neighborhood(&self, group: &Group) -> Option<&Neighborhood> {
        self.neighborhoods.iter().find(|near| near.body == group.body)
    }

    /// Calls `then` with `out` of every particle of a boundary and its spin, 1/s, where anything moves.
    pub(in crate::formulations::fluid) fn for_each_spin<T: Send>(
        &self,
        group: &Group,
        out: &mut [T],
        then: impl Fn(&mut T, DVec3) + Sync,
    ) {
        let records = &self.records[group.cloud.clone()];
        let Some(near) = self.neighborhood(group) else { return };
        if records.iter().all(|record| record.velocity() == DVec3::ZERO) {
            return;
        }
        for_each_block(out, &mut Vec::new(), &|first, out: &mut [T]| {
            for (k, out) in out.iter_mut().enumerate() {
                let Cluster { moment, angular, .. } = near.cluster(records, first + k, self.pairs.periodic());
                then(out, rotation(&moment, angular, self.plane));
            }
        });
    }
}
