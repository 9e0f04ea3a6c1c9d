//! The removed particles, as the passes need them.

use glam::DMat3;

use crate::solids::Refits;

/// The removed rows that the passes know of.
#[derive(Default)]
pub(super) struct RemovedRows {
    /// Ascending.
    pub rows: Vec<u32>,
    /// What the laws of plastic bodies go on from.
    pub refits: Refits,
    /// Whether the bonds do not know of them yet: after a restart.
    pub restored: bool,
}

impl RemovedRows {
    /// Those of a checkpoint.
    pub fn restored(rows: Vec<u32>, refits: Vec<(u32, DMat3)>) -> Self {
        Self { restored: !rows.is_empty(), rows, refits: Refits::restored(refits) }
    }

    pub fn refits(&self) -> &Refits {
        &self.refits
    }

    pub fn rows(&self) -> &[u32] {
        &self.rows
    }
}
