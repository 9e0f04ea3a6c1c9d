//! Declared access of the pass over solids.

use super::bodies::SolidBodies;
use super::losses::AppliedLosses;
use super::phase::{CORRECTED_STRESS, PACKED_SOLID};
use crate::removal::LEAVING;
use crate::schedule::{Access, Mode};
use crate::world::{Column, Damage, DeformationGradient, PiolaStress};

impl SolidBodies {
    /// The pass writes deformation gradient, stress, state and packed rows, and reads the damage and who
    /// leaves.
    pub fn access(&self) -> Vec<Access> {
        let of = |mode| move |column| Access { column, mode };
        let always = [
            DeformationGradient::NAME,
            PiolaStress::NAME,
            AppliedLosses::NAME,
            PACKED_SOLID,
            CORRECTED_STRESS,
        ];
        let written = always.into_iter().chain(self.columns.iter().map(|column| column.name));
        let read = [LEAVING].into_iter().chain(self.can_fail.then_some(Damage::NAME));
        written.map(of(Mode::Writes)).chain(read.map(of(Mode::Reads))).collect()
    }
}
