//! The temperature of a law heated by plastic work, or of a law without temperature.

use super::state::StateRows;
use crate::world::{ColumnSet, Temperature};

/// The temperatures of a block, if they play a part.
pub(super) struct TemperatureRows<'a>(Option<&'a mut [Temperature]>);

impl<'a> TemperatureRows<'a> {
    /// Adds the column, if there is a temperature at the start, K.
    pub fn declare(start: Option<f64>, columns: &mut ColumnSet) {
        if start.is_some() {
            columns.add::<Temperature>();
        }
    }

    /// Fills the column with the temperature at the start, K.
    pub fn start(start: Option<f64>, state: &mut StateRows<'_>) {
        if let Some(start) = start {
            state.take::<Temperature>().fill(Temperature(start));
        }
    }

    /// Takes the column of a block, if there is a temperature at the start, K.
    #[inline(always)]
    pub fn take(start: Option<f64>, state: &mut StateRows<'a>) -> Self {
        Self(start.map(|_| state.take()))
    }

    /// Temperature of row `k`, K; zero where it plays no part.
    #[inline(always)]
    pub fn get(&self, k: usize) -> f64 {
        self.0.as_deref().map_or(0.0, |rows| rows[k].0)
    }

    /// Sets the temperature of row `k`, K, where it plays a part.
    #[inline(always)]
    pub fn set(&mut self, k: usize, temperature: f64) {
        if let Some(rows) = &mut self.0 {
            rows[k].0 = temperature;
        }
    }
}
