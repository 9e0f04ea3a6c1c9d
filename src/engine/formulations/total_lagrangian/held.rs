//! The effect of supports on the particles beside them.

use crate::plugin::SimBuilder;
use crate::world::BodyId;

/// The particles of a phase that carry a part of their stress, and those that are not seen.
#[derive(Default)]
pub(in crate::formulations) struct Held {
    /// The share of its stress that every row of the phase carries; empty where all carry all of it.
    pub carried: Vec<f64>,
    /// The particles of every body that no other one sees, by their numbers, ascending.
    hidden: Vec<(BodyId, Vec<u32>)>,
}

impl Held {
    /// Those of the bodies of a phase.
    pub fn of(bodies: &[BodyId], sim: &SimBuilder<'_>) -> Self {
        let hidden = bodies.iter().map(|id| (*id, sim.body(*id).hidden.clone())).collect();
        let bodies = || bodies.iter().map(|id| sim.body(*id));
        if bodies().all(|body| body.carried.is_empty()) {
            return Self { carried: Vec::new(), hidden };
        }
        let mut carried = vec![1.0; bodies().map(|body| body.rows.end).max().unwrap_or(0)];
        for body in bodies() {
            body.carried.iter().for_each(|(k, share)| carried[body.rows.start + *k as usize] = *share);
        }
        Self { carried, hidden }
    }

    /// The particles of a body that no other one sees, by their numbers, ascending.
    pub fn hidden_of(&self, body: BodyId) -> &[u32] {
        self.hidden.iter().find(|(id, _)| *id == body).map_or(&[], |(_, hidden)| hidden)
    }
}
