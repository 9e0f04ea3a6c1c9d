//! Requirements on a scene beyond the types of its values, as far as the scene alone can tell.

use super::names::unknown;
use super::requirements::{
    IN_PLANE, in_plane, out_of_plane, positive_time, twice, unknown_bodies, usable_name,
};
use super::{Axis, Dimension, Face, Problem, Scene, Select, StepRule, probe_check};
use crate::notation::number;

/// All problems with the values of a scene.
pub(super) fn check(scene: &Scene) -> Vec<Problem> {
    let mut problems = Vec::new();
    if let Some(c) = scene.title.chars().find(|&c| c.is_control() && c != '\t') {
        let message = format!("character {c:?} is not allowed in the title");
        problems.push(Problem::at_path("title", message).help("terminals would take it for a command"));
    }
    check_time(scene, &mut problems);
    check_stops(scene, &mut problems);
    check_domain(scene, &mut problems);
    in_plane(scene, scene.gravity.0, "gravity", &mut problems);
    check_bodies(scene, &mut problems);
    check_contacts(scene, &mut problems);
    probe_check::check(scene, &mut problems);
    for (field, every) in [("every", scene.record.every), ("checkpoint_every", scene.record.checkpoint_every)]
    {
        positive_time(every, &format!("record.{field}"), &mut problems);
    }
    problems
}

fn check_time(scene: &Scene, problems: &mut Vec<Problem>) {
    let end = scene.time.end;
    if end <= 0.0 {
        problems.push(
            Problem::at_path("time.end", format!("`end` must be greater than 0, found {} s", number(end)))
                .help("a run starts at 0 s"),
        );
    }
    match scene.time.step {
        StepRule::Adaptive { factor } if !(factor > 0.0 && factor <= 2.0) => problems.push(
            Problem::at_path(
                "time.step.factor",
                format!("`factor` must be greater than 0 and at most 2, found {}", number(factor)),
            )
            .help("it multiplies the stability limit; 1 is the limit itself"),
        ),
        StepRule::Fixed(dt) if dt <= 0.0 => problems.push(Problem::at_path(
            "time.step[0]",
            format!("the time step must be positive, found {} s", number(dt)),
        )),
        _ => {}
    }
    if scene.time.sub_steps == 0 {
        problems.push(
            Problem::at_path("time.sub_steps", "`sub_steps` must be at least 1, found 0")
                .help("1: all bodies share one step; without it each side takes steps of its own"),
        );
    }
}

fn check_stops(scene: &Scene, problems: &mut Vec<Problem>) {
    let names: Vec<_> = scene.probes.iter().map(|probe| &probe.name).collect();
    for (i, when) in scene.time.stop_when.iter().enumerate() {
        let at = |field: &str| format!("time.stop_when[{i}].{field}");
        if !names.contains(&&when.probe) {
            let (message, help) = unknown("probe", &when.probe, &names);
            problems.push(Problem::at_path(at("probe"), message).helps(help));
        }
        if when.above.is_none() && when.below.is_none() {
            let message = "a condition to stop needs `above` or `below`";
            problems.push(Problem::at_path(format!("time.stop_when[{i}]"), message));
        }
    }
}

fn check_domain(scene: &Scene, problems: &mut Vec<Problem>) {
    let Some(domain) = &scene.domain else { return };
    let (min, max) = (domain.min.0.to_array(), domain.max.0.to_array());
    for axis in [Axis::X, Axis::Y, Axis::Z].into_iter().take(scene.dimension.count()) {
        let i = axis.index();
        if min[i] >= max[i] {
            let message = format!(
                "`max` must exceed `min` along {axis:?}, found {} m and {} m",
                number(max[i]),
                number(min[i])
            );
            problems.push(Problem::at_path("domain.max", message).help("the domain is empty"));
        }
    }
    for (i, axis) in domain.periodic.iter().enumerate() {
        let at = format!("domain.periodic[{i}]");
        if domain.periodic[..i].contains(axis) {
            problems.push(Problem::at_path(at, format!("axis {axis:?} is given twice")));
        } else if scene.dimension == Dimension::Two && *axis == Axis::Z {
            problems.push(
                Problem::at_path(at, "a two-dimensional scene has no axis Z").help("the axes are X and Y"),
            );
        }
    }
}

fn check_bodies(scene: &Scene, problems: &mut Vec<Problem>) {
    if scene.bodies.is_empty() {
        problems.push(Problem::at_path("bodies", "the scene has no body").help("add a `Body(...)`"));
    }
    for (i, body) in scene.bodies.iter().enumerate() {
        let at = |field: &str| format!("bodies[{i}].{field}");
        usable_name("body", &body.name, at("name"), problems);
        if scene.bodies[..i].iter().any(|other| other.name == body.name) {
            problems.push(twice("body", &body.name, at("name")));
        }
        if body.spacing <= 0.0 {
            let message = format!("`spacing` must be positive, found {} m", number(body.spacing));
            problems.push(Problem::at_path(at("spacing"), message));
        }
        if let Some(velocity) = body.velocity {
            in_plane(scene, velocity.0, &at("velocity"), problems);
        }
    }
}

fn check_contacts(scene: &Scene, problems: &mut Vec<Problem>) {
    for (i, contact) in scene.contacts.iter().enumerate() {
        for (side, name) in [&contact.between.0, &contact.between.1].into_iter().enumerate() {
            if let Some((message, help)) = unknown_bodies(scene, name) {
                problems
                    .push(Problem::at_path(format!("contacts[{i}].between[{side}]"), message).helps(help));
            }
        }
        if contact.friction < 0.0 {
            let message = format!("`friction` must not be negative, found {}", number(contact.friction));
            problems.push(Problem::at_path(format!("contacts[{i}].friction"), message));
        }
        if let Some(share) = contact.friction_heat.filter(|share| !(0.0..=1.0).contains(share)) {
            let message = format!("`friction_heat` must be from 0 to 1, found {}", number(share));
            problems.push(
                Problem::at_path(format!("contacts[{i}].friction_heat"), message)
                    .help("it is the share of the first of the two bodies"),
            );
        }
        if !(0.0..=1.0).contains(&contact.restitution) {
            let message = format!("`restitution` must be from 0 to 1, found {}", number(contact.restitution));
            problems.push(Problem::at_path(format!("contacts[{i}].restitution"), message));
        }
    }
}

impl Select {
    /// Problems of the selection in this scene: for each the field, the message and the correction.
    pub fn problems(&self, scene: &Scene) -> Vec<(&'static str, String, Vec<String>)> {
        let mut problems = Vec::new();
        if let Some((message, help)) = self.body.as_deref().and_then(|name| unknown_bodies(scene, name)) {
            problems.push(("body", message, help));
        }
        if scene.dimension == Dimension::Two {
            if let Some(face @ (Face::MinZ | Face::MaxZ)) = self.face {
                let help = vec!["the faces are MinX, MaxX, MinY, MaxY".into()];
                problems.push(("face", format!("a two-dimensional scene has no face {face:?}"), help));
            }
            if let Some(z) = self.nearest.map(|point| point.0.z).filter(|z| *z != 0.0) {
                problems.push(("nearest", out_of_plane(z), vec![IN_PLANE.into()]));
            }
        }
        problems
    }
}
