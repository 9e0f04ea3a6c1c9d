//! The scene of a case, with its resolution and parameters set.

use std::fmt::Display;

use anyhow::Result;
use meshless_engine::assembly;
use meshless_engine::plugin::Registry;
use meshless_engine::scene::{self, SceneError, Source};
use meshless_engine::simulation::Simulation;

/// A scene text with overrides, set before it is built.
#[derive(Clone)]
pub struct Template(Source);

impl Template {
    /// The scene of a case by the path of its file.
    pub fn new(path: &str, text: &str) -> Self {
        Self(Source::new(path, text))
    }

    /// Sets a value, as `--set path=value` does.
    pub fn set(self, path: &str, value: impl Display) -> Result<Self> {
        let set = self.0.with_override(path, &value.to_string());
        Ok(Self(set.map_err(|problem| self.0.error(vec![problem]))?))
    }

    /// Builds the simulation.
    pub fn build(self, registry: &Registry) -> Result<Simulation, SceneError> {
        let (scene, source) = scene::parse(self.0)?;
        assembly::build(&scene, &source, registry)
    }
}
