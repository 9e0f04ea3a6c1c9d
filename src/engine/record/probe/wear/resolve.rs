//! Probes of wear of a scene: what each measures.

use super::removed_volume::RemovedVolume;
use super::roughness::Roughness;
use crate::plugin::{Selection, SimBuilder};
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
            let plane = sim.dimension() == Dimension::Two;
            let normal =
                normal.0.try_normalize().filter(|unit| !plane || unit.z == 0.0).ok_or_else(|| {
                    let path = format!("probes[{k}].quantity.normal");
                    let message = "the direction must not be a zero vector";
                    vec![Problem::at_path(path, message).help("in two dimensions it has no z component")]
                })?;
            Box::new(Roughness::new(selected()?, normal, sim))
        }
        _ => return Ok(None),
    }))
}
