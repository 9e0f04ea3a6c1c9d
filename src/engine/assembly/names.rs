//! The first check of a scene against a registry: every name is known, and its parameters can be read. All misspellings are reported at once, before
//! anything is placed or estimated.

use crate::plugin::{Kind, Registry};
use crate::scene::{Item, Problem, Scene};

/// What is wrong with the names of a scene and their parameters.
pub(super) fn problems(scene: &Scene, registry: &Registry) -> Vec<Problem> {
    let mut found = Vec::new();
    for (kind, item) in items(scene) {
        if let Err(problems) = registry.check(kind, item) {
            found.extend(problems);
        }
    }
    for list in scene.bodies.iter().map(|body| &body.plugins).chain([&scene.plugins]) {
        found.extend(given_twice(list));
    }
    found
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
fn items(scene: &Scene) -> impl Iterator<Item = (Kind, &Item)> {
    let materials = scene.materials.values().map(|item| (Kind::Material, item));
    let bodies = scene.bodies.iter().flat_map(|body| {
        let plugins = body.plugins.iter().map(|item| (Kind::Plugin, item));
        std::iter::once((Kind::Formulation, &body.formulation)).chain(plugins)
    });
    let conditions = scene.conditions.iter().map(|item| (Kind::Condition, item));
    let contacts = scene.contacts.iter().map(|contact| (Kind::ContactLaw, &contact.law));
    let plugins = scene.plugins.iter().map(|item| (Kind::Plugin, item));
    materials.chain(bodies).chain(conditions).chain(contacts).chain(plugins)
}
