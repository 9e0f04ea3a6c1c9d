//! The force of the fluids on the particles of a body, apart from all other forces on them.

use glam::DVec3;

use crate::formulations::fluid::cloud::{FlowCloud, PARTS};
use crate::formulations::fluid::moments::SurfaceMoments;
use crate::world::{BodyId, Force};

impl FlowCloud {
    /// Force of the fluids on every particle of a body, and the viscous part of it, N; none for a body
    /// without fluid beside it. It is computed from the particles of the last right-hand side.
    pub fn forces_on(&self, body: BodyId) -> Option<Vec<(DVec3, DVec3)>> {
        let mut sum: Option<Vec<(DVec3, DVec3)>> = None;
        // A thin body has a group for each of its sides.
        for group in self.groups.iter().filter(|group| group.body == body) {
            let mut total = vec![Force(DVec3::ZERO); group.rows.len()];
            let mut parts = vec![DVec3::ZERO; PARTS * group.rows.len()];
            self.force(group, &mut total, &mut parts);
            SurfaceMoments::default().add_measured(self, group, &mut total, &mut parts);
            self.repel(group, &mut total, &mut parts);
            self.press_gaps(group, &mut total, &mut parts);
            self.add_edge_forces(group, &mut total, &mut parts);
            self.let_go(group, &mut total);
            let sum = sum.get_or_insert_with(|| vec![Default::default(); total.len()]);
            for (k, (all, viscous)) in sum.iter_mut().enumerate() {
                *all += total[k].0;
                *viscous += parts[PARTS * k];
            }
        }
        sum
    }
}
