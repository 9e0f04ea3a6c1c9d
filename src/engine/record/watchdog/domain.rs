//! Particles that leave the domain of the scene.

use glam::DVec3;

use crate::parallel::{BlockSum, for_each_block};
use crate::plugin::SimBuilder;
use crate::scene::{self, Dimension, Outside};
use crate::schedule::{Step, StepError};
use crate::world::{BodyId, Position};

/// The box in which particles may be, without the sides that they may pass.
pub(super) struct DomainCheck {
    min: DVec3,
    max: DVec3,
    /// Added to the message where the scene wants particles removed.
    remark: &'static str,
    sums: Vec<FirstOutside>,
}

/// First row outside, counted from one; zero if there is none.
#[derive(Clone, Copy, Default)]
struct FirstOutside(usize);

impl BlockSum for FirstOutside {
    fn add(&mut self, next: &Self) {
        if self.0 == 0 {
            self.0 = next.0;
        }
    }
}

const CANNOT_REMOVE: &str = " (`outside: Remove` asks for its removal, but particles of this formulation are bound to \
                             their neighbours for good: enlarge the domain)";

impl DomainCheck {
    /// The check of a scene that has a domain.
    pub fn of_scene(sim: &mut SimBuilder<'_>) -> Option<Self> {
        let domain = sim.scene().domain.as_ref()?;
        let mut min = domain.min.0;
        let mut max = domain.max.0;
        let plane = sim.dimension() == Dimension::Two;
        for axis in [scene::Axis::X, scene::Axis::Y, scene::Axis::Z] {
            let k = axis.index();
            if domain.periodic.contains(&axis) || (plane && axis == scene::Axis::Z) {
                (min[k], max[k]) = (f64::NEG_INFINITY, f64::INFINITY);
            }
        }
        let removes = domain.outside == Outside::Remove;
        if removes {
            let bodies: Vec<String> = sim.bodies().iter().map(|body| format!("`{}`", body.name)).collect();
            sim.warn(format!(
                "the domain has `outside: Remove`, but particles of {} cannot be removed: one that leaves the domain \
                 stops the run",
                bodies.join(", ")
            ));
        }
        Some(Self { min, max, remark: if removes { CANNOT_REMOVE } else { "" }, sums: Vec::new() })
    }

    /// Looks at all particles.
    pub fn look(&mut self, step: &Step<'_>) -> Result<(), StepError> {
        let (min, max) = (self.min, self.max);
        for (k, body) in step.world.bodies().iter().enumerate() {
            let position = step.world.phase(body.phase).read::<Position>()?;
            let rows = &position[body.rows.clone()];
            let inside = |x: &Position| x.0.cmpge(min).all() && x.0.cmple(max).all();
            let first = for_each_block(rows, &mut self.sums, &|start, rows: &[Position]| {
                FirstOutside(rows.iter().position(|x| !inside(x)).map_or(0, |row| start + row + 1))
            });
            if let Some(row) = first.0.checked_sub(1) {
                let what = format!("position {} outside the domain{}", rows[row].0, self.remark);
                return Err(step.unstable(&what, BodyId(k), row));
            }
        }
        Ok(())
    }
}
