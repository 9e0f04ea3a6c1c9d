//! Loads on a flow beside gravity, such as a `BodyForce`: the pressure of walls increases along them as along
//! gravity.

use glam::DVec3;

use super::flow_cloud::FlowCloud;
use crate::world::BodyId;

impl FlowCloud {
    /// Acceleration of a fluid particle by loads, m/s2; gravity is not among them. `i` is its row in the
    /// cloud.
    #[inline]
    pub fn load(&self, i: usize) -> DVec3 {
        self.loads.get(i).copied().unwrap_or_default()
    }

    /// Adds the acceleration of particles of a fluid body by a load, m/s2; `rows` are those of the phase.
    /// Loads are forgotten at the beginning of every step, and have to be here before walls get their
    /// pressure.
    pub fn add_loads(&mut self, body: BodyId, rows: &[u32], accelerations: &[DVec3]) {
        let Some(group) = self.groups.iter().find(|group| group.body == body && group.fluid().is_some())
        else {
            return;
        };
        let (first, start) = (group.cloud.start, group.rows.start);
        self.loads.resize(self.fluid, DVec3::ZERO);
        for (&row, &acceleration) in rows.iter().zip(accelerations) {
            self.loads[first + row as usize - start] += acceleration;
        }
    }

    /// Forgets the loads of the step before.
    pub(in crate::formulations::fluid) fn forget_loads(&mut self) {
        self.loads.fill(DVec3::ZERO);
    }
}
