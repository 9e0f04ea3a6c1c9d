//! The registry: which names a scene may use, and what is behind them.

use std::any::Any;
use std::collections::{BTreeMap, BTreeSet};

use serde::de::DeserializeOwned;

use super::builder::SimBuilder;
use super::error::SetupError;
use super::traits::{Formulation, Plugin};
use crate::contact::{ContactLaw, ContactPair, NormalForce};
use crate::materials::{Material, MaterialModel};
use crate::scene::{Item, Parameter, Problem, Scene, TypeDoc, parameters, type_docs, unknown};
use crate::world::{BodyId, ColumnSet};

/// What kind of thing a name of a scene stands for.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Kind {
    /// A material.
    Material,
    /// A formulation.
    Formulation,
    /// A boundary or initial condition.
    Condition,
    /// A contact law.
    ContactLaw,
    /// A plugin.
    Plugin,
}

impl Kind {
    /// The kind in words.
    pub fn word(self) -> &'static str {
        match self {
            Self::Material => "material",
            Self::Formulation => "formulation",
            Self::Condition => "condition",
            Self::ContactLaw => "contact law",
            Self::Plugin => "plugin",
        }
    }
}

/// What the registry tells about a name.
#[derive(Clone, Debug)]
pub struct Entry {
    /// Name in scenes.
    pub name: &'static str,
    /// Source of the method.
    pub reference: &'static str,
    /// Parameters with type, default and documentation.
    pub parameters: Vec<Parameter>,
    /// The documentation of the entry itself, then of the types of its parameters.
    pub docs: Vec<TypeDoc>,
}

impl Entry {
    /// What it is, in a line or a few.
    pub fn doc(&self) -> &str {
        self.docs.first().map_or("", |own| &own.doc)
    }
}

/// Names of the scene grammar that this version cannot resolve yet: told apart from misspelt ones.
const LATER: &[(Kind, &str)] = &[
    (Kind::Formulation, "UpdatedLagrangian"),
    (Kind::Formulation, "Eulerian"),
    (Kind::Plugin, "hessian_stabilization"),
    (Kind::Plugin, "artificial_stress"),
];

type ParsedBodies = Vec<(BodyId, Box<dyn Any>)>;

pub(super) struct FormulationEntry {
    pub name: &'static str,
    pub reference: &'static str,
    pub parse: fn(&Item) -> Result<Box<dyn Any>, Vec<Problem>>,
    pub columns: fn(&mut ColumnSet),
    pub assemble: fn(ParsedBodies, &mut SimBuilder<'_>) -> Result<(), SetupError>,
}

type BuildMaterial = fn(&Item) -> Result<Material, Vec<Problem>>;
type BuildContactLaw = fn(&Item, &ContactPair) -> Result<Box<dyn NormalForce>, Vec<Problem>>;
type ParseItem = fn(&Item) -> Result<(), Vec<Problem>>;
type BuildPlugin = fn(&Item, &mut SimBuilder<'_>) -> Result<(), Vec<Problem>>;

/// The names that a scene may use. The standard ones are those of [`Registry::standard`] and of the plugin crates.
#[derive(Default)]
pub struct Registry {
    materials: BTreeMap<&'static str, BuildMaterial>,
    formulations: BTreeMap<&'static str, FormulationEntry>,
    contact_laws: BTreeMap<&'static str, BuildContactLaw>,
    plugins: BTreeMap<(Kind, &'static str), BuildPlugin>,
    /// Names of the plugins that change the laws of materials.
    of_materials: BTreeSet<&'static str>,
    parsers: BTreeMap<(Kind, &'static str), ParseItem>,
    entries: BTreeMap<(Kind, &'static str), Entry>,
}

impl Registry {
    /// What the engine itself brings: materials, formulations, conditions and contact laws, no plugin.
    pub fn standard() -> Self {
        Self::default()
            .with(crate::materials::register)
            .with(crate::formulations::register)
            .with(crate::boundaries::register)
            .with(crate::contact::register)
    }

    /// Registers a material.
    pub fn material<M: MaterialModel>(&mut self) -> &mut Self {
        self.materials.insert(M::NAME, |item| {
            let model: M = item.parse()?;
            model.build().map_err(|error| SetupError::from(error).into_problems(item))
        });
        self.describe::<M>(Kind::Material, M::NAME, M::REFERENCE)
    }

    /// Registers a formulation.
    pub fn formulation<F: Formulation>(&mut self) -> &mut Self {
        let entry = FormulationEntry {
            name: F::NAME,
            reference: F::REFERENCE,
            parse: |item| Ok(Box::new(item.parse::<F>()?)),
            columns: F::columns,
            assemble: |bodies, sim| {
                let parsed =
                    bodies.into_iter().filter_map(|(id, any)| Some((id, *any.downcast::<F>().ok()?)));
                F::assemble(parsed.collect(), sim)
            },
        };
        self.formulations.insert(F::NAME, entry);
        self.describe::<F>(Kind::Formulation, F::NAME, F::REFERENCE)
    }

    /// Registers a boundary or initial condition.
    pub fn condition<P: Plugin>(&mut self) -> &mut Self {
        self.plugins.insert((Kind::Condition, P::NAME), build_plugin::<P>);
        self.describe::<P>(Kind::Condition, P::NAME, P::REFERENCE)
    }

    /// Registers a contact law.
    pub fn contact_law<L: ContactLaw>(&mut self) -> &mut Self {
        self.contact_laws.insert(L::NAME, |item, pair| {
            let law: L = item.parse()?;
            law.build(pair).map_err(|error| SetupError::from(error).into_problems(item))
        });
        self.describe::<L>(Kind::ContactLaw, L::NAME, L::REFERENCE)
    }

    /// Registers a plugin.
    pub fn plugin<P: Plugin>(&mut self) -> &mut Self {
        if P::CHANGES_MATERIALS {
            self.of_materials.insert(P::NAME);
        }
        self.plugins.insert((Kind::Plugin, P::NAME), build_plugin::<P>);
        self.describe::<P>(Kind::Plugin, P::NAME, P::REFERENCE)
    }

    /// Lets a crate register what it has: `registry.with(my_plugin::register)`.
    #[must_use]
    pub fn with(mut self, register: impl FnOnce(&mut Registry)) -> Self {
        register(&mut self);
        self
    }

    /// Whether a plugin changes the laws of materials.
    pub(super) fn changes_materials(&self, item: &Item) -> bool {
        self.of_materials.contains(item.name())
    }

    /// All names of a kind, in order, with their parameters.
    pub fn entries(&self, kind: Kind) -> impl Iterator<Item = &Entry> {
        self.entries.iter().filter(move |((k, _), _)| *k == kind).map(|(_, entry)| entry)
    }

    fn describe<T: schemars::JsonSchema + DeserializeOwned>(
        &mut self,
        kind: Kind,
        name: &'static str,
        reference: &'static str,
    ) -> &mut Self {
        let entry = Entry { name, reference, parameters: parameters::<T>(), docs: type_docs::<T>() };
        self.entries.insert((kind, name), entry);
        self.parsers.insert((kind, name), |item| item.parse::<T>().map(drop));
        self
    }

    fn unknown(&self, kind: Kind, item: &Item) -> Vec<Problem> {
        if LATER.contains(&(kind, item.name())) {
            let message = format!("{} `{}` is not there yet", kind.word(), item.name());
            let known: Vec<&str> = self.entries(kind).map(|entry| entry.name).collect();
            let help = format!("a later version will have it; known now: `{}`", known.join("`, `"));
            return vec![item.problem_with_name(message).help(help)];
        }
        let known: Vec<&str> = self.entries(kind).map(|entry| entry.name).collect();
        let (message, mut helps) = unknown(kind.word(), item.name(), &known);
        let field = item.name().to_lowercase();
        if parameters::<Scene>().iter().any(|parameter| parameter.name == field) {
            helps.insert(0, format!("`{field}` is a field of `Scene`"));
        }
        vec![item.problem_with_name(message).helps(helps)]
    }

    /// Looks whether a name is known and its parameters can be read.
    pub(super) fn check(&self, kind: Kind, item: &Item) -> Result<(), Vec<Problem>> {
        let parse = self.parsers.get(&(kind, item.name())).ok_or_else(|| self.unknown(kind, item))?;
        parse(item)
    }

    pub(super) fn build_material(&self, item: &Item) -> Result<Material, Vec<Problem>> {
        let build = self.materials.get(item.name()).ok_or_else(|| self.unknown(Kind::Material, item))?;
        build(item)
    }

    pub(super) fn find_formulation(&self, item: &Item) -> Result<&FormulationEntry, Vec<Problem>> {
        self.formulations.get(item.name()).ok_or_else(|| self.unknown(Kind::Formulation, item))
    }

    pub(super) fn build_contact_law(
        &self,
        item: &Item,
        pair: &ContactPair,
    ) -> Result<Box<dyn NormalForce>, Vec<Problem>> {
        let build = self.contact_laws.get(item.name()).ok_or_else(|| self.unknown(Kind::ContactLaw, item))?;
        build(item, pair)
    }

    /// The source of what is behind a name; empty if it has none.
    pub(super) fn reference(&self, kind: Kind, name: &str) -> &'static str {
        self.entries
            .iter()
            .find(|((k, n), _)| *k == kind && *n == name)
            .map_or("", |(_, entry)| entry.reference)
    }

    pub(super) fn build_plugin(
        &self,
        kind: Kind,
        item: &Item,
        sim: &mut SimBuilder<'_>,
    ) -> Result<&'static str, Vec<Problem>> {
        let (_, build) =
            self.plugins.get_key_value(&(kind, item.name())).ok_or_else(|| self.unknown(kind, item))?;
        build(item, sim)?;
        Ok(self.entries.get(&(kind, item.name())).map_or("", |entry| entry.reference))
    }
}

fn build_plugin<P: Plugin>(item: &Item, sim: &mut SimBuilder<'_>) -> Result<(), Vec<Problem>> {
    let plugin: P = item.parse()?;
    plugin.build(sim).map_err(|error| error.into_problems(item))
}
