//! A force at any place on a rigid body, as forces on all of its particles.
//!
//! With the force f at x, the mean place x_m of the particles weighted by their volumes, and their moments,
//! particle w gets
//!
//! `V_w (f / sum V + omega x (x_w - x_m))`, `(tr M - M) omega = (x - x_m) x f`, `M = sum V_w (x_w - x_m) (x)
//! (x_w - x_m)`:
//!
//! their sum is f, their moment that of f at x, and their power in any rigid motion that of f at x. How a
//! force is divided within a rigid body has no other effect. A row of particles in space has no moment about
//! its own line, and does not carry a couple about it.

use glam::DVec3;

use crate::formulations::fluid::cloud::{FlowCloud, Group};
use crate::formulations::fluid::rotation::rotation;
use crate::linalg::Sym3;
use crate::rigid::Wrench;

/// The particles of a rigid body and the forces on all of it.
pub struct WholeBody {
    volume: f64,
    center: DVec3,
    moment: Sym3,
    /// About the centre.
    load: Wrench,
}

impl WholeBody {
    /// The particles of a group, without a force.
    pub fn new(cloud: &FlowCloud, group: &Group) -> Self {
        let records = &cloud.records[group.cloud.clone()];
        let (mut volume, mut center, mut moment) = (0.0, DVec3::ZERO, Sym3::ZERO);
        for record in records {
            volume += record.volume();
            center += record.volume() * record.position();
        }
        center /= volume;
        for record in records {
            moment += Sym3::dyad(record.position() - center) * record.volume();
        }
        Self { volume, center, moment, load: Wrench::default() }
    }

    /// Adds a force, N, at the place of particle `i`, beside the particle `nearest` of the body.
    pub fn push(&mut self, cloud: &FlowCloud, [i, nearest]: [usize; 2], force: DVec3) {
        let position = |row: usize| cloud.records[row].position();
        let arm = position(nearest) - self.center - cloud.offset(position(i), position(nearest));
        self.load.push(arm, force);
    }

    /// Adds a couple, N m.
    pub fn turn(&mut self, couple: DVec3) {
        self.load.torque += couple;
    }

    /// Calls `add` with every particle of the group, by its number there, and the force on it, N.
    pub fn for_each_force(&self, cloud: &FlowCloud, group: &Group, mut add: impl FnMut(usize, DVec3)) {
        let spin = rotation(&self.moment, self.load.torque, cloud.plane);
        let push = self.load.force / self.volume;
        for (k, record) in cloud.records[group.cloud.clone()].iter().enumerate() {
            let arm = record.position() - self.center;
            add(k, record.volume() * (push + spin.cross(arm)));
        }
    }
}
