//! The effect of supports on the particles beside them.

use super::balance::{HeldBody, balanced_shares, warning, warning_of_update};
use crate::plugin::SimBuilder;
use crate::world::BodyId;

/// The particles of a phase that carry a part of their stress, and those that are not seen.
#[derive(Default)]
pub(in crate::formulations) struct HeldParticles {
    /// The share of its stress that every row of the phase carries; empty where all carry all of it.
    pub carried: Vec<f64>,
    /// The particles of every body that no other one sees, by their numbers, ascending.
    hidden: Vec<(BodyId, Vec<u32>)>,
    /// Warnings of unevenly drawn bodies.
    pub warnings: Vec<String>,
    /// Warnings of bodies that will be drawn unevenly once they have another reference, without the time.
    of_updates: Vec<(BodyId, String)>,
}

impl HeldParticles {
    /// Those of the bodies of a phase.
    pub fn of(bodies: &[HeldBody<'_>], sim: &SimBuilder<'_>) -> Self {
        let hidden = bodies.iter().map(|body| (body.plan.id, body.plan.hidden.clone())).collect();
        let mut warnings = Vec::new();
        let of_update = |body: &HeldBody<'_>| warning_of_update(body).map(|text| (body.plan.id, text));
        let of_updates = bodies.iter().filter_map(of_update).collect();
        let shares = bodies.iter().map(|body| {
            let balanced = balanced_shares(body);
            warnings.extend(warning(body, balanced.imbalance));
            (body.plan.id, balanced.shares)
        });
        let carried = all_shares(shares, sim);
        Self { carried, hidden, warnings, of_updates }
    }

    /// The warning that a body needs once it has another reference than at the start, without the time.
    pub fn warning_of_update(&self, body: BodyId) -> Option<&str> {
        self.of_updates.iter().find(|(id, _)| *id == body).map(|(_, text)| text.as_str())
    }

    /// The particles of a body that no other one sees, by their numbers, ascending.
    pub fn hidden_of(&self, body: BodyId) -> &[u32] {
        self.hidden.iter().find(|(id, _)| *id == body).map_or(&[], |(_, hidden)| hidden)
    }
}

/// The share of every row of a phase, from those of its bodies that are not 1; empty where all are.
pub(in crate::formulations) fn all_shares(
    bodies: impl Iterator<Item = (BodyId, Vec<(u32, f64)>)>,
    sim: &SimBuilder<'_>,
) -> Vec<f64> {
    let (mut all, mut end) = (Vec::new(), 0);
    for (id, shares) in bodies {
        let rows = &sim.body(id).rows;
        end = end.max(rows.end);
        if !shares.is_empty() {
            all.resize(rows.end.max(all.len()), 1.0);
        }
        shares.iter().for_each(|(k, share)| all[rows.start + *k as usize] = *share);
    }
    if !all.is_empty() {
        all.resize(end, 1.0);
    }
    all
}
