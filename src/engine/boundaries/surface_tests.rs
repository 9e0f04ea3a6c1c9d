//! Loads on parts of the surface of a body: bores, inclined and curved sides, all of it.

use std::f64::consts::PI;

use glam::DVec3;

use crate::assembly::build;
use crate::plugin::Registry;
use crate::scene::{Source, parse};
use crate::world::{BodyId, Mass, ReferencePosition, Velocity};

/// The momentum that a load gives to a free body in a step of 10 us over the time, N.
fn force(dimension: &str, shape: &str, lattice: &str, load: &str) -> DVec3 {
    force_and_moment(dimension, shape, lattice, load).0
}

/// The same, and the angular momentum about the origin over the time, N m.
fn force_and_moment(dimension: &str, shape: &str, lattice: &str, load: &str) -> (DVec3, DVec3) {
    let text = format!(
        r#"(dimension: {dimension}, materials: {{"soft": StVenantKirchhoff(density: 1000, young: 1e6, poisson: 0.3)}},
            bodies: [(name: "b", material: "soft", shape: {shape}, spacing: 0.01, lattice: {lattice}, formulation: TotalLagrangian)],
            conditions: [{load}], time: (end: 1e-5, step: Fixed(1e-5)))"#
    );
    let (scene, source) = parse(Source::new("test.ron", text)).unwrap_or_else(|e| panic!("{e}"));
    let mut sim = build(&scene, &source, &Registry::standard()).unwrap_or_else(|e| panic!("{e}"));
    sim.run(|_| true).unwrap();
    let (view, rows) = sim.world().body_view(BodyId(0));
    let (mass, velocity) = (view.read::<Mass>().unwrap(), view.read::<Velocity>().unwrap());
    let place = view.read::<ReferencePosition>().unwrap();
    let momentum = |row: usize| mass[row].0 * velocity[row].0;
    let force = rows.clone().map(momentum).sum::<DVec3>() / 1e-5;
    (force, rows.map(|row| place[row].0.cross(momentum(row))).sum::<DVec3>() / 1e-5)
}

const BORED: &str = "Difference(Box(min: (0, 0, 0), max: (0.1, 0.1, 0.05)), Cylinder(from: (0.05, 0.05, -1), to: (0.05, 0.05, 1), radius: 0.03))";

#[test]
fn a_traction_on_a_bore_acts_on_its_area() {
    let area = 2.0 * PI * 0.03 * 0.05;
    for (surface, lattice) in [
        ("Of(Cylinder(from: (0.05, 0.05, -1), to: (0.05, 0.05, 1), radius: 0.03))", "Regular"),
        ("Inner", "BodyFitted()"),
    ] {
        let load =
            format!(r#"Traction(on: Select(body: "b", surface: {surface}), value: ("0", "0", "1000"))"#);
        let found = force("Three", BORED, lattice, &load);
        assert!((found.z / (1000.0 * area) - 1.0).abs() < 0.02, "{surface}: {found}");
    }
}

#[test]
fn a_load_without_a_value_is_told_with_its_place() {
    let text = r#"(dimension: Two, materials: {"soft": StVenantKirchhoff(density: 1000, young: 1e6, poisson: 0.3)},
        bodies: [(name: "b", material: "soft", shape: Box(min: (0, 0), max: (0.2, 0.05)), spacing: 0.01, formulation: TotalLagrangian)],
        conditions: [Traction(on: Select(body: "b", face: MinX), value: (1, 0)),
                     Traction(on: Select(body: "b", face: MaxX), value: ("sqrt(-1 - t)", 0))], time: (end: 1e-5))"#;
    let (scene, source) = parse(Source::new("test.ron", text.to_owned())).unwrap_or_else(|e| panic!("{e}"));
    let mut sim = build(&scene, &source, &Registry::standard()).unwrap_or_else(|e| panic!("{e}"));
    let error = sim.run(|_| true).expect_err("no load");
    let wanted =
        "the load must be finite, found (NaN, 0) N at the reference position (0.2, 0.0025) m and 0 s";
    assert!(error.to_string().contains(wanted), "{error}");
    let problem = error.problem().expect("a place in the scene");
    let item = problem.span(&source).map(|span| &source.text[span]);
    assert_eq!(item, Some("Traction"), "{}", problem.render(&source));
    assert!(problem.render(&source).contains("test.ron:4:22"), "{}", problem.render(&source));
}

#[test]
fn a_pressure_all_around_a_body_has_no_resultant() {
    let load = r#"Pressure(on: Select(body: "b", surface: All), value: "1000")"#;
    for (dimension, shape) in [
        ("Three", BORED),
        ("Three", "Shell(center: (0, 0, 0), inner: 0.03, outer: 0.06)"),
        (
            "Three",
            "Union([Box(min: (0, 0, 0), max: (0.06, 0.06, 0.03)), Sphere(center: (0.03, 0.03, 0.03), radius: 0.02)])",
        ),
        ("Two", "Difference(Box(min: (0, 0), max: (0.1, 0.1)), Sphere(center: (0.1, 0.1), radius: 0.05))"),
    ] {
        let found = force(dimension, shape, "Regular", load);
        assert!(found.length() < 1e-9 * 1000.0 * 0.01, "{shape}: {found}");
    }
}

#[test]
fn a_bore_that_a_symmetry_plane_cuts_faces_its_body() {
    let quarter =
        "Intersection([Ring(center: (0, 0), inner: 0.03, outer: 0.06), Box(min: (0, 0), max: (1, 1))])";
    let planes = "Symmetry(plane: X, at: 0), Symmetry(plane: Y, at: 0)";
    for (surface, radius) in [("Inner", 0.03), ("Outer", -0.06), ("All", -0.03)] {
        let load = format!(r#"Pressure(on: Select(body: "b", surface: {surface}), value: "1000"), {planes}"#);
        let found = force("Two", quarter, "BodyFitted()", &load);
        let expected = 1000.0 * radius * DVec3::new(1.0, 1.0, 0.0);
        assert!(found.distance(expected) < 0.03 * expected.length(), "{surface}: {found} {expected}");
    }
}

#[test]
fn a_pressure_on_an_inclined_side_is_along_its_normal() {
    let wedge = "Extrusion(polygon: [(0, 0), (0.1, 0), (0.1, 0.05), (0.0, 0.1)], from: 0, to: 0.03)";
    let load = r#"Pressure(on: Select(body: "b", surface: Facing((1, 2, 0))), value: "1000")"#;
    let found = force("Three", wedge, "Regular", load);
    let expected = -1000.0 * 0.03 * DVec3::new(0.05, 0.1, 0.0);
    assert!(found.distance(expected) < 1e-6 * expected.length(), "{found} {expected}");
    let cut = "Difference(Box(min: (0, 0, 0), max: (0.1, 0.1, 0.03)), HalfSpace(point: (0.1, 0.05, 0), normal: (-1, -2, 0)))";
    let found = force("Three", cut, "BodyFitted()", load);
    assert!(found.distance(expected) < 0.02 * expected.length(), "{found} {expected}");
}

#[test]
fn a_load_on_part_of_a_face_ends_where_the_part_does() {
    // Borders between particles, in the middle of facets and close to their ends.
    for (lo, hi) in [(-0.033, 0.021), (-0.0151, 0.0149), (-0.0201, 0.0299), (0.0021, 0.0197)] {
        let within = format!("Box(min: (0.05, {lo}), max: (0.15, {hi}))");
        let load =
            format!(r#"Traction(on: Select(body: "b", face: MaxX, within: {within}), value: (1000, 200))"#);
        let (found, moment) =
            force_and_moment("Two", "Box(min: (0, -0.05), max: (0.1, 0.05))", "Regular", &load);
        let expected = (hi - lo) * DVec3::new(1000.0, 200.0, 0.0);
        let arm = DVec3::new(0.1, 0.5 * (lo + hi), 0.0);
        assert!(found.distance(expected) < 1e-6 * expected.length(), "{lo} to {hi}: {found} {expected}");
        let expected = arm.cross(expected).z;
        assert!((moment.z - expected).abs() < 1e-4, "{lo} to {hi}: {moment} {expected}");
    }
}

#[test]
fn a_load_on_part_of_a_face_in_space_has_its_area_and_middle() {
    let disc = "Cylinder(from: (0.013, -0.004, 0), to: (0.013, -0.004, 1), radius: 0.022)";
    let plate = "Box(min: (-0.033, -0.017, 0.03), max: (0.021, 0.033, 0.08))";
    for (within, area, middle) in [
        (disc, PI * 0.022 * 0.022, DVec3::new(0.013, -0.004, 0.05)),
        (plate, 0.054 * 0.05, DVec3::new(-0.006, 0.008, 0.05)),
    ] {
        let load = format!(r#"Pressure(on: Select(body: "b", face: MaxZ, within: {within}), value: 1000)"#);
        let shape = "Box(min: (-0.05, -0.05, 0), max: (0.05, 0.05, 0.05))";
        let (found, moment) = force_and_moment("Three", shape, "Regular", &load);
        let expected = -1000.0 * area * DVec3::Z;
        assert!(found.distance(expected) < 0.003 * expected.length(), "{within}: {found} {expected}");
        let foot = DVec3::Z.cross(moment) / expected.z;
        assert!((foot - middle).truncate().length() < 1e-4, "{within}: {foot} {middle}");
    }
}

#[test]
fn a_load_on_part_of_a_face_of_a_rigid_body_has_its_area_and_middle() {
    for (lo, hi) in [(-0.033, 0.021), (-0.0151, 0.0149), (-0.0201, 0.0299)] {
        let load = format!(
            r#"Traction(on: Select(body: "b", face: MaxX, within: Box(min: (0.05, {lo}), max: (0.15, {hi}))), value: (1000, 0))"#
        );
        let text = format!(
            r#"(dimension: Two, materials: {{"iron": StVenantKirchhoff(density: 1000, young: 1e6, poisson: 0.3)}},
                bodies: [(name: "b", material: "iron", shape: Box(min: (0, -0.05), max: (0.1, 0.05)), spacing: 0.01, formulation: Rigid)],
                conditions: [{load}], time: (end: 1e-5, step: Fixed(1e-5)))"#
        );
        let (scene, source) = parse(Source::new("test.ron", text)).unwrap_or_else(|e| panic!("{e}"));
        let mut sim = build(&scene, &source, &Registry::standard()).unwrap_or_else(|e| panic!("{e}"));
        sim.run(|_| true).unwrap();
        let (view, rows) = sim.world().body_view(BodyId(0));
        let velocity = view.read::<Velocity>().unwrap();
        let place = view.read::<ReferencePosition>().unwrap();
        // A square of 10 kg per metre, with a moment of inertia of m a^2 / 6.
        let (mass, inertia, force) = (10.0, 10.0 * 0.01 / 6.0, 1000.0 * (hi - lo));
        let mean = rows.clone().map(|row| velocity[row].0).sum::<DVec3>() / rows.len() as f64;
        let (first, last) = (rows.start, rows.end - 1);
        let arm = place[last].0 - place[first].0;
        let spin = arm.cross(velocity[last].0 - velocity[first].0).z / arm.length_squared();
        let moment = -0.5 * (lo + hi) * force;
        assert!((mass * mean.x / 1e-5 / force - 1.0).abs() < 1e-6, "{lo} to {hi}: {mean}");
        assert!((inertia * spin / 1e-5 - moment).abs() < 1e-6, "{lo} to {hi}: {spin}");
    }
}
