//! The registry: the names that a scene can use, and their implementations.

use std::any::Any;
use std::collections::{BTreeMap, BTreeSet};
use std::sync::{Arc, LazyLock};

use serde::de::DeserializeOwned;

use super::builder::SimBuilder;
use super::distances::Distances;
use super::error::SetupError;
use super::offers::{BodyKind, Offer};
use super::plan::BodyPlan;
use super::traits::{Formulation, Plugin, Support};
use crate::kernels::KernelName;
use crate::materials::{Material, MaterialModel};
use crate::scene::{Described, Item, Parameter, Problem, Scene, TypeDoc, parameters, unknown};
use crate::world::{BodyId, ColumnSet};

/// Kind of the thing that a name of a scene stands for.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum EntryKind {
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

impl EntryKind {
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

/// Registered facts of a name.
#[derive(Clone, Debug)]
pub struct Entry {
    /// Name in scenes.
    pub name: &'static str,
    /// Source of the method.
    pub reference: &'static str,
    /// Made once it is asked for: a run does not need the descriptions of all that scenes may name.
    description: Arc<LazyLock<Description>>,
}

#[derive(Debug)]
struct Description {
    parameters: Vec<Parameter>,
    docs: Vec<TypeDoc>,
}

impl Description {
    fn of<T: schemars::JsonSchema>() -> Self {
        let described = Described::of::<T>();
        Self { parameters: described.parameters(), docs: described.docs() }
    }
}

impl Entry {
    /// Description, in a line or a few.
    pub fn doc(&self) -> &str {
        self.docs().first().map_or("", |own| &own.doc)
    }

    /// Parameters with type, default and documentation.
    pub fn parameters(&self) -> &[Parameter] {
        &self.description.parameters
    }

    /// The documentation of the entry itself, then of the types of its parameters.
    pub fn docs(&self) -> &[TypeDoc] {
        &self.description.docs
    }
}

/// Names of the scene grammar that this version cannot resolve yet: told apart from misspelt ones.
const LATER: &[(EntryKind, &str)] = &[(EntryKind::Plugin, "artificial_stress")];

type ParsedBodies = Vec<(BodyId, Box<dyn Any>)>;

#[derive(Clone)]
pub(crate) struct FormulationEntry {
    pub name: &'static str,
    pub reference: &'static str,
    pub kind: BodyKind,
    pub offers: &'static [Offer],
    pub bytes_per_particle: usize,
    pub support: fn(&dyn Any, &BodyPlan) -> Option<f64>,
    pub kernel: fn(&dyn Any) -> Option<KernelName>,
    pub distances: fn(&dyn Any, &BodyPlan) -> Distances,
    pub parse: fn(&Item) -> Result<Box<dyn Any>, Vec<Problem>>,
    pub columns: fn(&mut ColumnSet),
    pub assemble: fn(ParsedBodies, &mut SimBuilder<'_>) -> Result<(), SetupError>,
}

type BuildMaterial = fn(&Item) -> Result<Material, Vec<Problem>>;
type ParseItem = fn(&Item) -> Result<(), Vec<Problem>>;
type BuildPlugin = fn(&Item, &mut SimBuilder<'_>) -> Result<(), Vec<Problem>>;
type ReadSupport = fn(&Item, &mut dyn FnMut(Support<'_>));

/// The names that a scene may use. The standard ones are those of [`Registry::standard`] and of the plugin
/// crates.
#[derive(Clone, Default)]
pub struct Registry {
    materials: BTreeMap<&'static str, BuildMaterial>,
    formulations: BTreeMap<&'static str, FormulationEntry>,
    /// Formulations that stand in for others.
    stand_ins: BTreeMap<&'static str, &'static str>,
    builders: BTreeMap<(EntryKind, &'static str), Arc<dyn Any + Send + Sync>>,
    plugins: BTreeMap<(EntryKind, &'static str), BuildPlugin>,
    supports: BTreeMap<&'static str, ReadSupport>,
    /// Names of the plugins that change the laws of materials.
    of_materials: BTreeSet<&'static str>,
    parsers: BTreeMap<(EntryKind, &'static str), ParseItem>,
    entries: BTreeMap<(EntryKind, &'static str), Entry>,
}

impl Registry {
    /// Registers a material.
    pub fn material<M: MaterialModel>(&mut self) -> &mut Self {
        self.materials.insert(M::NAME, |item| {
            let model: M = item.parse()?;
            model.build().map_err(|error| SetupError::from(error).into_problems(item))
        });
        self.describe::<M>(EntryKind::Material, M::NAME, M::REFERENCE)
    }

    /// Registers a formulation.
    pub fn formulation<F: Formulation>(&mut self) -> &mut Self {
        let entry = FormulationEntry {
            name: F::NAME,
            reference: F::REFERENCE,
            kind: F::KIND,
            offers: F::OFFERS,
            bytes_per_particle: F::BYTES_PER_PARTICLE,
            support: |any, body| any.downcast_ref::<F>()?.support(body),
            kernel: |any| any.downcast_ref::<F>()?.kernel(),
            distances: |any, body| {
                any.downcast_ref::<F>().map_or(Distances::Reference, |of| of.distances(body))
            },
            parse: |item| Ok(Box::new(item.parse::<F>()?)),
            columns: F::columns,
            assemble: |bodies, sim| {
                let parsed =
                    bodies.into_iter().filter_map(|(id, any)| Some((id, *any.downcast::<F>().ok()?)));
                F::assemble(parsed.collect(), sim)
            },
        };
        self.formulations.insert(F::NAME, entry);
        self.describe::<F>(EntryKind::Formulation, F::NAME, F::REFERENCE)
    }

    /// Kind of the bodies of the formulation of that name.
    pub fn body_kind(&self, formulation: &str) -> Option<BodyKind> {
        self.formulations.get(formulation).map(|entry| entry.kind)
    }

    /// Registers a boundary or initial condition.
    pub fn condition<P: Plugin>(&mut self) -> &mut Self {
        self.plugins.insert((EntryKind::Condition, P::NAME), build_plugin::<P>);
        self.supports.insert(P::NAME, |item, look| {
            let condition = item.parse::<P>();
            condition.iter().filter_map(Plugin::support).for_each(look);
        });
        self.describe::<P>(EntryKind::Condition, P::NAME, P::REFERENCE)
    }

    /// Registers what only another module of the engine knows how to build: it finds the builder again by
    /// [`Registry::builder`].
    pub(crate) fn add_builder<T: schemars::JsonSchema + DeserializeOwned, B: Any + Send + Sync>(
        &mut self,
        kind: EntryKind,
        name: &'static str,
        reference: &'static str,
        build: B,
    ) -> &mut Self {
        self.builders.insert((kind, name), Arc::new(build));
        self.describe::<T>(kind, name, reference)
    }

    /// Registers a plugin.
    pub fn plugin<P: Plugin>(&mut self) -> &mut Self {
        if P::CHANGES_MATERIALS {
            self.of_materials.insert(P::NAME);
        }
        self.plugins.insert((EntryKind::Plugin, P::NAME), build_plugin::<P>);
        self.describe::<P>(EntryKind::Plugin, P::NAME, P::REFERENCE)
    }

    /// Lets a crate register its items: `registry.with(my_plugin::register)`.
    #[must_use]
    pub fn with(mut self, register: impl FnOnce(&mut Registry)) -> Self {
        register(&mut self);
        self
    }

    /// Gives every body that names one formulation another one, with the parameters that it has in the scene:
    /// to run scenes with another method.
    #[must_use]
    pub fn with_stand_in(mut self, named: &'static str, other: &'static str) -> Self {
        self.stand_ins.insert(named, other);
        self
    }

    /// Whether a plugin changes the laws of materials.
    pub(crate) fn changes_materials(&self, item: &Item) -> bool {
        self.of_materials.contains(item.name())
    }

    /// All names of a kind, in order, with their parameters.
    pub fn entries(&self, kind: EntryKind) -> impl Iterator<Item = &Entry> {
        self.entries.iter().filter(move |((k, _), _)| *k == kind).map(|(_, entry)| entry)
    }

    /// The formulations.
    pub(crate) fn formulations(&self) -> impl Iterator<Item = &FormulationEntry> {
        self.formulations.values()
    }

    fn describe<T: schemars::JsonSchema + DeserializeOwned>(
        &mut self,
        kind: EntryKind,
        name: &'static str,
        reference: &'static str,
    ) -> &mut Self {
        let entry = Entry { name, reference, description: Arc::new(LazyLock::new(Description::of::<T>)) };
        self.entries.insert((kind, name), entry);
        self.parsers.insert((kind, name), |item| item.parse::<T>().map(drop));
        self
    }

    fn unknown(&self, kind: EntryKind, item: &Item) -> Vec<Problem> {
        if LATER.contains(&(kind, item.name())) {
            let message = format!("{} `{}` is not implemented yet", kind.word(), item.name());
            let known: Vec<&str> = self.entries(kind).map(|entry| entry.name).collect();
            let help = format!("known here: `{}`", known.join("`, `"));
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

    /// Checks whether a name is known and its parameters can be read.
    pub(crate) fn check(&self, kind: EntryKind, item: &Item) -> Result<(), Vec<Problem>> {
        let parse = self.parsers.get(&(kind, item.name())).ok_or_else(|| self.unknown(kind, item))?;
        parse(item)
    }

    pub(crate) fn build_material(&self, item: &Item) -> Result<Material, Vec<Problem>> {
        let build = self.materials.get(item.name()).ok_or_else(|| self.unknown(EntryKind::Material, item))?;
        build(item)
    }

    pub(crate) fn find_formulation(&self, item: &Item) -> Result<&FormulationEntry, Vec<Problem>> {
        let name = self.stand_ins.get(item.name()).copied().unwrap_or(item.name());
        self.formulations.get(name).ok_or_else(|| self.unknown(EntryKind::Formulation, item))
    }

    /// The value that [`Registry::add_builder`] was given for a name.
    pub(crate) fn builder<B: Any>(&self, kind: EntryKind, item: &Item) -> Result<&B, Vec<Problem>> {
        let named = self.builders.iter().find(|((of, name), _)| *of == kind && *name == item.name());
        let build = named.and_then(|(_, build)| build.downcast_ref());
        build.ok_or_else(|| self.unknown(kind, item))
    }

    /// The source of the item of a name; empty if it has none.
    pub(crate) fn reference(&self, kind: EntryKind, name: &str) -> &'static str {
        self.entries
            .iter()
            .find(|((k, n), _)| *k == kind && *n == name)
            .map_or("", |(_, entry)| entry.reference)
    }

    /// The support of a condition; nothing if its parameters cannot be read, which is reported where it is
    /// built.
    pub(crate) fn support(&self, item: &Item, mut look: impl FnMut(Support<'_>)) {
        if let Some(read) = self.supports.get(item.name()) {
            read(item, &mut look);
        }
    }

    pub(crate) fn build_plugin(
        &self,
        kind: EntryKind,
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
