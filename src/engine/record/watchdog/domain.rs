//! Particles that leave the domain of the scene.

use crate::notation::place;
use crate::parallel::{BlockSum, for_each_block};
use crate::plugin::SimBuilder;
use crate::removal::DomainBox;
use crate::scene::Outside;
use crate::schedule::{Step, StepError};
use crate::world::{BodyId, Position};

/// The check of the domain of a scene in which no particle may leave it.
pub(super) struct DomainCheck {
    domain: DomainBox,
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

impl DomainCheck {
    /// The check of a scene that has a domain and does not want particles outside removed.
    pub fn of_scene(sim: &SimBuilder<'_>) -> Option<Self> {
        let domain = DomainBox::of_scene(sim).filter(|domain| domain.outside == Outside::Error)?;
        Some(Self { domain, sums: Vec::new() })
    }

    /// Checks all particles.
    pub fn look(&mut self, step: &Step<'_>) -> Result<(), StepError> {
        let domain = self.domain;
        for (k, body) in step.world.bodies().iter().enumerate() {
            let position = step.world.phase(body.phase).read::<Position>()?;
            let rows = &position[body.rows.clone()];
            let first = for_each_block(rows, &mut self.sums, &|start, rows: &[Position]| {
                FirstOutside(rows.iter().position(|x| !domain.contains(x.0)).map_or(0, |row| start + row + 1))
            });
            if let Some(row) = first.0.checked_sub(1) {
                let what = format!(
                    "position {} outside the domain, which holds nothing back (a `Wall` does, and `outside: Remove` takes out what leaves)",
                    place(rows[row].0)
                );
                return Err(step.unstable(&what, BodyId(k), row));
            }
        }
        Ok(())
    }
}
