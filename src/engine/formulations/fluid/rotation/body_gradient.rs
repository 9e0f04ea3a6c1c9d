//! Velocity gradient of a boundary body at its particles.

use glam::{DMat3, DVec3};

use super::affine::affine;
use crate::formulations::fluid::cloud::{Cluster, FlowCloud, Group, Neighborhood};
use crate::parallel::for_each_block;

impl FlowCloud {
    /// The neighbours of the particles of a boundary in its body, if friction with it asks for them.
    pub(in crate::formulations::fluid) fn neighborhood(&self, group: &Group) -> Option<&Neighborhood> {
        self.neighborhoods.iter().find(|near| near.has_friction && near.body == group.body)
    }

    /// The neighbours of the particles of a deformable body in it.
    pub(in crate::formulations::fluid) fn soft_neighborhood(&self, group: &Group) -> Option<&Neighborhood> {
        self.neighborhoods.iter().find(|near| near.is_soft && near.body == group.body)
    }

    /// The neighbours of the particles of a boundary in its body, whatever asks for them.
    pub(in crate::formulations::fluid) fn any_neighborhood(&self, group: &Group) -> Option<&Neighborhood> {
        self.neighborhoods.iter().find(|near| near.body == group.body)
    }

    /// Calls `then` with `out` of every particle of a boundary and the velocity gradient of its body there,
    /// 1/s, where anything moves.
    pub(in crate::formulations::fluid) fn for_each_gradient<T: Send>(
        &self,
        group: &Group,
        out: &mut [T],
        then: impl Fn(&mut T, DMat3) + Sync,
    ) {
        let records = &self.records[group.cloud.clone()];
        let Some(near) = self.neighborhood(group) else { return };
        if records.iter().all(|record| record.velocity() == DVec3::ZERO) {
            return;
        }
        for_each_block(out, &mut Vec::new(), &|first, out: &mut [T]| {
            for (k, out) in out.iter_mut().enumerate() {
                let Cluster { moment, motion, .. } = near.cluster(records, first + k, self.pairs.periodic());
                then(out, affine(&moment, motion, self.plane));
            }
        });
    }
}
