//! Removal of failed particles.

use meshless_engine::removal::RemovalRule;
use meshless_engine::schedule::{Access, Mode, Step, StepError};
use meshless_engine::world::{BodyId, Column, Damage};

/// Names the failed particles of some bodies.
pub(crate) struct Failed {
    pub bodies: Vec<BodyId>,
}

impl RemovalRule for Failed {
    fn rows(&mut self, step: &Step<'_>, body: BodyId, out: &mut Vec<u32>) -> Result<(), StepError> {
        if !self.bodies.contains(&body) {
            return Ok(());
        }
        let (view, rows) = step.world.body_view(body);
        let damage = view.read::<Damage>()?;
        out.extend(rows.filter(|&row| damage[row].0 >= 1.0).map(|row| row as u32));
        Ok(())
    }

    fn access(&self) -> Vec<Access> {
        vec![Access { column: Damage::NAME, mode: Mode::Reads }]
    }
}
