//! Particles that do not move.

use glam::DVec3;
use schemars::JsonSchema;
use serde::Deserialize;

use super::rigid_part::split_rigid;
use crate::plugin::{Plugin, Prescription, SetupError, SimBuilder, Support};
use crate::rigid::{Drive, DrivenBody};
use crate::scene::{Axis, Edge, Select};
use crate::schedule::{Clock, StepError};
use crate::world::Velocity;

/// Holds particles where they are at the start.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Fix {
    /// Particles.
    pub on: Select,
    /// Axes along which they are held.
    #[serde(default = "all_axes")]
    pub axes: Vec<Axis>,
    /// Where the held part of a body ends.
    #[serde(default)]
    pub edge: Edge,
}

fn all_axes() -> Vec<Axis> {
    vec![Axis::X, Axis::Y, Axis::Z]
}

/// No motion.
struct NoMotion;

impl Drive for NoMotion {
    fn velocity(&self, _: bool, _: &Clock, _: DVec3, _: DVec3) -> Result<DVec3, StepError> {
        Ok(DVec3::ZERO)
    }
}

impl Plugin for Fix {
    const NAME: &'static str = "Fix";
    const REFERENCE: &'static str = "";

    fn support(&self) -> Option<Support<'_>> {
        let axes = [Axis::X, Axis::Y, Axis::Z].map(|axis| self.axes.contains(&axis));
        Some(Support { on: &self.on, axes, edge: self.edge })
    }

    fn build(self, sim: &mut SimBuilder<'_>) -> Result<(), SetupError> {
        let selection = sim.select(&self.on, "on")?;
        let held = [Axis::X, Axis::Y, Axis::Z].map(|axis| self.axes.contains(&axis));
        // A prescribed axis has no mobility: with zero velocity nothing ever moves it, and no system has to
        // run.
        sim.carry(&selection, held);
        let (selection, rigid) = split_rigid(&selection, sim)?;
        for body in rigid {
            let motion = Prescription::rest(Self::NAME);
            sim.extend(DrivenBody { body, motion, axes: held, drive: Box::new(NoMotion) });
        }
        sim.prescribe(&selection, held, Prescription::rest(Self::NAME))?;
        sim.add_setup(move |setup| {
            for (body, rows) in &selection.parts {
                let (view, _) = setup.world.body_view(*body);
                let mut velocity = view.write::<Velocity>().map_err(|error| SetupError::internal(&error))?;
                for &row in rows {
                    for axis in (0..3).filter(|&axis| held[axis]) {
                        velocity[row as usize].0[axis] = 0.0;
                    }
                }
            }
            Ok(())
        });
        Ok(())
    }
}
