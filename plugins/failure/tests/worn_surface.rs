//! The roughness of a body of which a piece has come off.

use meshless_engine::assembly::{BuildOptions, build_with};
use meshless_engine::plugin::Registry;
use meshless_engine::scene::{Source, parse};
use meshless_engine::world::{BodyId, Damage, ReferencePosition};

/// Ra, Rz and mean height of a floor that is 0.5 m high with a step of 0.2 m on a fifth of it, at rest, whose
/// particles at the foot of the step have failed between two places along it.
fn surface(formulation: &str, [from, to]: [f64; 2]) -> Vec<f64> {
    let (floor, step) = ("Box(min: (0, 0), max: (2, 0.5))", "Box(min: (0.8, 0.5), max: (1.2, 0.7))");
    surface_of(&[floor, step], formulation, [from, to])
}

/// The same of a body of some shapes.
fn surface_of(shapes: &[&str], formulation: &str, [from, to]: [f64; 2]) -> Vec<f64> {
    let shapes = shapes.join(", ");
    let text = format!(
        r#"(dimension: Two, materials: {{"glass": NeoHookean(density: 1, young: 1, poisson: 0.3)}},
            bodies: [(name: "floor", material: "glass", spacing: 0.1, formulation: {formulation},
                      shape: Union([{shapes}]),
                      plugins: [failure(criterion: MaximumPrincipalStrain(limit: 0.5), then: NoTension)])],
            probes: [Probe(name: "p", on: Select(body: "floor"), quantity: Roughness(normal: (0, 1)), every: 1e-3)],
            time: (end: 1e-3, step: Fixed(1e-3)))"#
    );
    let (scene, source) = parse(Source::new("floor.ron", text)).unwrap_or_else(|error| panic!("{error}"));
    let mut registry = Registry::standard();
    failure::register(&mut registry);
    let folder = tempfile::tempdir().expect("a folder");
    let options = BuildOptions::into_folder(folder.path());
    let mut sim = build_with(&scene, &source, &registry, &options).unwrap_or_else(|error| panic!("{error}"));
    {
        let (view, rows) = sim.world().body_view(BodyId(0));
        let place = view.read::<ReferencePosition>().expect("places");
        let mut damage = view.write::<Damage>().expect("damage");
        for row in rows {
            let x = place[row].0;
            if (0.5..0.6).contains(&x.y) && (from..to).contains(&x.x) {
                damage[row].0 = 1.0;
            }
        }
    }
    sim.run(|_| true).expect("a run");
    sim.finish().expect("its end");
    let text = std::fs::read_to_string(folder.path().join("p.csv")).expect("a table");
    let last = text.lines().last().expect("a row");
    last.split(',').skip(1).map(|value| value.parse().expect("a number")).collect()
}

#[test]
fn what_has_come_off_is_no_part_of_the_surface() {
    for formulation in ["TotalLagrangian", "UpdatedLagrangian()", "Eulerian()"] {
        // z = 0.5, and 0.7 over a fifth: the mean is 0.54, Ra = 0.8 * 0.04 + 0.2 * 0.16.
        let whole = [0.064, 0.2, 0.54];
        let cases = [([0.0, 0.0], whole), ([0.8, 1.1], whole), ([0.8, 1.2], [0.0, 0.0, 0.5])];
        for (failed, wanted) in cases {
            let found = surface(formulation, failed);
            let near = found.iter().zip(wanted).all(|(found, wanted)| (found - wanted).abs() < 1e-9);
            assert!(near, "{formulation} {failed:?}: {found:?}");
        }
    }
}

#[test]
fn parts_that_are_apart_from_the_start_are_parts_of_the_surface() {
    // A part of 1.5 m and one of 0.5 m that is 0.2 m higher: the mean is 0.55, and
    // Ra = 0.75 * 0.05 + 0.25 * 0.15.
    let shapes = ["Box(min: (0, 0), max: (1.5, 0.5))", "Box(min: (2, 0), max: (2.5, 0.7))"];
    for formulation in ["TotalLagrangian", "UpdatedLagrangian()", "Eulerian()"] {
        let found = surface_of(&shapes, formulation, [0.0, 0.0]);
        let near = found.iter().zip([0.075, 0.2, 0.55]).all(|(found, wanted)| (found - wanted).abs() < 1e-9);
        assert!(near, "{formulation}: {found:?}");
    }
}
