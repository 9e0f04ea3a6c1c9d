//! The whole experiment: the content of a scene file.

use std::collections::BTreeMap;

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::contact::is_meant;
use super::{
    BodyDescription, Contact, Dimension, Domain, Expression, Item, Precision, Probe, RecordDescription,
    Table, Time, Vec3,
};

/// An experiment: materials, bodies, conditions, contacts, plugins, duration and output.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Scene {
    /// Title of the experiment, in one line; shown in recordings and summaries.
    #[serde(default)]
    pub title: String,
    /// Numbers by name, each a number or an expression in others: `{ "dx": 0.005, "h": "10*dx" }`. Every
    /// expression may use them, and an expression in double quotes may stand wherever the scene has a number:
    /// `spacing: "dx"`.
    #[serde(default)]
    pub parameters: BTreeMap<String, Expression>,
    /// Tabulated functions by name: `{ "pull": (file: "pull.csv") }`, called in expressions as
    /// `"1e5*pull(t)"`.
    #[serde(default)]
    pub tables: BTreeMap<String, Table>,
    /// Whether the scene is plane strain in x-y or three-dimensional.
    pub dimension: Dimension,
    /// The computational domain. Without it space is unbounded.
    #[serde(default)]
    pub domain: Option<Domain>,
    /// Acceleration of gravity on all bodies \[m/s²\].
    #[serde(default)]
    pub gravity: Vec3,
    /// Floating-point precision of the sums over neighbours of fluids. Without it, `Mixed` for spacings of
    /// 1e-6 to 1e6 m, `Double` for others.
    #[serde(default)]
    pub precision: Option<Precision>,
    /// Materials by the names that bodies refer to.
    pub materials: BTreeMap<String, Item>,
    /// The bodies, in the order in which their particles are created.
    pub bodies: Vec<BodyDescription>,
    /// Conditions on bodies: supports, prescribed motions, loads, initial fields.
    #[serde(default)]
    pub conditions: Vec<Item>,
    /// Pairs of bodies with contact. Bodies that are not named in any pair pass through each other.
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
    /// Recorded quantities and intervals.
    #[serde(default)]
    pub record: RecordDescription,
}

impl Scene {
    /// The body with this name.
    pub fn body(&self, name: &str) -> Option<&BodyDescription> {
        self.bodies.iter().find(|body| body.name == name)
    }

    /// The bodies that a name refers to: one, or with a star at its end all whose names begin with it.
    pub fn bodies_named(&self, name: &str) -> impl Iterator<Item = &BodyDescription> {
        self.bodies.iter().filter(move |body| is_meant(name, &body.name))
    }

    /// Whether a body, by its number, has a plugin of that name, its own or one of the scene.
    pub fn has_plugin(&self, body: usize, name: &str) -> bool {
        self.plugins.iter().chain(&self.bodies[body].plugins).any(|plugin| plugin.name() == name)
    }

    /// The contacts pair by pair: the number of the contact in the scene, and those of its bodies.
    pub fn contact_pairs(&self) -> impl Iterator<Item = (usize, [usize; 2])> {
        let pairs_of = |(k, contact): (usize, &Contact)| {
            contact.pairs(&self.bodies).into_iter().map(move |pair| (k, pair))
        };
        self.contacts.iter().enumerate().flat_map(pairs_of)
    }

    /// The values of the parameters.
    pub fn parameter_values(&self) -> BTreeMap<String, f64> {
        let value = |expression: &Expression| expression.eval(glam::DVec3::ZERO, 0.0);
        self.parameters.iter().map(|(name, expression)| (name.clone(), value(expression))).collect()
    }

    /// Time between two frames of the recording \[s\]: `record.every`, or a hundredth of the duration.
    pub fn record_interval(&self) -> f64 {
        self.record.every.unwrap_or(self.time.end / 100.0)
    }

    /// Time between two samples of `probe` \[s\]: `every` of the probe, or a tenth of the interval of the
    /// recording.
    pub fn probe_interval(&self, probe: &Probe) -> f64 {
        probe.every.unwrap_or(self.record_interval() / 10.0)
    }
}
