//! The removed particles, as the passes need them.

use crate::solids::Refits;

/// The removed rows that the passes know of.
#[derive(Default)]
pub(super) struct RemovedRows {
    /// Ascending.
    pub rows: Vec<u32>,
    /// Corrections of F for the laws of plastic bodies.
    pub refits: Refits,
}

impl RemovedRows {
    pub fn refits(&self) -> &Refits {
        &self.refits
    }

    pub fn rows(&self) -> &[u32] {
        &self.rows
    }
}
