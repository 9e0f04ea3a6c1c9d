//! The whole experiment: what a scene file says.

use std::collections::BTreeMap;

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::{Body, Contact, Dimension, Domain, Item, Probe, Record, Time, Vec3};

/// An experiment: materials, bodies made of them, what acts on them, how long it runs and what is recorded.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Scene {
    /// What the experiment is, in one line; shown in recordings and summaries.
    #[serde(default)]
    pub title: String,
    /// Whether the scene is plane strain in x-y or three-dimensional.
    pub dimension: Dimension,
    /// The space in which particles may be. Without it space is unbounded.
    #[serde(default)]
    pub domain: Option<Domain>,
    /// Acceleration of gravity on all bodies \[m/s²\].
    #[serde(default)]
    pub gravity: Vec3,
    /// Materials by the names that bodies refer to.
    pub materials: BTreeMap<String, Item>,
    /// The bodies, in the order in which their particles are created.
    pub bodies: Vec<Body>,
    /// What is imposed on bodies: supports, motions, loads, initial fields.
    #[serde(default)]
    pub conditions: Vec<Item>,
    /// Pairs of bodies that touch. Bodies that are not named in any pair pass through each other.
    #[serde(default)]
    pub contacts: Vec<Contact>,
    /// Plugins for all bodies that they fit.
    #[serde(default)]
    pub plugins: Vec<Item>,
    /// Duration and time step.
    pub time: Time,
    /// Quantities that are written as functions of time.
    #[serde(default)]
    pub probes: Vec<Probe>,
    /// What is recorded, and how often.
    #[serde(default)]
    pub record: Record,
}

impl Scene {
    /// The body with this name.
    pub fn body(&self, name: &str) -> Option<&Body> {
        self.bodies.iter().find(|body| body.name == name)
    }

    /// Time between two frames of the recording \[s\]: `record.every`, or a hundredth of the duration.
    pub fn record_interval(&self) -> f64 {
        self.record.every.unwrap_or(self.time.end / 100.0)
    }

    /// Time between two samples of `probe` \[s\]: `every` of the probe, or a tenth of the interval of the recording.
    pub fn probe_interval(&self, probe: &Probe) -> f64 {
        probe.every.unwrap_or(self.record_interval() / 10.0)
    }
}
