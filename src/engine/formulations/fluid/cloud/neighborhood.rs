//! The particles beside each in the body of a boundary, and how they move around it.

use glam::{DMat3, DVec3};

use crate::formulations::fluid::lanes::FlowParticle;
use crate::linalg::Sym3;
use crate::neighbors::{Cloud, NeighborError, NeighborList, Periodic};
use crate::plugin::{BodyKind, BodyPlan};
use crate::world::BodyId;

/// Distance of the particles that move with one, over the spacing of the fluid.
const REACH: f64 = 1.5;

/// The neighbours of the particles of a body at its start.
#[derive(Debug)]
pub struct Neighborhood {
    pub body: BodyId,
    /// Whether the body deforms.
    pub is_soft: bool,
    pub list: NeighborList,
}

/// A particle and its neighbours in the body, weighed by their volumes.
#[derive(Clone, Copy, Debug)]
pub struct Cluster {
    /// Centre of mass, from the particle, m.
    pub mean: DVec3,
    /// Moment matrix about the centre, m5.
    pub moment: Sym3,
    /// The same sum with velocities in the place of the first of its two factors, m5/s.
    pub motion: DMat3,
}

impl Neighborhood {
    /// That of a body in a flow of that spacing, m.
    pub fn new(body: &BodyPlan, spacing: f64, periodic: &Periodic) -> Result<Self, NeighborError> {
        let positions: Vec<DVec3> = body.sites.iter().map(|site| site.position).collect();
        let list = NeighborList::reference(Cloud::uniform(&positions, REACH * spacing), periodic)?;
        Ok(Self { body: body.id, is_soft: body.kind == BodyKind::Solid, list })
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
            return Cluster { mean: DVec3::ZERO, moment: Sym3::ZERO, motion: DMat3::ZERO };
        }
        let (mut volume, mut first, mut momentum) = (own.volume(), DVec3::ZERO, DVec3::ZERO);
        let (mut moment, mut motion) = (Sym3::ZERO, DMat3::ZERO);
        for &j in self.list.row(k) {
            let other = &records[j as usize];
            let v = other.velocity() - own.velocity();
            let x = periodic.minimal_image(other.position() - own.position()) - before * v;
            volume += other.volume();
            first += other.volume() * x;
            momentum += other.volume() * v;
            moment += Sym3::dyad(x) * other.volume();
            motion += dyad(other.volume() * v, x);
        }
        let mean = first / volume;
        Cluster { mean, moment: moment - Sym3::dyad(mean) * volume, motion: motion - dyad(momentum, mean) }
    }
}

/// `v (x) x`.
fn dyad(v: DVec3, x: DVec3) -> DMat3 {
    DMat3::from_cols(v * x.x, v * x.y, v * x.z)
}
