//! Probes of wear of a scene, resolved to measurements.

use super::removed_volume::RemovedVolume;
use super::roughness::Roughness;
use crate::plugin::{Selection, SimBuilder};
use crate::record::probe::direction::direction;
use crate::record::probe::measure::Measure;
use crate::scene::{self, Dimension, Problem, Quantity};

/// The gauge behind a quantity of wear; none for other quantities. `selected` is what the probe selects.
pub fn resolve(
    k: usize,
    probe: &scene::Probe,
    selected: impl Fn() -> Result<Selection, Vec<Problem>>,
    sim: &SimBuilder<'_>,
) -> Result<Option<Box<dyn Measure>>, Vec<Problem>> {
    Ok(Some(match &probe.quantity {
        Quantity::RemovedVolume => {
            Box::new(RemovedVolume { selection: selected()?, plane: sim.dimension() == Dimension::Two })
        }
        Quantity::Roughness { normal } => {
            let normal = direction(k, "normal", *normal, sim)?;
            Box::new(Roughness::new(selected()?, normal, sim))
        }
        _ => return Ok(None),
    }))
}
