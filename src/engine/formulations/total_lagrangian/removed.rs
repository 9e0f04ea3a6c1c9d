//! The removed particles, as the passes need them.

use crate::solids::Refits;

/// The removed rows that the passes know of.
#[derive(Default)]
pub(super) struct RemovedRows {
    /// Ascending.
    pub rows: Vec<u32>,
    /// Corrections of F for laws that depend on the path.
    pub refits: Refits,
    /// Rows without a deformation gradient since they have lost a neighbour, ascending.
    pub released: Vec<u32>,
}

impl RemovedRows {
    pub fn refits(&self) -> &Refits {
        &self.refits
    }

    pub fn rows(&self) -> &[u32] {
        &self.rows
    }
}
