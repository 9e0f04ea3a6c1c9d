//! Viscosities between the bodies of a flow.

use super::cloud::{Group, Role};

/// Twice the viscosity between each two groups, Pa s.
#[derive(Debug)]
pub(super) struct Viscosities {
    /// Group by group.
    values: Vec<f64>,
    /// First row of each group in the cloud.
    starts: Vec<usize>,
}

impl Viscosities {
    pub fn new(groups: &[Group]) -> Self {
        let of = |a: &Group| groups.iter().map(|b| between(&a.role, &b.role)).collect::<Vec<f64>>();
        Self {
            values: groups.iter().flat_map(of).collect(),
            starts: groups.iter().map(|group| group.cloud.start).collect(),
        }
    }

    /// Those of a group with every group.
    pub fn of(&self, group: &Group) -> &[f64] {
        let count = self.starts.len();
        let at = self.starts.iter().position(|&start| start == group.cloud.start).unwrap_or(0);
        &self.values[at * count..(at + 1) * count]
    }
}

fn between(a: &Role, b: &Role) -> f64 {
    match (a, b) {
        (Role::Fluid(a), Role::Fluid(b)) => 2.0 * a.viscosity_with(b),
        (Role::Fluid(fluid), Role::Boundary(surface)) | (Role::Boundary(surface), Role::Fluid(fluid)) => {
            if surface.no_slip {
                2.0 * fluid.viscosity
            } else {
                0.0
            }
        }
        (Role::Boundary(_), Role::Boundary(_)) => 0.0,
    }
}
