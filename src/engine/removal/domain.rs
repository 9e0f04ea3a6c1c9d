//! The box in which particles may be; where the scene asks for it, those outside are removed.

use glam::DVec3;

use super::system::RemovalRule;
use crate::plugin::SimBuilder;
use crate::scene::{Axis, Dimension, Outside};
use crate::schedule::{Step, StepError};
use crate::world::{BodyId, Position};

/// The box in which particles may be, without the sides that they may pass.
#[derive(Clone, Copy, Debug)]
pub(crate) struct DomainBox {
    min: DVec3,
    max: DVec3,
    /// What happens outside.
    pub outside: Outside,
}

impl DomainBox {
    /// The box of a scene that has a domain.
    pub fn of_scene(sim: &SimBuilder<'_>) -> Option<Self> {
        let domain = sim.scene().domain.as_ref()?;
        let (mut min, mut max) = (domain.min.0, domain.max.0);
        let plane = sim.dimension() == Dimension::Two;
        for axis in [Axis::X, Axis::Y, Axis::Z] {
            if domain.periodic.contains(&axis) || (plane && axis == Axis::Z) {
                let k = axis.index();
                (min[k], max[k]) = (f64::NEG_INFINITY, f64::INFINITY);
            }
        }
        Some(Self { min, max, outside: domain.outside })
    }

    /// Whether a place is in the box; one that is not a number is not.
    pub fn contains(&self, x: DVec3) -> bool {
        x.cmpge(self.min).all() && x.cmple(self.max).all()
    }
}

impl RemovalRule for DomainBox {
    fn rows(&mut self, step: &Step<'_>, body: BodyId, out: &mut Vec<u32>) -> Result<(), StepError> {
        let (view, rows) = step.world.body_view(body);
        let position = view.read::<Position>()?;
        let outside = |row: &usize| {
            let x = position[*row].0;
            // What is not finite is for the watchdog: it must not vanish from sight.
            x.is_finite() && !self.contains(x)
        };
        out.extend(rows.filter(outside).map(|row| row as u32));
        Ok(())
    }
}
