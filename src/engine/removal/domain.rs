//! The box in which particles may be. If the scene asks for it, particles outside are removed.

use glam::DVec3;

use super::rule::RemovalRule;
use crate::parallel::{BLOCK, for_each_block, for_each_own_block};
use crate::plugin::SimBuilder;
use crate::ranks;
use crate::rigid::is_rigid;
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
    #[inline]
    pub fn contains(&self, x: DVec3) -> bool {
        (x.cmpge(self.min) & x.cmple(self.max)).all()
    }
}

/// Removes the particles outside of the box.
pub(super) struct RemoveOutside {
    domain: DomainBox,
    /// Particles outside, block by block.
    counts: Vec<f64>,
}

impl RemoveOutside {
    pub fn new(domain: DomainBox) -> Self {
        Self { domain, counts: Vec::new() }
    }
}

impl RemovalRule for RemoveOutside {
    fn rows(&mut self, step: &Step<'_>, body: BodyId, out: &mut Vec<u32>) -> Result<(), StepError> {
        let Self { domain, counts } = self;
        let (view, rows) = step.world.body_view(body);
        let outside = |x: &Position| !domain.contains(x.0);
        let count = |_, block: &[Position]| {
            let mut count = 0;
            for x in block {
                count += u32::from(outside(x));
            }
            f64::from(count)
        };
        if ranks::has_several() {
            // Each rank checks its own rows, and all rows where there is something to remove.
            let position = view.read_own::<Position>()?;
            if for_each_own_block(&position[rows.clone()], counts, &count) == 0.0 {
                return Ok(());
            }
        }
        let position = view.read::<Position>()?;
        let position = &position[rows.clone()];
        let any = for_each_block(position, counts, &count);
        // A rigid body leaves as a whole: what is left of it would go on alone.
        if any == 0.0 || (any as usize) < position.len() && is_rigid(step, body) {
            return Ok(());
        }
        for (b, block) in position.chunks(BLOCK).enumerate().filter(|(b, _)| counts[*b] > 0.0) {
            // What is not finite is for the watchdog: it must not vanish from sight.
            let gone = |(_, x): &(usize, &Position)| outside(x) && x.0.is_finite();
            let first = rows.start + b * BLOCK;
            out.extend(block.iter().enumerate().filter(gone).map(|(k, _)| (first + k) as u32));
        }
        Ok(())
    }
}
