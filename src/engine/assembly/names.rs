//! The first check of a scene against a registry: every name is known, and its parameters can be read. All
//! misspellings are reported at once, before anything is placed or estimated.

use crate::plugin::{BodyKind, EntryKind, Registry};
use crate::scene::{BodyDescription, Item, Problem, Scene, unknown};

/// Problems of the names of a scene and their parameters: the first ones that [`build`](super::build())
/// finds, for [`load_checked`](crate::scene::load_checked).
pub fn name_problems(scene: &Scene, registry: &Registry) -> Vec<Problem> {
    let mut found = Vec::new();
    for (kind, item) in items(scene) {
        if let Err(problems) = registry.check(kind, item) {
            found.extend(problems);
        }
    }
    found.extend(unknown_materials(scene, registry));
    for list in scene.bodies.iter().map(|body| &body.plugins).chain([&scene.plugins]) {
        found.extend(given_twice(list));
    }
    found
}

/// Materials of bodies that the scene does not have; boundaries of fluids need none.
fn unknown_materials(scene: &Scene, registry: &Registry) -> impl Iterator<Item = Problem> {
    let known: Vec<&String> = scene.materials.keys().collect();
    let needs_it = |(_, body): &(usize, &BodyDescription)| {
        registry.body_kind(body.formulation.name()) != Some(BodyKind::Boundary)
            && !scene.materials.contains_key(&body.material)
    };
    scene.bodies.iter().enumerate().filter(needs_it).map(move |(k, body)| {
        let (message, help) = unknown("material", &body.material, &known);
        Problem::at_path(format!("bodies[{k}].material"), message).helps(help)
    })
}

/// A plugin that is named twice in one list would act twice.
fn given_twice(list: &[Item]) -> impl Iterator<Item = Problem> {
    let again = |(k, item): &(usize, &Item)| list[..*k].iter().any(|other| other.name() == item.name());
    list.iter().enumerate().filter(again).map(|(_, item)| {
        let message = format!("plugin `{}` is given twice in one list", item.name());
        item.problem_with_name(message).help("leave one of them out")
    })
}

/// All that a registry has to know, in the order of scenes.
fn items(scene: &Scene) -> impl Iterator<Item = (EntryKind, &Item)> {
    let materials = scene.materials.values().map(|item| (EntryKind::Material, item));
    let bodies = scene.bodies.iter().flat_map(|body| {
        let plugins = body.plugins.iter().map(|item| (EntryKind::Plugin, item));
        std::iter::once((EntryKind::Formulation, &body.formulation)).chain(plugins)
    });
    let conditions = scene.conditions.iter().map(|item| (EntryKind::Condition, item));
    let contacts = scene.contacts.iter().map(|contact| (EntryKind::ContactLaw, &contact.law));
    let plugins = scene.plugins.iter().map(|item| (EntryKind::Plugin, item));
    materials.chain(bodies).chain(conditions).chain(contacts).chain(plugins)
}
