//! Requirements that several parts of a scene share: names, intervals, vectors in the plane.

use glam::DVec3;

use super::contact::ANY;
use super::names::unknown;
use super::{Dimension, Problem, Scene};
use crate::notation::number;

pub(super) fn unknown_body(scene: &Scene, name: &str) -> Option<(String, Vec<String>)> {
    let names: Vec<_> = scene.bodies.iter().map(|body| &body.name).collect();
    scene.body(name).is_none().then(|| unknown("body", name, &names))
}

/// Message and help for a name, possibly with a star, that matches no body.
pub(super) fn unknown_bodies(scene: &Scene, name: &str) -> Option<(String, Vec<String>)> {
    match name.strip_suffix(ANY) {
        None => unknown_body(scene, name),
        Some(start) => scene.bodies_named(name).next().is_none().then(|| {
            let names: Vec<_> = scene.bodies.iter().map(|body| &body.name).collect();
            let (_, help) = unknown("body", start, &names);
            (format!("no body has a name that begins with `{start}`"), help)
        }),
    }
}

pub(super) fn usable_name(kind: &str, name: &str, at: String, problems: &mut Vec<Problem>) {
    let fits = |c: char| c.is_alphanumeric() || matches!(c, '_' | '-' | '+' | ' ');
    let what = if name.is_empty() {
        format!("the name of the {kind} is empty")
    } else if name.len() > 100 {
        format!("the name of the {kind} is longer than 100 bytes")
    } else if let Some(c) = name.chars().find(|&c| !fits(c)) {
        format!("character {c:?} is not allowed in the name of a {kind}")
    } else if name.trim() != name {
        format!("the name of the {kind} starts or ends with a space")
    } else {
        return;
    };
    problems
        .push(Problem::at_path(at, what).help("names are made of letters, digits, spaces, `_`, `-`, `+`"));
}

pub(super) fn twice(kind: &str, name: &str, at: String) -> Problem {
    Problem::at_path(at, format!("two {kind} names are the same: `{name}`")).help("names must differ")
}

pub(super) fn positive_time(every: Option<f64>, at: &str, problems: &mut Vec<Problem>) {
    if let Some(every) = every.filter(|every| *every <= 0.0) {
        problems
            .push(Problem::at_path(at, format!("the interval must be positive, found {} s", number(every))));
    }
}

pub(super) const IN_PLANE: &str = "write (x, y); a two-dimensional scene is plane strain in x-y";

pub(super) fn out_of_plane(z: f64) -> String {
    format!("z must be 0 or left out in two dimensions, found {}", number(z))
}

pub(super) fn in_plane(scene: &Scene, vector: DVec3, at: &str, problems: &mut Vec<Problem>) {
    if scene.dimension == Dimension::Two && vector.z != 0.0 {
        problems.push(Problem::at_path(at, out_of_plane(vector.z)).help(IN_PLANE));
    }
}
