//! The heat that pair terms, such as an artificial viscosity, leave in the particles of a solid. It raises
//! the temperature, and the pressure of an equation of state that depends on the internal energy.

use super::state::StateRows;
use crate::world::{ColumnSet, ViscousPower};

/// The power of the heat of a block, if it plays a part.
pub(super) struct ViscousHeatRows<'a>(&'a [ViscousPower]);

impl<'a> ViscousHeatRows<'a> {
    /// Adds the column, which the pass over pairs fills, if the law reads it.
    pub fn declare(is_read: bool, columns: &mut ColumnSet) {
        if is_read {
            columns.add::<ViscousPower>();
        }
    }

    /// Takes the column of a block, if the law reads it.
    #[inline(always)]
    pub fn take(is_read: bool, state: &mut StateRows<'a>) -> Self {
        Self(if is_read { state.take::<ViscousPower>() } else { &[] })
    }

    /// Heat of row `k` in a step of `dt`, s, per reference volume, J/m3.
    #[inline(always)]
    pub fn heat(&self, k: usize, dt: f64) -> f64 {
        self.0.get(k).map_or(0.0, |power| power.0 * dt)
    }
}
