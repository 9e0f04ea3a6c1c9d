//! A step of known height on a floor, before and after its removal.

use crate::assembly::{BuildOptions, build_with};
use crate::plugin::Registry;
use crate::scene::{Source, parse};

/// The first and the last row of the series of a probe, with the names of the columns, without time. The step
/// leaves the domain in the first step.
fn both_ends(
    dimension: &str,
    [floor, step, top]: [&str; 3],
    velocity: &str,
    quantity: &str,
) -> Vec<(String, f64, f64)> {
    let text = format!(
        r#"(dimension: {dimension}, domain: (min: (-9, -9, -9), max: {top}, periodic: [X], outside: Remove),
            materials: {{"rubber": NeoHookean(density: 1000, young: 1e5, poisson: 0.3)}},
            bodies: [(name: "floor", material: "rubber", shape: Union([{floor}, {step}]), spacing: 0.1,
                      formulation: TotalLagrangian(), velocity: {velocity})],
            probes: [Probe(name: "p", on: Select(body: "floor"), quantity: {quantity}, every: 1e-3)],
            time: (end: 1e-3, step: Fixed(1e-3)))"#
    );
    let text = if dimension == "Two" { text.replace("(-9, -9, -9)", "(0, -9)") } else { text };
    let (scene, source) = parse(Source::new("floor.ron", text)).unwrap_or_else(|e| panic!("{e}"));
    let folder = tempfile::tempdir().unwrap();
    let options = BuildOptions::into_folder(folder.path());
    let mut sim =
        build_with(&scene, &source, &Registry::standard(), &options).unwrap_or_else(|e| panic!("{e}"));
    sim.run(|_| true).unwrap();
    sim.finish().unwrap();
    let csv = std::fs::read_to_string(folder.path().join("p.csv")).unwrap();
    let mut lines = csv.lines();
    let names =
        lines.next().unwrap().split(',').map(|name| name.split('[').next().unwrap_or_default().to_owned());
    let rows: Vec<Vec<f64>> =
        lines.map(|row| row.split(',').map(|value| value.parse().unwrap()).collect()).collect();
    let (first, last) = (&rows[0], &rows[rows.len() - 1]);
    names.enumerate().skip(1).map(|(k, name)| (name, first[k], last[k])).collect()
}

#[track_caller]
fn near(found: &[(String, f64, f64)], wanted: &[(&str, f64, f64)]) {
    assert_eq!(found.len(), wanted.len(), "{found:?}");
    for (found, wanted) in found.iter().zip(wanted) {
        let close = (found.1 - wanted.1).abs() < 1e-9 && (found.2 - wanted.2).abs() < 1e-9;
        assert!(found.0 == wanted.0 && close, "{found:?} {wanted:?}");
    }
}

const PLANE: [&str; 3] =
    ["Box(min: (0, 0), max: (2, 0.5))", "Box(min: (0.8, 0.5), max: (1.2, 0.7))", "(2, 0.7)"];

#[test]
fn a_step_has_the_roughness_of_its_shape_and_none_when_it_has_gone() {
    // z = 0.5, and 0.7 over a fifth: the mean is 0.54, Ra = 0.8 * 0.04 + 0.2 * 0.16. All rise by 0.2; the
    // particles above 0.7 go.
    let found = both_ends("Two", PLANE, "(0, 200)", "Roughness(normal: (0, 2))");
    near(&found, &[("Ra", 0.064, 0.0), ("Rz", 0.2, 0.0), ("mean", 0.54, 0.7)]);
    let found = both_ends("Two", PLANE, "(0, 200)", "RemovedVolume");
    near(&found, &[("volume", 0.0, 0.08)]);
}

#[test]
fn a_surface_that_leaves_on_one_side_of_the_period_enters_on_the_other() {
    let found = both_ends("Two", PLANE, "(1300, 0)", "Roughness(normal: (0, 1))");
    near(&found, &[("Ra", 0.064, 0.064), ("Rz", 0.2, 0.2), ("mean", 0.54, 0.54)]);
}

#[test]
fn in_space_columns_lie_side_by_side_along_both_directions() {
    let bodies =
        ["Box(min: (0, 0, 0), max: (1, 0.3, 1))", "Box(min: (0, 0.3, 0), max: (0.5, 0.5, 0.4))", "(9, 9, 9)"];
    // A fifth of the area is 0.2 higher.
    let found = both_ends("Three", bodies, "(0, 0, 0)", "Roughness(normal: (0, 1, 0))");
    near(&found, &[("Ra", 0.064, 0.064), ("Rz", 0.2, 0.2), ("mean", 0.34, 0.34)]);
}
