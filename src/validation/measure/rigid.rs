//! Measurements on rigid bodies.

use anyhow::{Context, Result};
use meshless_engine::rigid::{RigidBodies, RigidState};
use meshless_engine::simulation::Simulation;

use super::motion::body;

/// State of the rigid body with this name.
pub fn state(simulation: &Simulation, name: &str) -> Result<RigidState> {
    let id = body(simulation, name)?;
    let bodies = simulation.resources().get::<RigidBodies>();
    let found = bodies.iter().find(|body| body.id == id).map(|body| body.state);
    found.with_context(|| format!("`{name}` is not rigid"))
}
