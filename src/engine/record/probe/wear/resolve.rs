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
            let surface = Roughness::new(selected()?, normal, sim);
            Box::new(
                surface
                    .map_err(|error| vec![Problem::at_path(format!("probes[{k}].on"), error.to_string())])?,
            )
        }
        _ => return Ok(None),
    }))
}
