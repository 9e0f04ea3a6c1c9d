//! Warning of fluids that leave their vessels and fall on: they are missing where they should be.

use glam::DVec3;

use super::closed::named;
use crate::formulations::fluid::cloud::FlowCloud;
use crate::formulations::fluid::density::{Floor, open_gravity};
use crate::notation::{place, quantity};
use crate::plugin::SimBuilder;
use crate::scene::Outside;
use crate::schedule::{Step, replace_warning};

/// Growth of the number of particles for which the warning is renewed.
const GROWTH: f64 = 1.2;

/// Watches what falls past all walls and bodies.
pub struct FallenWatch {
    /// Acceleration of gravity along the axes that are not periodic, m/s2; zero where a domain takes out what
    /// leaves it.
    gravity: DVec3,
    /// Number of particles reported to the user.
    pub told: u32,
}

impl FallenWatch {
    /// The watch of a scene.
    pub fn new(sim: &SimBuilder<'_>) -> Self {
        let leaves = sim.scene().domain.as_ref().is_some_and(|domain| domain.outside == Outside::Remove);
        let gravity = if leaves { DVec3::ZERO } else { open_gravity(sim) };
        Self { gravity, told: 0 }
    }

    /// Checks all fluids.
    pub fn look(&mut self, cloud: &FlowCloud, step: &mut Step<'_>) {
        if self.gravity == DVec3::ZERO {
            return;
        }
        let floor = Floor::of(self.gravity, &cloud.groups, cloud.records());
        let fluids = cloud.records()[..cloud.fluid].iter();
        let mut fallen = fluids.filter(|record| record.volume() > 0.0 && floor.is_above(record));
        let Some(first) = fallen.next() else { return };
        let count = 1 + fallen.count() as u32;
        if f64::from(count) < GROWTH * f64::from(self.told) {
            return;
        }
        self.told = count;
        let begin =
            format!("what has left the vessels of {} falls past all walls and bodies: ", named(cloud, step));
        let text = format!(
            "{begin}{count} of its particles by {}, one of them at {}, which are missing above, and fall on for ever; make the walls higher, or let \
             `domain: (min: ..., max: ..., outside: Remove)` take them out",
            quantity(step.clock.time, "s"),
            place(first.position()),
        );
        replace_warning(step.warnings, &begin, text);
    }
}
