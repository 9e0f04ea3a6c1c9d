//! Checks of the probes of a scene before anything is built.

use super::requirements::{in_plane, positive_time, twice, unknown_body, usable_name};
use super::{Probe, Problem, Quantity, Reduction, Scene};

/// Maximum number of points on a line.
const MAX_POINTS: u32 = 1000;

/// Checks all probes.
pub(super) fn check(scene: &Scene, problems: &mut Vec<Problem>) {
    for (i, probe) in scene.probes.iter().enumerate() {
        let at = |field: &str| format!("probes[{i}].{field}");
        usable_name("probe", &probe.name, at("name"), problems);
        if scene.probes[..i].iter().any(|other| other.name == probe.name) {
            problems.push(twice("probe", &probe.name, at("name")));
        }
        if probe.name == "energy" {
            let message = "the name `energy` is reserved: the energy balance is written to `energy.csv`";
            problems
                .push(Problem::at_path(at("name"), message).help("choose another name, such as `energies`"));
        }
        problems.extend(place(probe, i));
        problems.extend(options(probe, i));
        for (field, message, help) in probe.on.iter().flat_map(|on| on.problems(scene)) {
            problems.push(Problem::at_path(at(&format!("on.{field}")), message).helps(help));
        }
        let second = probe.relative_to.as_ref();
        for (field, message, help) in
            second.and_then(|to| to.on.as_ref()).iter().flat_map(|on| on.problems(scene))
        {
            problems.push(Problem::at_path(at(&format!("relative_to.on.{field}")), message).helps(help));
        }
        for (name, field) in
            [(&probe.follows, "follows"), (&second.and_then(|to| to.follows.clone()), "relative_to.follows")]
        {
            if let Some((message, help)) = name.as_deref().and_then(|name| unknown_body(scene, name)) {
                problems.push(Problem::at_path(at(field), message).helps(help));
            }
        }
        let line = probe.line.iter().flat_map(|line| [(line.from, "line.from"), (line.to, "line.to")]);
        let points = probe.at.map(|point| (point, "at")).into_iter().chain(line);
        for (point, field) in points.chain(second.and_then(|to| to.at).map(|point| (point, "relative_to.at")))
        {
            in_plane(scene, point.0, &at(field), problems);
        }
        positive_time(probe.every, &at("every"), problems);
    }
}

/// Problem with the position of a probe.
fn place(probe: &Probe, i: usize) -> Option<Problem> {
    let places = [probe.on.is_some(), probe.at.is_some(), probe.line.is_some()];
    let (field, message) = match (places, &probe.quantity) {
        ([_, true, true], _) => ("line", "a probe has one of `on`, `at` and `line`, found two"),
        ([true, true, _], _) => ("at", "a probe has one of `on`, `at` and `line`, found two"),
        ([true, _, true], _) => ("line", "a probe has one of `on`, `at` and `line`, found two"),
        ([false, false, false], Quantity::Energy) => return None,
        ([false, false, false], _) => ("name", "the probe needs `on`, `at` or `line`"),
        ([true, ..], quantity) if quantity.at_point() == Some(true) => {
            ("on", "this quantity is measured at a point, not on a selection")
        }
        ([_, true, _], quantity) if quantity.at_point() == Some(false) => {
            ("at", "this quantity is measured on a selection, not at a point")
        }
        ([_, _, true], quantity) if quantity.at_point().is_some() || *quantity == Quantity::Distance => {
            ("line", "this quantity is not measured along a line")
        }
        _ => return None,
    };
    Some(Problem::at_path(format!("probes[{i}].{field}"), message).help(
        "`on: Select(...)` takes the mean over particles, `at: (x, y, z)` measures at a point, `line: (from: ..., to: ..., points: 20)` along a line",
    ))
}

/// Problem with the other fields of a probe.
fn options(probe: &Probe, i: usize) -> Option<Problem> {
    let is_of_field = probe.quantity.at_point().is_none();
    let extreme = matches!(probe.take, Some(Reduction::Minimum | Reduction::Maximum));
    let is_carried = is_of_field
        || matches!(probe.quantity, Quantity::WaterLevel { .. } | Quantity::PressureSensor { .. });
    let (field, message, help) = if probe.follows.is_some() && (probe.on.is_some() || !is_carried) {
        let help = "points are given by `at` or `line`; fields, positions, displacements and velocities have values at points of bodies, and bodies carry a `PressureSensor` or a `WaterLevel` along";
        ("follows", "`follows` needs a point of a body and a field there", help)
    } else if probe.take.is_some()
        && (probe.on.is_none() || !is_of_field || probe.quantity == Quantity::Distance)
    {
        ("take", "`take` needs a selection `on` and a field", "select particles with `on: Select(...)`")
    } else if probe.relative_to.is_some() && (!is_of_field || extreme || probe.line.is_some()) {
        let help = "means of fields over a selection, and fields at a point, may be relative to those of another place";
        ("relative_to", "`relative_to` does not fit what the probe measures", help)
    } else if probe.quantity == Quantity::Distance && probe.relative_to.is_none() {
        (
            "quantity",
            "`Distance` needs `relative_to`",
            "give the other place: `relative_to: (at: (0, 0), follows: \"bar\")`",
        )
    } else if let Some(to) = &probe.relative_to
        && to.on.is_some() == to.at.is_some()
    {
        (
            "relative_to",
            "`relative_to` needs one of `on` and `at`",
            "`relative_to: (at: (0, 0), follows: \"bar\")`",
        )
    } else if probe.line.is_some_and(|line| line.from == line.to) {
        ("line.to", "the two ends of a line must be different points", "a single point is measured with `at`")
    } else if probe.line.is_some_and(|line| !(2..=MAX_POINTS).contains(&line.points)) {
        (
            "line.points",
            "`points` must be from 2 to 1000",
            "a line has a place at each of its ends and others between them",
        )
    } else {
        return None;
    };
    Some(Problem::at_path(format!("probes[{i}].{field}"), message).help(help))
}
