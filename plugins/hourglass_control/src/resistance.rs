//! The modulus in the stiffness of the control.

use meshless_engine::solids::{FoldedEnergy, FoldedRows, FoldedTerm};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Modulus of the elastic resistance in a particle that has yielded.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Deserialize, Serialize, JsonSchema)]
pub enum AfterYield {
    /// The present flow stress (Ganzenmueller 2015, section 4.5): an elastic resistance would carry load that
    /// the metal cannot, and suppress the flow.
    #[default]
    YieldStress,
    /// Young's modulus, as before yield.
    Young,
}

impl AfterYield {
    /// E_i, Pa, of row `k`.
    #[inline(always)]
    pub fn modulus(self, rows: &FoldedRows<'_>, k: usize) -> f64 {
        match self {
            Self::YieldStress => rows.modulus[k].min(rows.strength[k]),
            Self::Young => rows.modulus[k],
        }
    }
}

/// Writes E_i to its column, for pair forces that need that of both particles.
pub struct Resistance(pub AfterYield);

impl FoldedTerm for Resistance {
    fn add(&self, rows: &mut FoldedRows<'_>) -> FoldedEnergy {
        for k in 0..rows.memory.modulus.len() {
            rows.memory.modulus[k] = self.0.modulus(rows, k);
        }
        FoldedEnergy::default()
    }

    fn stiffness_factor(&self) -> f64 {
        0.0
    }

    fn only_looks(&self) -> bool {
        true
    }
}
