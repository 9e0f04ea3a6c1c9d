//! The registry: which names a scene may use, and what is behind them.

use std::any::Any;
use std::collections::BTreeMap;

use super::builder::SimBuilder;
use super::error::SetupError;
use super::traits::{Formulation, Plugin};
use crate::materials::{Material, MaterialModel};
use crate::scene::{Item, Parameter, Problem, TypeDoc, parameters, type_docs, unknown};
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
const LATER: [(Kind, &str); 5] = [
    (Kind::Formulation, "UpdatedLagrangian"),
    (Kind::Formulation, "Eulerian"),
    (Kind::Formulation, "Rigid"),
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
type BuildPlugin = fn(&Item, &mut SimBuilder<'_>) -> Result<(), Vec<Problem>>;

/// The names that a scene may use. The standard ones are those of [`Registry::standard`] and of the plugin crates.
#[derive(Default)]
pub struct Registry {
    materials: BTreeMap<&'static str, BuildMaterial>,
    formulations: BTreeMap<&'static str, FormulationEntry>,
    plugins: BTreeMap<(Kind, &'static str), BuildPlugin>,
    entries: BTreeMap<(Kind, &'static str), Entry>,
}

impl Registry {
    /// What the engine itself brings: materials, formulations and conditions, no plugin.
    pub fn standard() -> Self {
        Self::default()
            .with(crate::materials::register)
            .with(crate::formulations::register)
            .with(crate::boundaries::register)
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

    /// Registers a plugin.
    pub fn plugin<P: Plugin>(&mut self) -> &mut Self {
        self.plugins.insert((Kind::Plugin, P::NAME), build_plugin::<P>);
        self.describe::<P>(Kind::Plugin, P::NAME, P::REFERENCE)
    }

    /// Lets a crate register what it has: `registry.with(my_plugin::register)`.
    #[must_use]
    pub fn with(mut self, register: impl FnOnce(&mut Registry)) -> Self {
        register(&mut self);
        self
    }

    /// All names of a kind, in order, with their parameters.
    pub fn entries(&self, kind: Kind) -> impl Iterator<Item = &Entry> {
        self.entries.iter().filter(move |((k, _), _)| *k == kind).map(|(_, entry)| entry)
    }

    fn describe<T: schemars::JsonSchema>(
        &mut self,
        kind: Kind,
        name: &'static str,
        reference: &'static str,
    ) -> &mut Self {
        let entry = Entry { name, reference, parameters: parameters::<T>(), docs: type_docs::<T>() };
        self.entries.insert((kind, name), entry);
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
        let (message, helps) = unknown(kind.word(), item.name(), &known);
        vec![item.problem_with_name(message).helps(helps)]
    }

    pub(super) fn build_material(&self, item: &Item) -> Result<Material, Vec<Problem>> {
        let build = self.materials.get(item.name()).ok_or_else(|| self.unknown(Kind::Material, item))?;
        build(item)
    }

    pub(super) fn find_formulation(&self, item: &Item) -> Result<&FormulationEntry, Vec<Problem>> {
        self.formulations.get(item.name()).ok_or_else(|| self.unknown(Kind::Formulation, item))
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
