//! The particle of a wall beside a gauge.

use glam::DVec3;

use crate::formulations::fluid::FlowCloud;

/// The boundary particle that is nearest to a point.
pub fn nearest(cloud: &FlowCloud, walls: &[usize], point: DVec3) -> Option<usize> {
    let distance = |i: &usize| cloud.offset(point, cloud.records()[*i].position()).length_squared();
    walls.iter().copied().min_by(|a, b| distance(a).total_cmp(&distance(b)))
}
